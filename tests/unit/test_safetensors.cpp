#include <doctest/doctest.h>

#include <cstring>
#include <filesystem>

#include "compute_nn/safetensors.hpp"
#include "engine/base/error.hpp"
#include "engine/base/file.hpp"
#include "shaders/shared/rng.h"
#include "tests/nn/vectors.hpp"

using namespace strandlight;

namespace {

std::filesystem::path scratch(const char* name)
{
    return std::filesystem::temp_directory_path() / name;
}

// A file of this header and so many zero bytes.
std::filesystem::path write(const std::string& header, std::size_t dataBytes)
{
    std::string bytes(8 + header.size() + dataBytes, '\0');
    const std::uint64_t length = header.size();
    std::memcpy(bytes.data(), &length, 8);
    std::memcpy(bytes.data() + 8, header.data(), header.size());
    const auto path = scratch("strandlight_test_broken.safetensors");
    writeFileAtomically(path, bytes);
    return path;
}

} // namespace

TEST_CASE("safetensors: what is saved is loaded")
{
    Safetensors file;
    file.metadata = {{"op", "conv2d"}, {"note", "\"quoted\" \xc3\xa9"}};
    file.tensors["a"] = {{2, 3}, {1, 2, 3, 4, 5, -6.5f}};
    file.tensors["scalar"] = {{}, {7}};
    file.tensors["empty"] = {{0, 4}, {}};
    const auto path = scratch("strandlight_test_round_trip.safetensors");
    file.save(path);
    const Safetensors again = Safetensors::load(path);
    CHECK_EQ(again.metadata, file.metadata);
    REQUIRE_EQ(again.tensors.size(), 3);
    for (const auto& [name, tensor] : file.tensors) {
        CHECK_EQ(again.tensors.at(name).shape, tensor.shape);
        CHECK_EQ(again.tensors.at(name).values, tensor.values);
    }
    std::filesystem::remove(path);

    file.tensors["a"].shape = {2, 4};
    CHECK_THROWS_AS(file.save(path), Error);
    CHECK_FALSE(std::filesystem::exists(path));
}

TEST_CASE("safetensors: half precision is widened")
{
    const std::string header = R"({"h":{"dtype":"F16","shape":[5],"data_offsets":[0,10]}})";
    std::vector<std::uint8_t> bytes = readFile(write(header, 10));
    const std::uint16_t halves[5] = {0x3c00, 0xc000, 0x0001, 0x7c00, 0x7bff};
    std::memcpy(bytes.data() + 8 + header.size(), halves, 10);
    const auto path = scratch("strandlight_test_half.safetensors");
    writeFileAtomically(path, bytes);
    CHECK_EQ(Safetensors::load(path).tensors.at("h").values,
             std::vector<float>{1.0f, -2.0f, 0x1p-24f, INFINITY, 65504.0f});
    std::filesystem::remove(path);
}

TEST_CASE("safetensors: broken files are refused")
{
    const char* const headers[] = {
        "",
        "[]",
        "{",
        R"({"a":1})",
        R"({"a":{"dtype":"F32","shape":[2]}})",
        R"({"a":{"dtype":"I64","shape":[1],"data_offsets":[0,8]}})",
        R"({"a":{"dtype":"F32","shape":[2],"data_offsets":[0,4]}})",
        R"({"a":{"dtype":"F32","shape":[2],"data_offsets":[8,0]}})",
        R"({"a":{"dtype":"F32","shape":[4],"data_offsets":[0,16]}})",
        R"({"a":{"dtype":"F32","shape":[-1],"data_offsets":[0,8]}})",
        R"({"a":{"dtype":"F32","shape":[1.5],"data_offsets":[0,8]}})",
        R"({"a":{"dtype":"F32","shape":[2,"x"],"data_offsets":[0,8]}})",
        R"({"a":{"dtype":"F32","shape":[4294967296,4294967296,1],"data_offsets":[0,0]}})",
        R"({"a":{"dtype":"F32","shape":[1,1,1,1,1,1,1,1,2],"data_offsets":[0,8]}})",
        R"({"a":{"dtype":"F32","shape":[2],"data_offsets":[18446744073709551612,4]}})",
        R"({"__metadata__":{"op":3}})",
        R"({"__metadata__":[]})",
        R"({"a":[[[[[[[[[[]]]]]]]]]]})",
    };
    for (const char* header : headers) {
        CAPTURE(header);
        CHECK_THROWS_AS((void)Safetensors::load(write(header, 8)), FileError);
    }
    const auto path = scratch("strandlight_test_broken.safetensors");
    for (std::uint64_t length : {~std::uint64_t(0), std::uint64_t(1) << 40, std::uint64_t(3)}) {
        writeFileAtomically(path, std::string(reinterpret_cast<const char*>(&length), 8));
        CHECK_THROWS_AS((void)Safetensors::load(path), FileError);
    }
    writeFileAtomically(path, std::string("abc"));
    CHECK_THROWS_AS((void)Safetensors::load(path), FileError);
    std::filesystem::remove(path);
    CHECK_THROWS_AS((void)Safetensors::load(path), FileError);
}

TEST_CASE("safetensors: 1000 mutated files load or are refused, nothing else")
{
    const std::string header =
        R"({"__metadata__":{"op":"x"},"a":{"dtype":"F32","shape":[2,2],"data_offsets":[0,16]},)"
        R"("b":{"dtype":"F16","shape":[4],"data_offsets":[16,24]}})";
    const std::vector<std::uint8_t> good = readFile(write(header, 24));
    const auto path = scratch("strandlight_test_mutated.safetensors");
    std::uint32_t loaded = 0, refused = 0;
    for (std::uint32_t i = 0; i < 1000; ++i) {
        std::vector<std::uint8_t> bytes = good;
        const glm::uvec3 h = gpu::hashPcg3(glm::uvec3(i, 1, 2));
        if (h.x % 4 == 0)
            bytes.resize(h.y % bytes.size());
        for (std::uint32_t k = 0; k <= h.x % 3 && !bytes.empty(); ++k)
            bytes[gpu::hashPcg(h.y + k) % bytes.size()] = std::uint8_t(gpu::hashPcg(h.z + k));
        std::FILE* out = std::fopen(path.c_str(), "wb"); // not atomically: 1000 fsyncs take seconds
        REQUIRE(out);
        std::fwrite(bytes.data(), 1, bytes.size(), out);
        std::fclose(out);
        try {
            (void)Safetensors::load(path);
            ++loaded;
        } catch (const FileError&) {
            ++refused;
        }
    }
    std::filesystem::remove(path);
    CHECK_EQ(loaded + refused, 1000);
    CHECK_GT(refused, 250); // the mutations do reach the checks
}

TEST_CASE("safetensors: the shared vectors load")
{
    const auto files = test::vectorFiles();
    if (files.empty())
        MESSAGE("no shared vectors: skipped");
    for (const auto& path : files) {
        const Safetensors file = Safetensors::load(path);
        CHECK_FALSE(file.tensors.empty());
        CHECK_FALSE(file.metadata.empty());
    }
}
