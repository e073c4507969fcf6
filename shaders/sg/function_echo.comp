// Runs the shared shading functions on the device for tests/gpu/test_shared_functions.cpp.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/function_echo.h"

layout(local_size_x = 64) in;
layout(binding = 0, scalar) buffer Values { float values[]; };
layout(push_constant, scalar) uniform Push { uint count; } push;

void main()
{
    uint item = gl_GlobalInvocationID.x;
    if (item >= push.count) {
        return;
    }
    FunctionEcho e = echoFunctions(item);
    for (uint i = 0u; i < kEchoValues; ++i) {
        values[item * kEchoValues + i] = e.values[i];
    }
}
