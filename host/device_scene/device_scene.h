// A scene on the device: its buffers, what its kernels are compiled for, and what is kept of it on the host.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "box_structure.h"
#include "crop.h"
#include "layer_plan.h"
#include "light_cache.h"
#include "medium_outline.h"
#include "scene_buffers.h"
#include "specialization.h"

namespace vkvol {

class DeviceScene {
public:
    // Uploads `assets`. `most_grid_bytes`, `most_texel_bytes`: see SceneBuffers. `ray_queries`: the device searches for
    // surfaces. Throws InputError for what cannot be rendered, and RenderError where the device is too small.
    DeviceScene(const Device& device, Commands& commands, const Scene& scene, const Method& method,
                const Assets& assets, Crop crop, std::uint32_t seed, std::uint64_t most_grid_bytes,
                std::uint64_t most_texel_bytes, bool ray_queries = false);

    // The cache of light, if the method has one: its place, its kernels, and what is in it.
    void make_light_cache();
    void compile_light_cache(const PipelineCache* cache);
    void fill_light_cache();
    void set_queues(std::uint32_t slots, std::uint32_t queue_capacity);
    // Paths that have a record of layers at a time.
    void set_records(std::uint32_t records) { frame_.layers.records = records; }
    // Seen by the kernels from the next set_rows on.
    void set_seed(std::uint32_t seed) { frame_.seed = seed; }
    // The part of the picture that is rendered next.
    void set_rows(std::uint32_t first, std::uint32_t count);

    const shared::FrameParams& frame() const { return frame_; }
    const Specialization& specialization() const { return specialization_; }
    unsigned form() const { return form_; } // of its kernels, see specialization.h
    bool emits() const { return specialization_[SPEC_EMISSION] != EMISSION_NONE; }
    const std::string& text() const { return text_; } // of its kernels
    glm::dvec3 origin() const { return origin_; }     // of render space, in world space
    const LayerPlan& layers() const { return layers_; }
    const LightTable& lights() const { return lights_; }                   // empty where there is no choice
    std::span<const shared::MediumParams> media() const { return media_; } // of several
    const SurfaceTable& surfaces() const { return surfaces_; }
    std::span<const glm::vec3> points() const { return points_; } // where flux is read, render space
    BoundBuffers bound() const;
    VkAccelerationStructureKHR boxes() const { return boxes_ ? boxes_->handle() : VK_NULL_HANDLE; }
    std::uint64_t bytes() const;

private:
    void make_lights(const Scene& scene, const Method& method, const Assets& assets);
    void upload_media(const Scene& scene, const Method& method, const Assets& assets, std::uint64_t most_texel_bytes);
    void make_surfaces(const Scene& scene, const Assets& assets, bool ray_queries);
    double reach_of_rays(const Scene& scene, const Assets& assets) const;
    void make_emitters(const Scene& scene, const Method& method, const Assets& assets);
    double reach_of_all(const Scene& scene, const Assets& assets) const;

    const Device& device_;
    Commands& commands_;
    Specialization specialization_;
    shared::FrameParams frame_;
    SceneBuffers buffers_;
    LightTable lights_;
    SurfaceTable surfaces_;
    LayerPlan layers_;
    std::vector<shared::MediumParams> media_;
    std::vector<glm::vec3> points_;
    std::optional<LightCache> light_cache_;
    std::optional<BoxStructure> boxes_;
    unsigned form_;
    std::string text_;
    glm::dvec3 origin_;
    std::vector<glm::vec3> cache_directions_;
};

} // namespace vkvol
