// The trained weights, as bytes of the program. passes/CMakeLists.txt names the file when there is
// one, and its checksum, so that another file compiles this one again.
#include "passes/hair_network.hpp"

#ifdef STRANDLIGHT_HAIR_WEIGHTS
asm(".section .rodata\n"
    ".balign 16\n"
    "strandlight_hair_weights: .incbin \"" STRANDLIGHT_HAIR_WEIGHTS "\"\n"
    "strandlight_hair_weights_end: .byte 0\n"
    ".previous\n");
extern "C" {
extern const std::byte strandlight_hair_weights[];
extern const std::byte strandlight_hair_weights_end[];
}
#endif

namespace strandlight {

std::span<const std::byte> builtinHairWeights()
{
#ifdef STRANDLIGHT_HAIR_WEIGHTS
    return {strandlight_hair_weights, strandlight_hair_weights_end};
#else
    return {};
#endif
}

} // namespace strandlight
