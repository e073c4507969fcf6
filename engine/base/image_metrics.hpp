// How far a picture is from its truth.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "engine/base/image.hpp"

namespace strandlight {

struct CompareSettings
{
    float exposureStops = 0.0f; // radiance is multiplied by 2^stops for PSNR, SSIM and FLIP
    std::uint32_t blockSide = 8;
};

struct ImageComparison
{
    // Of linear radiance, over pixels and R, G, B; non-finite pixels left out.
    double rmse = 0.0;
    double relMse = 0.0; // mean of (a - b)^2 / (b^2 + 0.01), b the reference
    double blockRmse =
        0.0; // RMSE of the means of 8 x 8 pixel blocks (those at the border may be smaller)
    glm::dvec3 mean{0.0};
    glm::dvec3 referenceMean{0.0};

    // Of the displayed picture: exposed, clamped to [0,1], sRGB coded; non-finite pixels black.
    double psnr = 0.0; // dB, peak 1; infinite for equal pictures
    double ssim = 0.0; // of Rec. 709 luma
    double flip = 0.0; // mean

    std::uint64_t nonFinite = 0; // pixels of the picture with a NaN or infinite channel
    std::uint64_t referenceNonFinite = 0;
};

// Throws Error when the sizes differ or are zero.
ImageComparison compareImages(const CpuImage& image, const CpuImage& reference,
                              const CompareSettings& settings = {});

// Exposed, clamped to [0,1], still linear; non-finite pixels black: what PSNR, SSIM and FLIP look
// at.
CpuImage displayImage(const CpuImage& image, float exposureStops);

// Mean structural similarity, 11 x 11 Gaussian window of deviation 1.5, K1 = 0.01, K2 = 0.03, over
// the windows that lie inside the picture; a picture smaller than the window shrinks it. Values of
// x in [0,1]. Throws as above. Wang, Bovik, Sheikh, Simoncelli. Image Quality Assessment: From
// Error Visibility to Structural Similarity. 2004
double computeSsim(const CpuImage& image, const CpuImage& reference);

// Error in x, 0 to 1, as colours from black over violet and orange to pale yellow: lightness (CIE
// L*) grows linearly with the error, so the order is kept in greyscale print.
CpuImage heatmap(const CpuImage& error);

} // namespace strandlight
