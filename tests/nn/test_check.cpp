// `nn check` on files: the shared vectors, one made by a twin, and broken ones.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>

#include "compute_nn/check.hpp"
#include "compute_nn/reference/conv2d.hpp"
#include "compute_nn/safetensors.hpp"
#include "engine/base/error.hpp"
#include "tests/nn/compare.hpp"
#include "tests/nn/vectors.hpp"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;
using namespace strandlight::test;

namespace {

// A conv2d vector file computed by the twin in double.
Safetensors makeVector()
{
    const Conv2dDesc conv{.in = 3, .out = 5, .stride = {2, 2}};
    const TensorDesc x{2, 3, 7, 6}, y = conv.output(x);
    const auto vx = randomValues<double>(x.elements(), 1), w = randomValues<double>(135, 2),
               b = randomValues<double>(5, 3), dY = randomValues<double>(y.elements(), 4);
    std::vector<double> vy(y.elements()), dX(vx.size(), 0.0), dW(w.size(), 0.0), dB(b.size(), 0.0);
    reference::conv2d<double>(conv, x, vx, w, b, vy);
    reference::conv2dBackward<double>(conv, x, vx, w, dY, dX, dW, dB);
    Safetensors file;
    file.metadata = {{"op", "conv2d"}, {"kernel", "3"}, {"stride", "2"}, {"padding", "1"}};
    const auto add = [&](const char* name, std::vector<std::uint64_t> shape,
                         const std::vector<double>& v) {
        file.tensors[name] = {std::move(shape), convert<float>(v)};
    };
    add("x", {2, 3, 7, 6}, vx);
    add("weight", {5, 3, 3, 3}, w);
    add("bias", {5}, b);
    add("y", {2, 5, 4, 3}, vy);
    add("dy", {2, 5, 4, 3}, dY);
    add("dx", {2, 3, 7, 6}, dX);
    add("dweight", {5, 3, 3, 3}, dW);
    add("dbias", {5}, dB);
    return file;
}

CheckReport check(const Safetensors& file)
{
    const auto path = std::filesystem::temp_directory_path() / "strandlight_test_check.safetensors";
    file.save(path);
    return checkFile(context(), path);
}

} // namespace

TEST_CASE("nn check: a right file passes, a wrong number fails its row and no other")
{
    const CheckReport right = check(makeVector());
    CHECK(right.pass());
    CHECK_EQ(right.rows.size(), 4);
    Safetensors wrong = makeVector();
    wrong.tensors["dweight"].values[7] += 0.1f;
    const CheckReport report = check(wrong);
    CHECK_FALSE(report.pass());
    for (const CheckRow& row : report.rows)
        CHECK_EQ(row.pass, row.name != "dweight");
}

TEST_CASE("nn check: files that cannot be checked are refused")
{
    const auto broken = [](auto&& change) {
        Safetensors file = makeVector();
        change(file);
        CHECK_THROWS_AS((void)check(file), FileError);
    };
    broken([](Safetensors& f) { f.metadata.erase("op"); });
    broken([](Safetensors& f) { f.metadata["op"] = "softmax"; });
    broken([](Safetensors& f) { f.metadata["stride"] = "two"; });
    broken([](Safetensors& f) { f.metadata["stride"] = "0"; });
    broken([](Safetensors& f) { f.metadata["padding"] = "99999999999999999999"; });
    broken([](Safetensors& f) { f.metadata["kernel"] = "5"; });
    broken([](Safetensors& f) { f.metadata.erase("padding"); });
    broken([](Safetensors& f) { f.tensors.erase("weight"); });
    broken([](Safetensors& f) { f.tensors.erase("dx"); });
    broken([](Safetensors& f) { f.tensors["bias"] = {{4}, {1, 2, 3, 4}}; });
    broken([](Safetensors& f) { f.tensors["x"] = {{1, 3, 1, 1}, {1, 2, 3}}; });
    broken([](Safetensors& f) { f.tensors["x"].shape = {252}; });
    broken([](Safetensors& f) { f.tensors["x"].values[5] = NAN; });
    broken([](Safetensors& f) { f.metadata = {{"net", "?"}}; });
    broken([](Safetensors& f) { f.metadata = {{"decode", "?"}}; });
    CHECK_THROWS_AS((void)checkFile(context(), "no/such/file.safetensors"), FileError);
}

TEST_CASE("nn check: the shared vectors pass")
{
    const auto files = vectorFiles();
    if (files.empty())
        MESSAGE("no shared vectors: skipped");
    for (const auto& path : files) {
        const CheckReport report = checkFile(context(), path);
        for (const CheckRow& row : report.rows) {
            CAPTURE(report.file);
            CAPTURE(row.name);
            CAPTURE(row.error);
            CHECK(row.pass);
        }
    }
}
