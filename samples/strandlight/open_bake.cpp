#include "samples/strandlight/open_bake.hpp"

#include "engine/base/error.hpp"
#include "passes/bake_identity.hpp"
#include "passes/sgl_file.hpp"

namespace strandlight::cli {

SgBake openBake(const std::string& path, const Scene& scene)
{
    SgBake bake = loadSgl(path);
    if (bake.info.geometryHash != hashGeometry(scene))
        throw FileError(path, "", "was baked from other geometry (" + bake.info.scene + ")");
    if (bake.info.environmentHash != hashEnvironment(scene))
        throw FileError(path, "",
                        bake.environment ? "was baked with another environment: give it with --env"
                                         : "was baked without an environment");
    return bake;
}

} // namespace strandlight::cli
