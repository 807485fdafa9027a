// A Vulkan instance with one chosen device and one compute queue.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>
#include <vulkan/vulkan.h>

namespace vkvol {

class PipelineLayout;
class Pipelines;

struct DeviceOptions {
    std::string choice = "auto"; // auto | index | part of the name | uuid | cpu
    bool validate = false;       // validation layer with synchronization validation
    bool robust = false;         // robustBufferAccess
    bool ray_queries = false;    // those, if it offers them
};

// Each of several, whose numbers are the choice: "0,1". Any other choice is one.
std::vector<DeviceOptions> each_device(const DeviceOptions& options);

// One physical device as `vkvol devices` lists it. `rejection` is empty if it can be used.
struct DeviceInfo {
    int index = 0;
    std::string name;
    std::string type;                // discrete | integrated | virtual | cpu | other
    std::string driver;              // name and version
    std::string uuid;                // 32 hexadecimal digits
    std::string api;                 // "1.3.230"
    std::uint64_t memory = 0;        // bytes, device-local heaps
    std::uint64_t storage_range = 0; // bytes one storage buffer may span
    unsigned lavapipe = 0;           // Mesa's major version, of its software driver
    bool swiftshader = false;        // it is Google's
    bool conformant = true;          // has passed Khronos' tests, by its own word
    bool addresses = false;          // kernels may reach buffers by address, and so larger grids
    bool ray_queries = false;        // kernels may ask it which boxes a ray is in (VK_KHR_ray_query)
    std::string rejection;
};

// Everything that answers to Vulkan, usable or not. Throws DeviceError if there is no Vulkan loader or driver.
std::vector<DeviceInfo> list_devices();

class Device {
public:
    // Throws DeviceError naming every device and the reason why it was not taken.
    explicit Device(const DeviceOptions& options);
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    VkDevice handle() const { return device_; }
    VkQueue queue() const { return queue_; }
    std::uint32_t queue_family() const { return queue_family_; }
    const DeviceInfo& info() const { return info_; }
    const VkPhysicalDeviceLimits& limits() const { return properties_.limits; }
    VkDeviceSize most_allocation() const { return most_allocation_; } // bytes, in one piece
    const VkPhysicalDeviceProperties& properties() const { return properties_; }
    bool is_cpu() const { return properties_.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU; }
    // Its memory is this machine's.
    bool shares_memory() const { return is_cpu() || properties_.deviceType == VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU; }
    // A kernel has each access to storage as often as a group has lanes, and takes as long to compile: Mesa's software
    // driver, not of 22.3, but of 25.0. Of those between nothing is known.
    bool writes_out_lanes() const { return info_.lavapipe >= 23; }
    bool has_timestamps() const { return timestamp_bits_ >= 36; }
    // Between two marks of one submit, counters that have begun anew between them included.
    std::uint64_t ticks_between(std::uint64_t first, std::uint64_t second) const;
    bool has_addresses() const { return info_.addresses; }
    bool has_ray_queries() const { return has_ray_queries_; } // asked for, and there
    // Of boxes that ray queries look for, and of the address of what they are built in.
    struct BoxLimits {
        std::uint64_t most = 0;
        VkDeviceSize scratch_alignment = 1;
    };
    const BoxLimits& box_limits() const { return box_limits_; }

    // Index of a memory type in `allowed` with all `wanted` properties, or -1.
    int find_memory_type(std::uint32_t allowed, VkMemoryPropertyFlags wanted) const;

    // What has been compiled for it.
    Pipelines& pipelines() const { return *pipelines_; }

    // Of all that is compiled for it.
    const PipelineLayout& layout() const { return *layout_; }

    // What the validation layer has said so far; empty without --validate.
    const std::vector<std::string>& validation_messages() const { return messages_; }

private:
    void create_instance(const DeviceOptions& options);
    void choose_physical(const std::string& choice);
    void create_device(const DeviceOptions& options);
    void destroy();

    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    std::uint32_t queue_family_ = 0;
    std::uint32_t timestamp_bits_ = 0; // valid ones
    bool has_ray_queries_ = false;
    BoxLimits box_limits_;
    std::unique_ptr<PipelineLayout> layout_;
    std::unique_ptr<Pipelines> pipelines_;
    VkPhysicalDeviceProperties properties_{};
    VkPhysicalDeviceMemoryProperties memory_{};
    VkDeviceSize most_allocation_ = 0;
    DeviceInfo info_;
    std::vector<std::string> messages_;
};

} // namespace vkvol
