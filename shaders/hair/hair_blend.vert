// Ribbons with the radiance and depth of both ends: their fragments interpolate within the segment. What the rasteriser
// interpolates may lie far outside of it where a ribbon is a sliver.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "hair/strand.glsl"

layout(binding = 3, rgba32f) uniform readonly imageBuffer shaded;
layout(location = 0) noperspective out vec3 line; // true width, distance from the middle in pixels; 0 to 1 along
layout(location = 1) noperspective out vec2 across; // the ribbon's normal in the picture
layout(location = 2) flat out vec4 first;           // radiance, depth in metres of the end towards the root
layout(location = 3) flat out vec4 second;

void main()
{
    RibbonVertex vertex = ribbonVertex(uint(gl_VertexIndex));
    int root = int(vertex.ids.y);
    mat4 rows = transpose(push.viewProjection);
    first = vec4(imageLoad(shaded, root).rgb, dot(rows[3], vec4(imageLoad(points, root).xyz, 1.0)));
    second = vec4(imageLoad(shaded, root + 1).rgb, dot(rows[3], vec4(imageLoad(points, root + 1).xyz, 1.0)));
    line = vec3(vertex.line, float(vertex.point - root));
    across = vec2(-vertex.tangent.y, vertex.tangent.x);
    gl_Position = vertex.clip;
}
