#include "light_cache.h"

#include <algorithm>
#include <cmath>

#include "average_forms.h"
#include "shade.spv.h"

namespace vkvol {

namespace {

std::uint64_t count(const shared::LatticeParams& lattice) {
    return std::uint64_t(lattice.dims.x) * std::uint64_t(lattice.dims.y) * std::uint64_t(lattice.dims.z);
}

BoundBuffers with_lattice(BoundBuffers scene, const Buffer& lattice, bool texels) {
    scene[BINDING_LATTICE] = &lattice;
    scene[BINDING_LATTICE_TEXELS] = texels ? &lattice : nullptr;
    return scene;
}

} // namespace

shared::LatticeParams make_lattice(glm::dvec3 low, glm::dvec3 high, glm::dvec3 edges, glm::ivec3 voxels,
                                   int most_nodes) {
    shared::LatticeParams lattice{};
    const double spacing = std::max({edges.x, edges.y, edges.z}) / (most_nodes - 1);
    for (int axis = 0; axis < 3; ++axis) {
        const double wanted = std::ceil(edges[axis] / spacing) + 1.0;
        const double most = voxels == glm::ivec3(0) ? most_nodes : std::min(most_nodes, voxels[axis] + 2);
        lattice.dims[axis] = static_cast<int>(std::clamp(wanted, 2.0, most));
        lattice.spacing[axis] = static_cast<float>((high[axis] - low[axis]) / (lattice.dims[axis] - 1));
    }
    lattice.low = low;
    return lattice;
}

CacheLayout cache_layout(const Scene& scene) {
    if (const DirectionalLight* sun = lone_directional(scene))
        return {{glm::vec3(sun->direction)}, 64}; // twice as many nodes were no better
    CacheLayout all{{}, 32};
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {1.0f, -1.0f}) {
            all.directions.emplace_back(0.0f);
            all.directions.back()[axis] = sign;
        }
    for (int signs = 0; signs < 8; ++signs) {
        const glm::vec3 negative(signs & 1, signs >> 1 & 1, signs >> 2);
        all.directions.push_back((1.0f - 2.0f * negative) / std::sqrt(3.0f));
    }
    return all;
}

std::uint64_t cache_entries(const shared::LatticeParams& lattice, std::size_t directions) {
    return (1 + directions) * count(lattice);
}

LightCache::LightCache(const Device& device, const BoundBuffers& scene, const shared::LatticeParams& lattice,
                       std::vector<glm::vec3> directions, bool texels)
    : device_(device),
      buffer_(device, "light cache", cache_entries(lattice, directions.size()) * sizeof(glm::vec4),
              VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT, BufferPlace::device),
      bindings_(device, with_lattice(scene, buffer_, texels)), directions_(std::move(directions)),
      nodes_(static_cast<std::uint32_t>(count(lattice))) {}

void LightCache::compile(const Specialization& specialization, unsigned form, const PipelineCache* cache) {
    for (const EmbeddedKernel& spirv : {average_forms[form], shade_spv})
        passes_.push_back(std::make_unique<ComputePass>(device_, bindings_, spirv, specialization, cache));
}

// A GPU's driver waits for a second or two: where noise or many media make a node dear, all of them would take longer.
void LightCache::run(Commands& commands, const ComputePass& pass, shared::PassPush push) const {
    constexpr std::uint32_t at_once = 1u << 15;
    for (std::uint32_t begin = 0; begin < nodes_; begin += at_once) {
        push.node_begin = begin;
        commands.run([&](VkCommandBuffer recorded) {
            pass.record(recorded, push, std::min(at_once, nodes_ - begin));
            record_barrier(recorded);
        });
    }
}

void LightCache::fill(Commands& commands) {
    commands.fill(buffer_, 0); // the corners beyond the border are read, with weight 0
    run(commands, *passes_.front(), {});
    for (std::size_t i = 0; i < directions_.size(); ++i) {
        shared::PassPush push{};
        push.lattice = static_cast<std::uint32_t>(1 + i);
        push.towards = directions_[i];
        run(commands, *passes_.back(), push);
    }
    passes_.clear();
}

} // namespace vkvol
