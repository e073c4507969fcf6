// A training's losses as a picture.
#pragma once

#include <string>

#include "passes/hair_train.hpp"

namespace strandlight::cli {

// SVG, both axes logarithmic: the training loss in bins of about 1/40 of a decade and more, the
// validation loss where it was taken.
std::string lossCurveSvg(const HairTraining& training);

} // namespace strandlight::cli
