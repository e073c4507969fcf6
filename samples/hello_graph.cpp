// A render graph in fifteen lines: one pass, one output, one picture.
#include <cstdio>

#include "engine/base/image_io.hpp"
#include "engine/graph/render_graph.hpp"
#include "kernels/sample.gen.hpp"
#include "shaders/shared/sample_types.h"

int main()
{
    using namespace strandlight;
    Context device = Context::headless();
    RenderGraph graph(device);

    ImageId picture = graph.createImage("picture", {.width = 256, .height = 256});
    PassBuilder pass = graph.addComputePass("gradient");
    picture = pass.write(picture);
    pass.dispatch(kernels::gradient, graph.extent(picture), gpu::GradientPush{256, 256, 1.0f},
                  {picture});
    graph.output(picture); // what reaches no output is culled

    graph.setTimings(Timings::Passes);
    graph.run();
    savePng("hello_graph.png", graph.read(picture));
    for (const PassTiming& timing : graph.timings())
        std::printf("%-12s %.3f ms on %s\n", timing.pass.c_str(), timing.milliseconds,
                    device.device().name.c_str());
}
