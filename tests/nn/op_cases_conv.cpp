#include "tests/nn/op_cases.hpp"

#include "tests/nn/conv_cases.hpp"
#include "tests/nn/layer_case.hpp"

namespace strandlight::test {

namespace {

template <class Ops, class Desc> void addLayer(std::vector<OpCase>& cases, const LayerCase<Desc>& c)
{
    cases.push_back({layerName<Ops>(c),
                     [c](Context& context) {
                         RenderGraph graph(context);
                         const LayerResults ids = addLayerPasses<Ops>(graph, c);
                         graph.execute();
                         return readLayer(graph, ids, c);
                     },
                     [c] { return layerTwin<Ops>(c); }});
}

// Both directions of one shape.
void addShape(std::vector<OpCase>& cases, const ConvCase& c, bool bias, bool ranges,
              std::uint32_t seed)
{
    addLayer<ConvOps>(cases,
                      LayerCase<Conv2dDesc>{c.conv, c.x, c.conv.output(c.x), bias, ranges, seed});
    const ConvTranspose2dDesc& t = c.transpose;
    addLayer<ConvTransposeOps>(
        cases, LayerCase<ConvTranspose2dDesc>{t, c.x, t.output(c.x), bias, ranges, seed + 5});
}

} // namespace

void addSubgroupCases(std::vector<OpCase>& cases)
{
    for (const ConvCase& c : {makeConvCase({2, 6, 9, 7}, 13, {3, 3}, {2, 2}, {1, 1}, {0, 0}),
                              makeConvCase({1, 5, 6, 23}, 11, {3, 3}, {1, 1}, {1, 1}, {0, 0}),
                              makeConvCase({1, 5, 3, 12}, 11, {3, 3}, {1, 1}, {1, 1}, {0, 0}),
                              makeConvCase({1, 5, 6, 16}, 16, {3, 3}, {1, 1}, {1, 1}, {0, 0}),
                              makeConvCase({1, 3, 12, 32}, 8, {4, 4}, {2, 2}, {1, 1}, {0, 0})})
        addShape(cases, c, true, true, 3);
}

void addGpuFormCases(std::vector<OpCase>& cases)
{
    std::uint32_t seed = 500;
    for (const ConvCase& c : awkwardConvCases())
        addShape(cases, c, true, false, seed += 10);
    for (const ConvCase& c : {makeConvCase({1, 3, 9, 71}, 33, {3, 3}, {1, 1}, {1, 1}, {0, 0}),
                              makeConvCase({2, 19, 8, 36}, 12, {4, 4}, {2, 2}, {1, 1}, {0, 0}),
                              makeConvCase({1, 33, 5, 20}, 3, {3, 3}, {2, 2}, {1, 1}, {1, 1})})
        addShape(cases, c, true, true, seed += 10);
}

void addConvCases(std::vector<OpCase>& cases)
{
    std::uint32_t seed = 100;
    const auto add = [&](const ConvCase& c) {
        seed += 10;
        addShape(cases, c, seed % 40 != 0, seed % 30 == 0, seed);
    };
    for (const ConvCase& c : awkwardConvCases())
        add(c);
    for (const ConvCase& c : rowConvCases())
        add(c);
    for (const ConvCase& c : quadConvCases())
        add(c);
    for (const ConvCase& c : channelConvCases())
        add(c);
    // Many small images, as the encoder has them; and more pixels than one strip of the weight
    // gradient.
    add(makeConvCase({257, 5, 2, 2}, 9, {3, 3}, {2, 2}, {1, 1}, {0, 0}));
    add(makeConvCase({1, 3, 61, 151}, 4, {3, 3}, {1, 1}, {1, 1}, {0, 0}));
}

} // namespace strandlight::test
