// Copies a sampled image to the colour target, pixel by pixel.
#version 460

layout(binding = 0) uniform sampler2D inputImage;
layout(location = 0) out vec4 color;

void main()
{
    color = texelFetch(inputImage, ivec2(gl_FragCoord.xy), 0);
}
