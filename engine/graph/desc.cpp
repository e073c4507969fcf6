#include "engine/graph/desc.hpp"

#include <cstddef>

namespace strandlight {

bool writes(Usage usage)
{
    return usage == Usage::ShaderWrite || usage == Usage::ColorAttachment ||
           usage == Usage::DepthAttachment || usage == Usage::TransferWrite;
}

const char* toString(Usage usage)
{
    static const char* const kNames[] = {
        "none",  "shader read", "shader write", "sample",        "color",
        "depth", "depth read",  "indirect",     "transfer read", "transfer write"};
    return kNames[std::size_t(usage)];
}

} // namespace strandlight
