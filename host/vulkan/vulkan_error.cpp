#include "vulkan_error.h"

#include <cstring>
#include <fmt/format.h>

namespace vkvol {

const char* result_name(VkResult result) {
    switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
        return "VK_ERROR_OUT_OF_HOST_MEMORY";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
        return "VK_ERROR_OUT_OF_DEVICE_MEMORY";
    case VK_ERROR_INITIALIZATION_FAILED:
        return "VK_ERROR_INITIALIZATION_FAILED";
    case VK_ERROR_DEVICE_LOST:
        return "VK_ERROR_DEVICE_LOST";
    case VK_ERROR_MEMORY_MAP_FAILED:
        return "VK_ERROR_MEMORY_MAP_FAILED";
    case VK_ERROR_LAYER_NOT_PRESENT:
        return "VK_ERROR_LAYER_NOT_PRESENT";
    case VK_ERROR_EXTENSION_NOT_PRESENT:
        return "VK_ERROR_EXTENSION_NOT_PRESENT";
    case VK_ERROR_FEATURE_NOT_PRESENT:
        return "VK_ERROR_FEATURE_NOT_PRESENT";
    case VK_ERROR_INCOMPATIBLE_DRIVER:
        return "VK_ERROR_INCOMPATIBLE_DRIVER";
    case VK_ERROR_TOO_MANY_OBJECTS:
        return "VK_ERROR_TOO_MANY_OBJECTS";
    case VK_ERROR_OUT_OF_POOL_MEMORY:
        return "VK_ERROR_OUT_OF_POOL_MEMORY";
    default:
        return "VkResult";
    }
}

namespace {
const char* advice(VkResult result) {
    switch (result) {
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
    case VK_ERROR_OUT_OF_HOST_MEMORY:
        return ": not enough memory; use a smaller picture or a quantised grid";
    case VK_ERROR_DEVICE_LOST:
        return ": the driver gave up; `--device cpu` renders without it";
    default:
        return "";
    }
}
} // namespace

VulkanError::VulkanError(const char* call, VkResult failure, const char* file, int line)
    : RenderError(fmt::format("{} ({}) from {} at {}:{}{}", result_name(failure), static_cast<int>(failure), call,
                              std::strrchr(file, '/') ? std::strrchr(file, '/') + 1 : file, line, advice(failure))),
      result(failure) {}

VulkanError::VulkanError(VkResult failure, const std::string& text) : RenderError(text), result(failure) {}

bool VulkanError::lacks_memory() const {
    return result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY;
}

} // namespace vkvol
