// A test-vector file while it is being checked: tensors by name with the errors a user should see.
// Internal to check*.cpp.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "compute_nn/check.hpp"
#include "compute_nn/conv_desc.hpp"
#include "compute_nn/safetensors.hpp"

namespace strandlight {

class VectorFile
{
public:
    explicit VectorFile(const std::filesystem::path& path);

    const std::string& path() const { return path_; }
    bool hasField(const std::string& key) const { return file_.metadata.count(key) != 0; }
    bool has(const std::string& tensor) const { return file_.has(tensor); }
    const std::string& field(const std::string& key) const;
    // "3" gives {3, 3}, "[3, 2]" gives {3, 2}, "[1, 1, 1, 1]" gives {1, 1, 1, 1}.
    std::vector<std::uint32_t> numbers(const std::string& key) const;
    Extent2
    pair(const std::string& key) const; // two numbers; throws FileError when it is anything else

    const NamedTensor& tensor(const std::string& name) const;
    const NamedTensor& tensor(const std::string& name,
                              const std::vector<std::uint64_t>& shape) const;
    TensorDesc desc(const std::string& name) const; // of a tensor of four sides

    [[noreturn]] void refuse(const std::string& place, const std::string& reason) const;

private:
    std::string path_;
    Safetensors file_;
};

// Adds the row "name": relative error of ours against theirs.
void addRow(CheckReport& report, const std::string& name, std::span<const float> ours,
            std::span<const float> theirs, double tolerance);

// The checks themselves: check_conv.cpp, check_networks.cpp.
void checkConv(Context& context, const VectorFile& file, CheckReport& report, bool transposed,
               bool onnx);
void checkSgMixture(Context& context, const VectorFile& file, CheckReport& report);
void checkUNet(Context& context, const VectorFile& file, CheckReport& report);

} // namespace strandlight
