#include "passes/stress/inputs.hpp"

#include <cstdio>

#include "passes/stress/kernel_inputs.hpp"

namespace strandlight {

std::string numberText(double value)
{
    char text[32];
    std::snprintf(text, sizeof(text), "%.9g", value);
    return text;
}

std::string describe(const gpu::StressInput& item)
{
    std::string text;
    for (const glm::vec4* row : {&item.a, &item.b, &item.c, &item.d}) {
        if (row != &item.a && *row == glm::vec4(0.0f))
            continue; // the function does not read it
        char line[128];
        std::snprintf(line, sizeof(line), "%s(%.9g %.9g %.9g %.9g)", text.empty() ? "" : " ",
                      double(row->x), double(row->y), double(row->z), double(row->w));
        text += line;
    }
    return text;
}

} // namespace strandlight
