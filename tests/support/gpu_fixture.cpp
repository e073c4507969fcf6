#include "tests/support/gpu_fixture.hpp"

#include <cstdlib>
#include <filesystem>

namespace strandlight::test {

Context& context()
{
    // Never destroyed: at exit, after main, objects that the validation layer made later than this
    // one are gone already, and vkDestroyDevice can walk one of them for ever (seen once).
    static Context& instance = *[] {
        ContextSettings settings;
        settings.validation = true;
        settings.pipelineCache = true;
        if (const char* device = std::getenv("STRANDLIGHT_TEST_DEVICE"))
            settings.device = device;
        return new Context(Context::headless(settings));
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
