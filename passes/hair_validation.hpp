// How near the network comes to the truth on held-out frames, and how near plain averages do.
#pragma once

#include <span>
#include <vector>

#include "engine/base/image.hpp"
#include "passes/hair_train_step.hpp"

namespace strandlight {

// Root mean square errors of linear radiance over a grey background of kHairValidationGrey.
struct HairFrameErrors
{
    double average4 = 0.0;
    double average16 = 0.0;
    double average64 = 0.0;
    double network = 0.0; // on the same four samples as average4
};
inline constexpr float kHairValidationGrey = 0.2f;

struct HairValidation
{
    double loss = 0.0; // mean over the frames
    std::vector<HairFrameErrors> frames;

    double relativeError() const; // mean over the frames of network / average4
};

// Of the first noise of each frame, whole.
HairValidation validateHairNet(Context& context, const UNetDesc& net, Parameters& parameters,
                               std::span<const HairTrainingFrame> heldOut);

// Four pictures side by side: four samples averaged, 64 averaged, the network's, the truth.
CpuImage hairValidationPicture(Context& context, const UNetDesc& net, Parameters& parameters,
                               const HairTrainingFrame& frame);

} // namespace strandlight
