#include "box_structure.h"

#include <fmt/format.h>

#include "vulkan_error.h"

namespace vkvol {

namespace {

// Those of extensions are not among what the loader exports.
template <class Function> Function function_of(const Device& device, const char* name) {
    return reinterpret_cast<Function>(vkGetDeviceProcAddr(device.handle(), name));
}

constexpr VkBufferUsageFlags input =
    VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;

// What was written before, by whatever means, is there for the build, and what that writes for what comes after.
void record_build_barrier(VkCommandBuffer commands, VkPipelineStageFlags before, VkPipelineStageFlags after) {
    VkMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
    barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    vkCmdPipelineBarrier(commands, before, after, 0, 1, &barrier, 0, nullptr, 0, nullptr);
}

VkAccelerationStructureGeometryKHR geometry_of(VkGeometryTypeKHR type) {
    VkAccelerationStructureGeometryKHR geometry{};
    geometry.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR;
    geometry.geometryType = type;
    return geometry;
}

} // namespace

BoxStructure::BoxStructure(const Device& device, Commands& commands, std::span<const VkAabbPositionsKHR> boxes)
    : device_(device) {
    const auto count = static_cast<std::uint32_t>(boxes.size());
    if (boxes.size() > device.box_limits().most)
        throw InputError(
            fmt::format("the surfaces have {} pieces, but \"{}\" searches no more than {}; leave hits=query "
                        "out of --schedule, or decimate the meshes",
                        boxes.size(), device.info().name, device.box_limits().most));
    try {
        const Buffer corners(device, "boxes of surfaces", boxes.size_bytes(), input, BufferPlace::device);
        commands.upload(corners, std::as_bytes(boxes));
        VkAccelerationStructureGeometryKHR geometry = geometry_of(VK_GEOMETRY_TYPE_AABBS_KHR);
        geometry.geometry.aabbs = {VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_AABBS_DATA_KHR,
                                   nullptr,
                                   {.deviceAddress = corners.address()},
                                   sizeof(VkAabbPositionsKHR)};
        build(commands, lower_, geometry, count, VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, "boxes of surfaces");

        VkAccelerationStructureInstanceKHR as_it_is{};
        for (int axis = 0; axis < 3; ++axis)
            as_it_is.transform.matrix[axis][axis] = 1.0f;
        as_it_is.mask = 0xff;
        as_it_is.accelerationStructureReference = address_of(lower_);
        const Buffer instance(device, "place of the boxes", sizeof as_it_is, input, BufferPlace::device);
        commands.upload(instance, std::as_bytes(std::span(&as_it_is, 1)));
        geometry = geometry_of(VK_GEOMETRY_TYPE_INSTANCES_KHR);
        geometry.geometry.instances = {VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR,
                                       nullptr,
                                       VK_FALSE,
                                       {.deviceAddress = instance.address()}};
        build(commands, upper_, geometry, 1, VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR, "place of the boxes");
    } catch (...) {
        release();
        throw;
    }
}

void BoxStructure::build(Commands& commands, Level& level, const VkAccelerationStructureGeometryKHR& what,
                         std::uint32_t count, VkAccelerationStructureTypeKHR type, const char* name) {
    VkAccelerationStructureBuildGeometryInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR;
    info.type = type;
    info.flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR;
    info.geometryCount = 1;
    info.pGeometries = &what;
    VkAccelerationStructureBuildSizesInfoKHR sizes{};
    sizes.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR;
    function_of<PFN_vkGetAccelerationStructureBuildSizesKHR>(device_, "vkGetAccelerationStructureBuildSizesKHR")(
        device_.handle(), VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &info, &count, &sizes);

    level.buffer.emplace(device_, name, sizes.accelerationStructureSize,
                         VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR |
                             VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT,
                         BufferPlace::device);
    VkAccelerationStructureCreateInfoKHR create{};
    create.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR;
    create.buffer = level.buffer->handle();
    create.size = sizes.accelerationStructureSize;
    create.type = type;
    VK_CHECK(function_of<PFN_vkCreateAccelerationStructureKHR>(device_, "vkCreateAccelerationStructureKHR")(
        device_.handle(), &create, nullptr, &level.handle));

    const VkDeviceSize alignment = device_.box_limits().scratch_alignment;
    const Buffer scratch(device_, "room to build in", sizes.buildScratchSize + alignment,
                         VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT,
                         BufferPlace::device);
    info.dstAccelerationStructure = level.handle;
    info.scratchData.deviceAddress = (scratch.address() + alignment - 1) / alignment * alignment;
    const VkAccelerationStructureBuildRangeInfoKHR range{count, 0, 0, 0};
    const VkAccelerationStructureBuildRangeInfoKHR* const ranges = &range;
    const auto record =
        function_of<PFN_vkCmdBuildAccelerationStructuresKHR>(device_, "vkCmdBuildAccelerationStructuresKHR");
    commands.run([&](VkCommandBuffer buffer) {
        record_build_barrier(buffer, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                             VK_PIPELINE_STAGE_ACCELERATION_STRUCTURE_BUILD_BIT_KHR);
        record(buffer, 1, &info, &ranges);
        record_build_barrier(buffer, VK_PIPELINE_STAGE_ACCELERATION_STRUCTURE_BUILD_BIT_KHR,
                             VK_PIPELINE_STAGE_ALL_COMMANDS_BIT);
    });
}

VkDeviceAddress BoxStructure::address_of(const Level& level) const {
    VkAccelerationStructureDeviceAddressInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR;
    info.accelerationStructure = level.handle;
    return function_of<PFN_vkGetAccelerationStructureDeviceAddressKHR>(
        device_, "vkGetAccelerationStructureDeviceAddressKHR")(device_.handle(), &info);
}

BoxStructure::~BoxStructure() {
    release();
}

void BoxStructure::release() {
    const auto destroy =
        function_of<PFN_vkDestroyAccelerationStructureKHR>(device_, "vkDestroyAccelerationStructureKHR");
    for (Level* level : {&upper_, &lower_})
        if (level->handle)
            destroy(device_.handle(), level->handle, nullptr);
}

} // namespace vkvol
