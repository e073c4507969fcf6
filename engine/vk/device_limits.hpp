// Limits of a device that few kernels come near.
#pragma once

#include <cstdint>

namespace strandlight {

class Context;

// Of a workgroup: maxComputeSharedMemorySize. Every device has 16 KiB, most have 32 or more.
std::uint32_t maxSharedBytes(const Context& context);

} // namespace strandlight
