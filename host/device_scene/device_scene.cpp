#include "device_scene.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "camera_rays.h"
#include "emitter_table.h"
#include "even_sky.h"
#include "frame_params.h"
#include "kept_apart.h"
#include "kernel_constants.h"
#include "kernel_text.h"
#include "light_table.h"
#include "overlap_words.h"
#include "piece_boxes.h"
#include "seams.h"
#include "surface_mesh.h"

namespace vkvol {

DeviceScene::DeviceScene(const Device& device, Commands& commands, const Scene& scene, const Method& method,
                         const Assets& assets, Crop crop, std::uint32_t seed, std::uint64_t most_grid_bytes,
                         std::uint64_t most_texel_bytes, bool ray_queries)
    : device_(device), commands_(commands), specialization_(specialize(scene, assets.media, method, whole_of(assets))),
      frame_(make_frame(scene, assets.media, method, crop, seed, whole_of(assets))),
      buffers_(device, commands, assets.media, whole_of(assets), most_grid_bytes, most_texel_bytes),
      layers_(plan_layers(scene)), form_(is_chromatic(scene) || method.paths != PATHS_CAMERA ? form_chromatic : 0),
      text_(kernel_text(specialization_, assets, is_chromatic(scene))),
      origin_(render_origin(scene, assets.media, whole_of(assets))), cache_directions_(cache_layout(scene).directions) {
    const std::uint32_t first_texel = assets.sky ? static_cast<std::uint32_t>(assets.sky->texels.size()) : 0;
    if (!scene.surfaces.empty() && scene.periodic)
        surfaces_ = make_surface_table(kept_off_seams(*scene.periodic, origin_, scene.surfaces), origin_, first_texel);
    else if (!scene.surfaces.empty())
        surfaces_ = make_surface_table(scene.surfaces, origin_, first_texel);
    frame_.sensors[0].position +=
        glm::vec3(shift_of_sensor(scene, surfaces_, origin_) * camera_rays(scene.camera, scene.picture).forward);
    if (specialization_[SPEC_LIGHTS] != LIGHTS_LONE)
        make_lights(scene, method, assets);
    if (assets.superposition)
        upload_media(scene, method, assets, most_texel_bytes);
    // Devices may allow as few as 65536 texels to a buffer.
    const bool fits = cache_entries(frame_.lattice, cache_directions_.size()) <= device.limits().maxTexelBufferElements;
    specialization_[SPEC_TEXELS] = buffers_.texels() && fits ? 1 : 0;
    if (needs_full(specialization_))
        form_ |= form_full;
    if (!scene.surfaces.empty())
        make_surfaces(scene, assets, ray_queries);
    if (method.paths != PATHS_CAMERA)
        make_emitters(scene, method, assets);
    else if (!lights_.pieces.empty())
        buffers_.upload_emitters(device, commands, lights_.pieces);
    specialization_[SPEC_TABLE_TEXELS] = buffers_.find_table_texels(most_texel_bytes) ? 1 : 0;
    for (const glm::dvec3& point : scene.camera.points)
        points_.emplace_back(point - origin_);
    buffers_.upload_points(device, commands, points_);
    if (assets.superposition)
        form_ |= form_full | form_several;
    if (const std::optional<std::uint32_t> bits = buffers_.window_bits()) {
        form_ |= form_windows;
        specialization_[SPEC_WINDOW_BITS] = static_cast<std::int32_t>(*bits);
        text_ += ", grids in windows";
    }
}

void DeviceScene::make_lights(const Scene& scene, const Method& method, const Assets& assets) {
    double radius = lit_radius(scene, assets, frame_.media[0]);
    if (const std::optional<SurfaceBounds> bounds = bounds_of(scene.surfaces)) {
        const double reach = reach_of(*bounds, origin_);
        radius = any_medium(scene, is_everywhere) ? std::min(radius, reach) : std::max(radius, reach);
    }
    lights_ = make_light_table(scene, assets, surfaces_, origin_, radius);
    if (is_left_to_flights(scene, assets.media, method, assets.sky ? &*assets.sky : nullptr)) {
        leave_sky_to_flights(lights_);
        text_ += ", an even sky by flights alone";
    }
    tell_look_densities(lights_, surfaces_);
    if (!assets.superposition) // else media have rows of their own, in the end
        tell_look_densities(lights_, frame_.media);
    if (method.paths != PATHS_CAMERA)
        keep_apart(lights_.rows, surfaces_);
    frame_.choices = lights_.choices;
    frame_.sky_count = lights_.sky_count;
    frame_.lamp_first = lights_.lamp_first;
    frame_.lamp_count = lights_.lamp_count;
    frame_.sky = make_sky_params(scene, assets);
    cache_directions_.insert(cache_directions_.end(), lights_.suns.begin(), lights_.suns.end());
    std::copy(lights_.suns.begin(), lights_.suns.end(), frame_.cache_suns);
    frame_.fluence = lights_.fluence;
    buffers_.upload_lights(device_, commands_, lights_, assets.sky ? &*assets.sky : nullptr);
}

void DeviceScene::upload_media(const Scene& scene, const Method& method, const Assets& assets,
                               std::uint64_t most_texel_bytes) {
    media_ = make_media(scene, assets.media, method, origin_);
    tell_look_densities(lights_, media_);
    const OverlapWords overlaps = overlap_words(media_, assets.media, *assets.superposition);
    frame_.overlaps = overlaps.places;
    frame_.media[0].density = overlaps.grid;
    buffers_.upload_media(device_, commands_, media_, overlaps.words, most_texel_bytes);
}

// World units from the origin, along an axis: where rays begin, but for what is on planes and in media without end.
double DeviceScene::reach_of_rays(const Scene& scene, const Assets& assets) const {
    double reach = 0.0;
    const auto add = [&](const glm::dvec3& place) {
        reach = std::max({reach, std::abs(place.x), std::abs(place.y), std::abs(place.z)});
    };
    add(frame_.sensors[0].position);
    for (const glm::dvec3& point : scene.camera.points)
        add(point - origin_);
    for (const Light& light : scene.lights)
        if (const std::optional<glm::dvec3> place = place_of(light))
            add(*place - origin_);
    if (!any_medium(scene, is_everywhere))
        reach = std::max(reach, lit_radius(scene, assets, frame_.media[0]));
    if (scene.periodic)
        add(scene.periodic->size());
    return reach;
}

void DeviceScene::make_surfaces(const Scene& scene, const Assets& assets, bool ray_queries) {
    form_ |= form_full | form_surfaces;
    const bool has_mesh = !assets.superposition && !assets.media.empty() && assets.media.front().bvh;
    const std::vector<shared::BvhNode> none;
    const std::vector<shared::BvhNode>& before = has_mesh ? assets.media.front().bvh->nodes : none;
    frame_.first_surface_node = static_cast<std::uint32_t>(before.size());
    frame_.surface_nodes = static_cast<std::uint32_t>(surfaces_.nodes.size());
    frame_.planes = surfaces_.planes;
    text_ += fmt::format(", {} surfaces of {} pieces", surfaces_.rows.size(), surfaces_.primitives.size());
    buffers_.upload_surfaces(device_, commands_, surfaces_, before);
    if (ray_queries && !surfaces_.nodes.empty()) { // else there is nothing that they would search
        boxes_.emplace(device_, commands_, piece_boxes(surfaces_, static_cast<float>(reach_of_rays(scene, assets))));
        form_ |= form_ray_query;
        text_ += ", by ray queries";
    }
    if (!surfaces_.texels.empty())
        buffers_.upload_textures(device_, commands_, surfaces_.texels, assets.sky ? &*assets.sky : nullptr);
}

// World units from the origin, of a sensor's rectangle too; infinite where a medium is everywhere, or a plane.
double DeviceScene::reach_of_all(const Scene& scene, const Assets& assets) const {
    if (any_medium(scene, is_everywhere))
        return std::numeric_limits<double>::infinity();
    double reach = std::max(lit_radius(scene, assets, frame_.media[0]), reach_of_surfaces(scene.surfaces, origin_));
    if (scene.camera.projection == Projection::irradiance) {
        const SensorBox box = sensor_box(scene.camera, scene.picture);
        const CameraRays rays = camera_rays(scene.camera, scene.picture);
        const double beyond = std::max(scene.settings.pixel_filter_radius - 0.5, 0.0); // pixels that filters reach
        reach = std::max(reach, reach_of({box.low, box.high}, origin_) +
                                    beyond * (glm::length(rays.right) + glm::length(rays.down)));
    }
    return reach;
}

void DeviceScene::make_emitters(const Scene& scene, const Method& method, const Assets& assets) {
    const std::span<const shared::MediumParams> rows = media_.empty() ? std::span(frame_.media, 1) : media();
    const EmitterTable table =
        make_emitter_table(scene, assets.media, method, lights_, surfaces_, glow_of(scene, assets.media, rows),
                           assets.sky ? &*assets.sky : nullptr, frame_.period, reach_of_all(scene, assets), origin_,
                           double(frame_.crop_width) * frame_.crop_height);
    frame_.particles = table.params;
    text_ += method.paths == PATHS_LIGHT ? ", by particles" : ", and by particles";
    buffers_.upload_emitters(device_, commands_, table.rows);
}

void DeviceScene::set_queues(std::uint32_t slots, std::uint32_t queue_capacity) {
    frame_.slots = slots;
    frame_.queue_capacity = queue_capacity;
}

void DeviceScene::make_light_cache() {
    if (specialization_[SPEC_NEE] != NEE_CACHED || specialization_[SPEC_SHAPE] == SHAPE_NONE)
        return;
    buffers_.set_frame(commands_, frame_);
    light_cache_.emplace(device_, buffers_.bound(), frame_.lattice, cache_directions_,
                         specialization_[SPEC_TEXELS] != 0);
}

void DeviceScene::compile_light_cache(const PipelineCache* cache) {
    if (light_cache_)
        light_cache_->compile(specialization_, form_, cache);
}

void DeviceScene::fill_light_cache() {
    if (light_cache_)
        light_cache_->fill(commands_);
}

void DeviceScene::set_rows(std::uint32_t first, std::uint32_t count) {
    frame_.crop_y = first;
    frame_.crop_height = count;
    buffers_.set_frame(commands_, frame_);
}

BoundBuffers DeviceScene::bound() const {
    BoundBuffers bound = buffers_.bound();
    if (light_cache_) {
        bound[BINDING_LATTICE] = &light_cache_->buffer();
        if (specialization_[SPEC_TEXELS] != 0)
            bound[BINDING_LATTICE_TEXELS] = &light_cache_->buffer();
    }
    return bound;
}

std::uint64_t DeviceScene::bytes() const {
    return buffers_.bytes() + (light_cache_ ? light_cache_->buffer().bytes() : 0) + (boxes_ ? boxes_->bytes() : 0);
}

} // namespace vkvol
