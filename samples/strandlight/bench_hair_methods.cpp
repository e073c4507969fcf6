// What `strandlight bench hair` compares.
#include <algorithm>
#include <cstdio>

#include "engine/base/error.hpp"
#include "samples/strandlight/bench_hair.hpp"

namespace strandlight::cli {

namespace {

const char* widthOf(const UNetDesc& net)
{
    const auto same = [&](HairUNetSize size) {
        return net.down == hairUNet(size).down && net.up == hairUNet(size).up;
    };
    return same(HairUNetSize::Small)    ? "small"
           : same(HairUNetSize::Medium) ? "medium"
           : same(HairUNetSize::Large)  ? "large"
                                        : "of other width";
}

} // namespace

std::vector<NamedHairNetwork> openHairNetworks(Context& context,
                                               const std::vector<std::string>& files)
{
    std::vector<NamedHairNetwork> networks;
    for (const std::string& file : files) {
        HairNetwork network = loadHairNetwork(context, file);
        networks.push_back({widthOf(network.net), std::move(network)});
    }
    if (files.empty() && !builtinHairWeights().empty()) {
        HairNetwork network = builtinHairNetwork(context);
        networks.push_back({widthOf(network.net), std::move(network)});
    }
    for (std::size_t i = 0; i < networks.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
            if (networks[i].width == networks[k].width)
                throw Error("--weights: '" + files[k] + "' and '" + files[i] + "' are both " +
                            networks[i].width + "; compare them in two runs");
    for (const char* width : {"small", "medium", "large"})
        if (std::none_of(networks.begin(), networks.end(),
                         [&](const NamedHairNetwork& n) { return n.width == width; }))
            std::printf("left out  U-Net %s: no --weights of that width\n", width);
    return networks;
}

std::vector<HairMethod> hairMethods(std::uint32_t truthSamples,
                                    std::vector<NamedHairNetwork>& networks, bool halves)
{
    std::vector<HairMethod> methods = {{"4 averaged"},
                                       {"16 averaged", HairFilter::Average, 4},
                                       {"64 averaged", HairFilter::Average, 16}};
    if (truthSamples >= 4 * 256)
        methods.push_back({"256 averaged", HairFilter::Average, 64});
    methods.push_back({"4 alpha to coverage", HairFilter::AlphaToCoverage});
    methods.push_back({"4 coverage", HairFilter::Coverage});
    methods.push_back({"blend", HairFilter::Blend});
    for (NamedHairNetwork& named : networks)
        methods.push_back({"4 U-Net " + named.width, HairFilter::UNet, 1, &named.network});
    if (networks.empty())
        return methods;
    const std::string name = "4 U-Net " + networks[0].width;
    HairNetwork* first = &networks[0].network;
    methods.push_back({name + ", all tiles", HairFilter::UNet, 1, first, 1, false});
    if (halves)
        methods.push_back({name + ", fp16", HairFilter::UNet, 1, first, 1, true, true});
    for (const std::uint32_t lod : {2u, 4u, 0u})
        methods.push_back({name + ", lod " + (lod > 0 ? std::to_string(lod) : "auto"),
                           HairFilter::UNet, 1, first, lod});
    return methods;
}

} // namespace strandlight::cli
