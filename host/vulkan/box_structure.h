// Boxes in space as a device's own units search them: an acceleration structure of two levels, as Vulkan will have it,
// of which the upper holds nothing but the lower one.
#pragma once

#include <optional>

#include "commands.h"

namespace vkvol {

class BoxStructure {
public:
    // `device` has ray queries. What kernels learn of a box is its place among `boxes`, of which there is at least one.
    // Throws InputError for more of them than the device takes, RenderError where its memory is short.
    BoxStructure(const Device& device, Commands& commands, std::span<const VkAabbPositionsKHR> boxes);
    ~BoxStructure();
    BoxStructure(const BoxStructure&) = delete;
    BoxStructure& operator=(const BoxStructure&) = delete;

    VkAccelerationStructureKHR handle() const { return upper_.handle; }
    VkDeviceSize bytes() const { return lower_.bytes() + upper_.bytes(); }

private:
    struct Level {
        std::optional<Buffer> buffer = {};
        VkAccelerationStructureKHR handle = VK_NULL_HANDLE;
        VkDeviceSize bytes() const { return buffer ? buffer->bytes() : 0; }
    };

    void build(Commands& commands, Level& level, const VkAccelerationStructureGeometryKHR& what, std::uint32_t count,
               VkAccelerationStructureTypeKHR type, const char* name);
    VkDeviceAddress address_of(const Level& level) const;
    void release();

    const Device& device_;
    Level lower_, upper_;
};

} // namespace vkvol
