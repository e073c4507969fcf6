// Instance, device, queue, caches. Headless first; the only place that chooses a device.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace strandlight {

struct DeviceInfo
{
    std::string name;
    std::string driver;
    std::string type;                  // "discrete", "integrated", "cpu", ...
    std::vector<std::string> refusals; // why this device cannot be used; empty: it can
    std::string matrixUnits;           // whether kernels use them, or what is missing
    std::string missingForHalves;      // why no tensor can be stored as halves; empty: it can
};

struct ContextSettings
{
    // An index or part of a device's name; "": discrete before integrated before cpu.
    std::string device;
    bool validation = false;        // core and synchronization; a message makes the submit throw
    bool pipelineCache = true;      // on disk, $XDG_CACHE_HOME/strandlight
    std::uint64_t memoryBudget = 0; // bytes; 0: 80 % of the device's heap
    std::uint64_t bindingBytes = 0; // most that one binding may have; 0: what the device allows
    bool subgroups = true;          // false: kernels take the forms that need no subgroup
    bool gpuForms = false;          // true: kernels take a GPU's forms on a CPU too, for tests
};

struct VulkanState; // the Vulkan objects; engine/vk and engine/graph's executor only

class Context
{
public:
    static Context headless(const ContextSettings& settings = {});
    static std::vector<DeviceInfo> devices();

    Context(Context&&) noexcept;
    Context& operator=(Context&&) noexcept;
    ~Context();

    const DeviceInfo& device() const;
    std::uint32_t subgroupSize() const;
    bool cpuForms() const;                       // do kernels take the forms of a CPU?
    std::uint64_t maxStorageBufferBytes() const; // range limit of one binding (128 MiB on lavapipe)
    // The most that can be bound both as a storage and as a texel buffer of floats, as tensors are.
    std::uint64_t maxTensorBindingBytes() const;
    std::uint64_t bytesAllocated() const;
    std::uint64_t peakBytesAllocated() const;
    std::uint32_t pipelinesCreated() const;
    // Validation messages so far; 0 unless validation is on.
    std::uint32_t validationMessages() const;
    std::string firstValidationMessage() const;

    VulkanState& vulkan() const { return *state_; }

private:
    explicit Context(std::unique_ptr<VulkanState> state);
    std::unique_ptr<VulkanState> state_;
};

} // namespace strandlight
