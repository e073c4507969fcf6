// From world space into the frame (T, B, N) that the lobes of an atlas texel live in.
#ifndef STRANDLIGHT_SG_FRAME_GLSL
#define STRANDLIGHT_SG_FRAME_GLSL

struct AtlasFrame
{
    vec3 t;
    vec3 b;
    vec3 n;
};

// `back`: the viewer sees the back of the surface. Its light was never captured; the front's stands in, mirrored
// through the surface, so T and B stay and only N turns to the viewer.
AtlasFrame atlasFrame(vec3 n, vec3 t, bool back)
{
    AtlasFrame frame;
    frame.n = n;
    frame.t = t;
    frame.b = back ? cross(t, n) : cross(n, t);
    return frame;
}

vec3 toFrame(AtlasFrame frame, vec3 v)
{
    return vec3(dot(frame.t, v), dot(frame.b, v), dot(frame.n, v));
}

#endif
