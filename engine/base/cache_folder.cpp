#include "engine/base/cache_folder.hpp"

#include <cstdlib>

namespace strandlight {

std::filesystem::path cacheFolder()
{
    const char* xdg = std::getenv("XDG_CACHE_HOME");
    if (xdg != nullptr && *xdg != '\0')
        return std::filesystem::path(xdg) / "strandlight";
    const char* home = std::getenv("HOME");
    if (home == nullptr || *home == '\0')
        return {};
    return std::filesystem::path(home) / ".cache" / "strandlight";
}

} // namespace strandlight
