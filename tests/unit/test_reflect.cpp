// What the engine reads from SPIR-V decides what it binds: checked against shaders whose source we
// (Double parentheses: doctest would otherwise pick up our toString(BindingKind).)
// know.
#include <doctest/doctest.h>

#include "engine/vk/reflect.hpp"
#include "kernels/sample.gen.hpp"

using namespace strandlight;

TEST_CASE("a kernel's bindings, push constants and local size are read from its SPIR-V")
{
    const Reflection gradient = reflect(kernels::gradient);
    REQUIRE(gradient.bindings.size() == 1);
    CHECK((gradient.bindings[0].kind == BindingKind::StorageImage));
    CHECK_FALSE(gradient.bindings[0].readOnly);
    CHECK(gradient.pushBytes == 12);
    CHECK((gradient.localSizeWith({}) == std::array<std::uint32_t, 3>{8, 8, 1}));
}

TEST_CASE("a local size by specialisation constant follows the constant")
{
    const Reflection square = reflect(kernels::square_values);
    REQUIRE(square.bindings.size() == 1);
    CHECK((square.bindings[0].kind == BindingKind::StorageBuffer));
    const std::uint32_t constants[] = {24};
    CHECK((square.localSizeWith(constants) == std::array<std::uint32_t, 3>{24, 1, 1}));
}

TEST_CASE("sampled images are read-only and have no format of their own")
{
    const Reflection fragment = reflect(kernels::sample_image_frag);
    REQUIRE(fragment.bindings.size() == 1);
    CHECK((fragment.bindings[0].kind == BindingKind::SampledImage));
    CHECK(fragment.bindings[0].readOnly);
    CHECK(fragment.pushBytes == 0);
}
