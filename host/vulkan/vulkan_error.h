// Every Vulkan failure is an exception with the call, the result and the place.
#pragma once

#include <string>
#include <vulkan/vulkan.h>

#include "error.h"

namespace vkvol {

const char* result_name(VkResult result);

struct VulkanError : RenderError {
    VulkanError(const char* call, VkResult result, const char* file, int line);
    VulkanError(VkResult result, const std::string& text);
    bool lacks_memory() const;
    VkResult result;
};

// Throws VulkanError unless `result` is a success code. Also in release builds.
inline void check_vulkan(VkResult result, const char* call, const char* file, int line) {
    if (result < 0)
        throw VulkanError(call, result, file, line);
}

#define VK_CHECK(call) ::vkvol::check_vulkan((call), #call, __FILE__, __LINE__)

} // namespace vkvol
