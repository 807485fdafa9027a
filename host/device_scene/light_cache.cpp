#include "light_cache.h"

#include <algorithm>
#include <cmath>

#include "average_forms.h"
#include "shade.spv.h"

namespace vkvol {

namespace {

constexpr double most_nodes = 64.0; // along an edge: twice as many were no better

std::uint64_t count(const shared::LatticeParams& lattice) {
    return std::uint64_t(lattice.dims.x) * std::uint64_t(lattice.dims.y) * std::uint64_t(lattice.dims.z);
}

BoundBuffers with_lattice(BoundBuffers scene, const Buffer& lattice) {
    scene[BINDING_LATTICE] = scene[BINDING_LATTICE_TEXELS] = &lattice;
    return scene;
}

} // namespace

shared::LatticeParams make_lattice(glm::dvec3 low, glm::dvec3 high, glm::dvec3 edges, glm::ivec3 voxels) {
    shared::LatticeParams lattice{};
    const double spacing = std::max({edges.x, edges.y, edges.z}) / (most_nodes - 1.0);
    for (int axis = 0; axis < 3; ++axis) {
        const double wanted = std::ceil(edges[axis] / spacing) + 1.0;
        const double most = voxels == glm::ivec3(0) ? most_nodes : std::min(most_nodes, voxels[axis] + 2.0);
        lattice.dims[axis] = static_cast<int>(std::clamp(wanted, 2.0, most));
        lattice.spacing[axis] = static_cast<float>((high[axis] - low[axis]) / (lattice.dims[axis] - 1));
    }
    lattice.low = low;
    return lattice;
}

LightCache::LightCache(const Device& device, const BoundBuffers& scene, const shared::LatticeParams& lattice)
    : device_(device),
      buffer_(device, "light cache", 2 * count(lattice) * sizeof(glm::vec4),
              VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT, BufferPlace::device),
      bindings_(device, with_lattice(scene, buffer_)), nodes_(static_cast<std::uint32_t>(count(lattice))) {}

void LightCache::compile(const Specialization& specialization, unsigned form, VkPipelineCache cache) {
    for (const std::span<const std::uint32_t> spirv : {average_forms[form], std::span<const std::uint32_t>(shade_spv)})
        passes_.push_back(std::make_unique<ComputePass>(device_, bindings_, spirv, specialization, cache));
}

void LightCache::fill(Commands& commands) {
    commands.fill(buffer_, 0); // the corners beyond the border are read, with weight 0
    const shared::PassPush push{};
    for (const std::unique_ptr<ComputePass>& pass : passes_)
        commands.run([&](VkCommandBuffer recorded) {
            pass->record(recorded, push, nodes_);
            record_barrier(recorded);
        });
    passes_.clear();
}

} // namespace vkvol
