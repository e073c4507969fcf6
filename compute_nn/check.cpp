#include "compute_nn/check.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "compute_nn/check_file.hpp"
#include "engine/base/error.hpp"

namespace strandlight {

VectorFile::VectorFile(const std::filesystem::path& path)
    : path_(path.string()), file_(Safetensors::load(path))
{
}

void VectorFile::refuse(const std::string& place, const std::string& reason) const
{
    throw FileError(path_, place, reason);
}

const std::string& VectorFile::field(const std::string& key) const
{
    const auto found = file_.metadata.find(key);
    if (found == file_.metadata.end())
        refuse("__metadata__", "has no \"" + key + "\"");
    return found->second;
}

std::vector<std::uint32_t> VectorFile::numbers(const std::string& key) const
{
    const std::string& text = field(key);
    std::vector<std::uint32_t> values;
    for (std::size_t i = 0; i < text.size();) {
        const unsigned char c = static_cast<unsigned char>(text[i]);
        if (!std::isdigit(c)) {
            if (c != '[' && c != ']' && c != ',' && c != ' ')
                refuse("__metadata__ \"" + key + "\"", "\"" + text + "\" is not a list of sizes");
            ++i;
            continue;
        }
        std::uint64_t value = 0;
        for (; i < text.size() && std::isdigit(static_cast<unsigned char>(text[i])); ++i)
            value = std::min<std::uint64_t>(value * 10 + std::uint64_t(text[i] - '0'), 1u << 20);
        values.push_back(std::uint32_t(value));
    }
    if (values.size() == 1)
        values.push_back(values.front());
    return values;
}

Extent2 VectorFile::pair(const std::string& key) const
{
    const std::vector<std::uint32_t> values = numbers(key);
    if (values.size() != 2)
        refuse("__metadata__ \"" + key + "\"", "is not one size or two");
    return {values[0], values[1]};
}

const NamedTensor& VectorFile::tensor(const std::string& name) const
{
    const auto found = file_.tensors.find(name);
    if (found == file_.tensors.end())
        refuse("tensor \"" + name + "\"", "is missing");
    for (float value : found->second.values)
        if (!std::isfinite(value))
            refuse("tensor \"" + name + "\"", "holds a value that is not finite");
    return found->second;
}

const NamedTensor& VectorFile::tensor(const std::string& name,
                                      const std::vector<std::uint64_t>& shape) const
{
    const NamedTensor& found = tensor(name);
    if (found.shape == shape)
        return found;
    refuse("tensor \"" + name + "\"",
           "has shape " + shapeText(found.shape) + ", wanted " + shapeText(shape));
}

TensorDesc VectorFile::desc(const std::string& name) const
{
    const NamedTensor& found = tensor(name);
    const auto& s = found.shape;
    if (s.size() != 4 || *std::min_element(s.begin(), s.end()) == 0 ||
        *std::max_element(s.begin(), s.end()) > 0xffffu)
        refuse("tensor \"" + name + "\"", "is not [N,C,H,W] with sides of 1 to 65535");
    return {std::uint32_t(s[0]), std::uint32_t(s[1]), std::uint32_t(s[2]), std::uint32_t(s[3])};
}

void addRow(CheckReport& report, const std::string& name, std::span<const float> ours,
            std::span<const float> theirs, double tolerance)
{
    double difference = 0.0, norm = 0.0;
    for (std::size_t i = 0; i < theirs.size(); ++i) {
        const double d = i < ours.size() ? double(ours[i]) - theirs[i] : double(NAN);
        difference += d * d;
        norm += double(theirs[i]) * theirs[i];
    }
    // A reference of zeros is compared absolutely: any error but zero is then relative to the
    // smallest float.
    const double error = std::sqrt(difference) / std::max(std::sqrt(norm), 1e-38);
    report.rows.push_back({name, error, tolerance, error <= tolerance});
}

bool CheckReport::pass() const
{
    return std::all_of(rows.begin(), rows.end(), [](const CheckRow& row) { return row.pass; });
}

CheckReport checkFile(Context& context, const std::filesystem::path& path)
{
    const VectorFile file(path);
    CheckReport report{.file = file.path(), .op = "", .rows = {}};
    if (file.hasField("op"))
        report.op = file.field("op");
    else if (file.hasField("net"))
        report.op = "unet";
    else if (file.hasField("decode"))
        report.op = "sg_mixture";
    try {
        if (report.op == "conv2d" || report.op == "Conv")
            checkConv(context, file, report, false, report.op == "Conv");
        else if (report.op == "conv_transpose2d" || report.op == "ConvTranspose")
            checkConv(context, file, report, true, report.op == "ConvTranspose");
        else if (report.op == "sg_mixture")
            checkSgMixture(context, file, report);
        else if (report.op == "unet")
            checkUNet(context, file, report);
        else
            file.refuse("__metadata__",
                        report.op.empty() ? "names no op"
                                          : "names the op \"" + report.op +
                                                "\", which is not one of conv2d, conv_transpose2d, "
                                                "Conv, ConvTranspose, sg_mixture, unet");
    } catch (const FileError&) {
        throw;
    } catch (const VulkanError&) {
        throw;
    } catch (const Error& error) { // shapes that no layer accepts are the file's fault here
        file.refuse("", error.what());
    }
    return report;
}

} // namespace strandlight
