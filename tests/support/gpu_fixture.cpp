#include "tests/support/gpu_fixture.hpp"

#include <cstdlib>
#include <filesystem>

namespace strandlight::test {

Context& context()
{
    static Context instance = [] {
        ContextSettings settings;
        settings.validation = true;
        settings.pipelineCache = true;
        if (const char* device = std::getenv("STRANDLIGHT_TEST_DEVICE"))
            settings.device = device;
        return Context::headless(settings);
    }();
    return instance;
}

std::string dataFolder()
{
    const char* chosen = std::getenv("STRANDLIGHT_DATA");
    const std::string folder = chosen ? chosen : STRANDLIGHT_SOURCE_DIR "/../shared/data";
    std::error_code error;
    return std::filesystem::is_directory(folder, error) ? folder : std::string();
}

} // namespace strandlight::test
