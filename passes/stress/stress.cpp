#include "passes/stress/stress.hpp"

#include <array>

namespace strandlight {

std::span<const StressGroup> stressGroups()
{
    static constexpr std::array kGroups = {
        StressGroup{"lobes", "spherical gaussians: value, integrals, products, axes", stressLobes},
        StressGroup{"scattering", "glossy lobes, surface BRDF, hair fibre", stressScattering},
        StressGroup{"storage", "RGB9E5, fp16, .sgl lobes, octahedral axes, sample masks",
                    stressStorage},
        StressGroup{"elementwise", "activations, losses", stressElementwise},
        StressGroup{"mixtures", "SG decoder and mixture, forward and backward", stressMixtures},
        StressGroup{"convolutions", "random shapes and scales, forward and gradients",
                    stressConvolutions},
        StressGroup{"optimiser", "Adam, sums of losses and gradients", stressOptimiser},
        StressGroup{"traces", "twenty training steps of encoder and U-Net", stressTraces},
        StressGroup{"adversaries", "fits of light fields made to break them", stressAdversaries},
    };
    return kGroups;
}

} // namespace strandlight
