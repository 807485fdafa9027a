// The cached transmittances that next-event estimation corrects; see shaders/lights/light_cache.glsl.
#pragma once

#include <memory>
#include <vector>

#include "commands.h"
#include "compute_pass.h"
#include "loaded_medium.h"

namespace vkvol {

// Nodes over the box from `low` to `high` (medium space), whose edges are `edges` world units long: cubes in world
// space where they can be, at most `most` along an edge, and at most two for each voxel of `voxels` along it (0: no
// grid).
shared::LatticeParams make_lattice(glm::dvec3 low, glm::dvec3 high, glm::dvec3 edges, glm::ivec3 voxels, int most);

// Directions in which it knows optical depths, unit, and nodes along its longest edge. Towards a single directional
// light, or all around, see CACHE_DIRECTIONS.
struct CacheLayout {
    std::vector<glm::vec3> directions;
    int most_nodes = 0;
};
CacheLayout cache_layout(const Scene& scene);

// vec4s that it holds.
std::uint64_t cache_entries(const shared::LatticeParams& lattice, std::size_t directions);

class LightCache {
public:
    // The scene's buffers and frame are on the device. `texels`: it is read as such, see SPEC_TEXELS.
    LightCache(const Device& device, const BoundBuffers& scene, const shared::LatticeParams& lattice,
               std::vector<glm::vec3> directions, bool texels);

    void compile(const Specialization& specialization, unsigned form, const PipelineCache* cache);
    // Once compiled, and before it is read. The kernels go.
    void fill(Commands& commands);

    const Buffer& buffer() const { return buffer_; }

private:
    void run(Commands& commands, const ComputePass& pass, shared::PassPush push) const;

    const Device& device_;
    Buffer buffer_;
    Bindings bindings_;
    std::vector<glm::vec3> directions_;
    std::uint32_t nodes_;
    std::vector<std::unique_ptr<ComputePass>> passes_; // in their order
};

} // namespace vkvol
