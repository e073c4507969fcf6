// The device of the tests: validation (core and synchronization) on; a message fails the test that
// caused it.
#pragma once

#include <string>

#include "engine/vk/context.hpp"

namespace strandlight::test {

// One context per test program, made on first use. STRANDLIGHT_TEST_DEVICE chooses a device.
Context& context();

// Folder of the real scenes and vectors; empty when there is none. STRANDLIGHT_DATA names another
// place.
std::string dataFolder();

} // namespace strandlight::test
