#include <doctest/doctest.h>

#include "engine/vk/optional_features.hpp"

using namespace strandlight;

TEST_CASE("matrix units: the line names everything that is missing, and nothing else")
{
    MatrixSupport support{.compilerVersion = "12.0.0"};
    CHECK_EQ(matrixUnitsText(support),
             "not used: the device lacks VK_KHR_cooperative_matrix, the feature shaderFloat16, the "
             "feature vulkanMemoryModel; glslang 12.0.0 of this build lacks "
             "GL_KHR_cooperative_matrix (13.0 has it)");
    support.extension = support.halves = support.memoryModel = true;
    CHECK_EQ(matrixUnitsText(support),
             "not used: the device lacks the feature cooperativeMatrix; glslang 12.0.0 of this "
             "build lacks GL_KHR_cooperative_matrix (13.0 has it)");
    support.compiler = true;
    CHECK_EQ(matrixUnitsText(support), "not used: the device lacks the feature cooperativeMatrix");
    support.matrices = true;
    CHECK_EQ(matrixUnitsText(support),
             "not used: device and compiler offer them, no kernel is written for them");
}
