#include "frame_params.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "camera_rays.h"
#include "camera_view.h"
#include "error.h"
#include "kernel_constants.h"
#include "layer_plan.h"
#include "layers.h"
#include "light_cache.h"
#include "light_table.h"
#include "medium_pieces.h"
#include "noise.h"
#include "period.h"
#include "phase_params.h"
#include "pixel_filter.h"
#include "placement.h"
#include "render_limits.h"
#include "scene_facts.h"
#include "sensor_params.h"
#include "shared/estimators.h"
#include "shared/items.h"
#include "surface_mesh.h"
#include "surface_table.h"
#include "upload_layout.h"

namespace vkvol {

static_assert(std::is_standard_layout_v<shared::FrameParams>);
static_assert(sizeof(shared::SensorParams) == 7 * 12 + 4 * 4 + 2 * 8 + 4 + 12);
static_assert(sizeof(shared::GridParams) == 4 * 12 + 2 * 4);
static_assert(sizeof(shared::AlbedoParams) == sizeof(shared::GridParams) + 3 * 16);
static_assert(sizeof(shared::EmissionParams) == 2 * 12 + sizeof(shared::GridParams) + 3 * 16 + 6 * 4);
static_assert(sizeof(shared::LayerParams) == 12 + 3 * 4);
static_assert(sizeof(shared::MediumParams) == 3 * 16 + 4 * 12 + sizeof(shared::GridParams) + 12 + 7 * 4 + 3 * 12 +
                                                  sizeof(shared::PhaseParams) + sizeof(shared::AlbedoParams) +
                                                  sizeof(shared::EmissionParams) + sizeof(shared::NoiseParams) +
                                                  sizeof(shared::LayerParams) + 12 + sizeof(shared::MediumKinds));
static_assert(sizeof(shared::LatticeParams) == 3 * 12);
static_assert(sizeof(shared::PassPush) <= 128, "the least push constant space that Vulkan promises");

namespace {

shared::GridParams make_grid(const DensityField& field, const UploadLayout& layout) {
    const glm::ivec3 base = index_base(field);
    const UploadLayout::GridPlace place = layout.place_of(field);
    shared::GridParams params{};
    params.voxel_min = field.voxel_min - base;
    params.voxel_max = field.voxel_max - base;
    params.leaf_min = field.leaf_min - (base >> 3);
    params.leaf_dims = field.leaf_dims;
    params.first_word = place.first_word;
    params.first_entry = place.first_entry;
    return params;
}

// Rows of the affine map from render space, whose origin is at `origin` in the world. Composed in double precision.
void fill_rows(glm::vec4 (&rows)[3], const glm::dmat4& from_world, glm::dvec3 origin) {
    const glm::dmat4 map = from_world * glm::translate(glm::dmat4(1.0), origin);
    for (int row = 0; row < 3; ++row)
        rows[row] = glm::vec4(map[0][row], map[1][row], map[2][row], map[3][row]);
}

shared::EmissionParams make_emission(const Volume& volume, const LoadedMedium& loaded, const UploadLayout& layout,
                                     const Method& method, glm::dvec3 origin) {
    const Rgb absorbed = loaded.albedo || volume.map.is_transfer ? Rgb(1.0) : 1.0 - albedo_of(volume);
    shared::EmissionParams params{};
    params.constant = absorbed * constant_emission(volume, loaded, method);
    if (!loaded.temperature)
        return params;
    const TemperatureEmission& emission = volume.temperature;
    params.color = absorbed * emission.color;
    params.grid = make_grid(*loaded.temperature, layout);
    fill_rows(params.to_index, glm::inverse(index_to_world(*loaded.temperature)), origin);
    params.kelvin_scale = static_cast<float>(emission.scale);
    params.kelvin_offset = static_cast<float>(emission.offset);
    params.kelvin_cutoff = static_cast<float>(emission.cutoff);
    params.table_low = 0.0f;
    params.table_high = static_cast<float>(loaded.hottest);
    params.first_entry = layout.first_color(loaded);
    return params;
}

// The density where there are no majorant cells: bounds of it, and a control density with what differs from it. Of
// noise half the bound where it may be, by the bound of a weight's mean square in make_controls(); else a lower bound,
// which decomposition needs, too. `across`: the most optical depth at density 1.
void fill_density(const Volume& volume, double majorant_scale, bool decomposes, double across,
                  shared::MediumParams& params) {
    const double bound = volume.noise ? noise_bound(*volume.noise) : 1.0;
    const bool thin = across * 0.5 * bound < 1.0;
    const double control = volume.noise ? (thin && !decomposes ? 0.5 * bound : 0.0) : 1.0;
    params.majorant = static_cast<float>(bound * majorant_scale);
    params.control = static_cast<float>(control);
    params.residual = static_cast<float>(volume.noise ? majorant_scale * std::max(bound - control, control)
                                                      : std::max(0.0, majorant_scale - control));
}

// Within the medium's bounds, to the factor of two that weighting techniques asks for: of the bounds in its cells half,
// as densities between 0 and a bound go.
double usual_density(const Volume& volume, const LoadedMedium& loaded) {
    if (volume.noise)
        return 0.5;
    if (!loaded.majorants)
        return 1.0;
    if (loaded.is_layered) // most of which has next to nothing
        return 0.5 * loaded.majorants->most;
    return 0.5 * loaded.majorants->mean;
}

shared::LayerParams make_layers(const Volume& volume, const MajorantGrid& cells) {
    const Layers& layers = *volume.layers;
    const LayerBox box = layer_box(volume);
    shared::LayerParams params{};
    params.up[layers.axis] = static_cast<float>(box.size[layers.axis] / cells.dims[layers.axis]);
    if (layers.scale_height > 0.0) {
        params.bottom = static_cast<float>(layer_density(volume, box.low[layers.axis]));
        params.decay = static_cast<float>(1.0 / layers.scale_height);
    } else {
        params.above = static_cast<float>(box.low[layers.axis] - layers.bottom);
    }
    return params;
}

// `origin`: of render space, in world coordinates. `is_chromatic`: extinction is, of any of the scene's media.
shared::MediumParams make_medium(const Scene& scene, const Volume& volume, const LoadedMedium& loaded,
                                 const UploadLayout& layout, const Method& method, glm::dvec3 origin,
                                 bool is_chromatic) {
    shared::MediumParams params{};
    fill_rows(params.to_medium, world_to_medium(volume, loaded), origin);
    const UnmovedShape shape = unmoved_shape(volume, loaded);
    params.extent = shape.half;
    const MediumBounds bounds = medium_bounds(loaded);
    params.bounds_min = bounds.low;
    params.bounds_max = bounds.high;
    if (loaded.field) {
        params.density = make_grid(*loaded.field, layout);
        params.cell_dims = loaded.majorants->dims;
        params.cell_size = static_cast<float>(loaded.majorants->cell);
    }
    params.cells_min = params.bounds_min;
    if (loaded.is_layered) {
        params.cell_dims = loaded.majorants->dims;
        params.cell_size = 1.0f;
        params.layers = make_layers(volume, *loaded.majorants);
    }
    const Rgb sigma_t = world_sigma_t(volume, loaded.field ? &*loaded.field : nullptr);
    fill_density(volume, scene.settings.majorant_scale, method.flights_have(TRAIT_CONTROL),
                 volume.noise ? largest(sigma_t) * diagonal_of(volume, loaded) : 0.0, params);
    if (volume.noise)
        params.noise = make_noise(*volume.noise, shape.center);
    params.bvh_nodes = loaded.bvh ? static_cast<std::uint32_t>(loaded.bvh->nodes.size()) : 0;
    params.sigma_t = static_cast<float>(largest(sigma_t));
    params.sigma_ratio = is_chromatic && largest(sigma_t) > 0.0 ? sigma_t / largest(sigma_t) : Rgb(1.0);
    params.usual_sigma_t = static_cast<float>(std::max(largest(sigma_t) * usual_density(volume, loaded), 1e-30));
    params.albedo = albedo_of(volume);
    params.absorbed = 1.0 - albedo_of(volume);
    if (loaded.albedo) {
        params.albedo_grid.grid = make_grid(*loaded.albedo, layout);
        fill_rows(params.albedo_grid.to_index, glm::inverse(index_to_world(*loaded.albedo)), origin);
    }
    params.phase = phase_params(volume, loaded.phase_nodes);
    params.phase.first_node = layout.first_node(loaded);
    params.first_knot = layout.first_knot(loaded);
    params.emission = make_emission(volume, loaded, layout, method, origin);
    params.kinds = kinds_of(volume, loaded, method);
    return params;
}

// Extinction of the channels to that of each medium's largest, of all media together: what the cache of light has for
// every place. By how much of each there is, roughly.
Rgb ratio_of_all(const Scene& scene, Media media, const Superposition& whole) {
    Rgb sum(0.0);
    double most = 0.0;
    for (std::size_t i = 0; i < scene.volumes.size(); ++i) {
        const Volume& volume = scene.volumes[i];
        if (!has_matter(volume, media[i]))
            continue;
        const double edge = std::min(diagonal_of(volume, media[i]), whole.diagonal());
        const Rgb sigma_t = world_sigma_t(volume, media[i].field ? &*media[i].field : nullptr) *
                            (usual_density(volume, media[i]) * edge * edge * edge);
        sum += sigma_t;
        most += largest(sigma_t);
    }
    return most > 0.0 ? sum / most : Rgb(1.0);
}

// The superposition as one medium. Collisions ask its parts for what is theirs.
shared::MediumParams make_whole(const Scene& scene, Media media, const Superposition& whole) {
    shared::MediumParams params{};
    fill_rows(params.to_medium,
              glm::inverse(glm::scale(glm::translate(glm::dmat4(1.0), whole.origin), glm::dvec3(whole.edge))),
              whole.origin);
    params.cells_min = params.bounds_min = whole.low();
    params.bounds_max = whole.high();
    if (whole.unbounded) {
        params.bounds_min = glm::vec3(static_cast<float>(-everywhere_reach / whole.edge));
        params.bounds_max = -params.bounds_min;
    }
    params.extent = glm::vec3(static_cast<float>(whole.edge));
    params.cell_dims = whole.dims();
    params.cell_size = 1.0f;
    params.sigma_t = 1.0f;
    params.usual_sigma_t = static_cast<float>(std::max(0.5 * whole.mean_bound(), 1e-30));
    params.sigma_ratio = ratio_of_all(scene, media, whole);
    params.noise = make_noise(Noise{}, whole.origin); // its permutation is the same everywhere
    return params;
}

} // namespace

double longest_diagonal(const Scene& scene, Media media, const Superposition* whole) {
    if (whole)
        return whole->unbounded ? everywhere_reach : whole->diagonal();
    double longest = 0.0;
    for (std::size_t i = 0; i < scene.volumes.size(); ++i)
        longest = std::max(longest, diagonal_of(scene.volumes[i], media[i]));
    return longest;
}

double lit_radius(const Scene& scene, const Assets& assets, const shared::MediumParams& medium) {
    if (any_medium(scene, is_everywhere))
        return 1.0 / std::max(double(medium.usual_sigma_t), 1e-12);
    return 0.5 * longest_diagonal(scene, assets.media, whole_of(assets));
}

namespace {

// What a march goes through is a product of factors near 1 in single precision, all rounded alike: over 2 10^5 steps an
// optical depth of 1 errs by 0.1 % and one of 0.03 by 21 %, over 10^5 by 0.1 and 0.9 %, over 10^4 by 0.02 and 0.5 %.
// The diagonal is the longest way; few rays of a wide slab go it, so that is not refused before.
void check_step(const char* name, double step, double diagonal, double unit) {
    constexpr double most_steps = 2e5;
    if (diagonal / step > most_steps)
        throw InputError(
            fmt::format("<march> {}: {} takes more than two hundred thousand steps across the medium; {:.3g} takes a "
                        "thousand",
                        name, step / unit, diagonal / unit / 1000.0));
}

// World units: of the finest of the scene's grids; 0 without one.
double least_voxel(Media media) {
    double least = 0.0;
    for (const LoadedMedium& medium : media)
        if (medium.field && (least == 0.0 || medium.field->voxel_size() < least))
            least = medium.field->voxel_size();
    return least;
}

shared::MarchParams make_march(const Scene& scene, Media media, const Method& method, double diagonal) {
    const March& march = scene.settings.march;
    const double voxel = least_voxel(media);
    const double unit = march.unit == CoefficientUnit::voxel && voxel > 0.0 ? voxel : 1.0;
    const double step = march.step > 0.0 ? march.step * unit : voxel > 0.0 ? 0.5 * voxel : 0.2;
    // A series that ends unbiased does best from a coarse beginning.
    const bool unbiased = method.shadow_rays_have(TRAIT_MARCH) && !method.shadow_rays_have(TRAIT_INEXACT);
    const double usual_shadow_step = unbiased ? 16.0 * step : step;
    const double shadow_step = march.shadow_step > 0.0 ? march.shadow_step * unit : usual_shadow_step;
    if (method.flights_have(TRAIT_EQUAL_STEPS))
        check_step("step", step, diagonal, unit);
    if (method.shadow_rays_have(TRAIT_MARCH))
        check_step("shadowStep", shadow_step, diagonal, unit);
    shared::MarchParams params{};
    params.step = static_cast<float>(step);
    params.shadow_step = static_cast<float>(shadow_step);
    params.optical_step = static_cast<float>(march.optical_step);
    params.jitter = method.jitter ? 1.0f : 0.0f;
    return params;
}

shared::LatticeParams make_lattice_of(const Volume& volume, const LoadedMedium& loaded, int most_nodes) {
    const MediumBounds bounds = medium_bounds(loaded);
    const glm::dmat3 to_world(medium_to_world(volume, loaded));
    glm::dvec3 edges;
    for (int axis = 0; axis < 3; ++axis)
        edges[axis] = glm::length(to_world[axis]) * (bounds.high[axis] - bounds.low[axis]);
    const glm::ivec3 voxels = loaded.field ? loaded.field->voxel_max - loaded.field->voxel_min + 1 : glm::ivec3(0);
    return make_lattice(bounds.low, bounds.high, edges, voxels, most_nodes);
}

} // namespace

glm::dvec3 render_origin(const Scene& scene, Media media, const Superposition* whole) {
    if (whole && !whole->cells.bounds.empty())
        return whole->origin;
    if (any_medium(scene, is_everywhere))
        return scene.camera.position;
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < scene.volumes.size(); ++i)
        sum += middle_of(scene.volumes[i], media[i]);
    if (!scene.volumes.empty())
        return sum / static_cast<double>(scene.volumes.size());
    const std::optional<SurfaceBounds> bounds = bounds_of(scene.surfaces);
    return bounds ? 0.5 * (bounds->low + bounds->high) : scene.camera.position;
}

std::vector<shared::MediumParams> make_media(const Scene& scene, Media media, const Method& method, glm::dvec3 origin) {
    const UploadLayout layout(media);
    std::vector<shared::MediumParams> rows;
    rows.reserve(media.size());
    const std::vector<std::string> layers = media_layers(scene);
    const bool is_chromatic = has_chromatic_extinction(scene);
    for (std::size_t i = 0; i < scene.volumes.size(); ++i) {
        rows.push_back(make_medium(scene, scene.volumes[i], media[i], layout, method, origin, is_chromatic));
        rows.back().layer = media_layer(layers, scene, i);
    }
    return rows;
}

shared::FrameParams make_frame(const Scene& scene, Media media, const Method& method, Crop crop, std::uint32_t seed,
                               const Superposition* whole) {
    shared::FrameParams frame{};
    const glm::dvec3 origin = render_origin(scene, media, whole);
    check_sensor_in_planes(scene, origin);
    const double diagonal = longest_diagonal(scene, media, whole);
    const int nodes = cache_layout(scene).most_nodes;
    if (whole) {
        frame.media[0] = make_whole(scene, media, *whole);
        if (method.nee == NEE_CACHED && !whole->cells.bounds.empty())
            frame.lattice = make_lattice(whole->low(), whole->high(), whole->edge * glm::dvec3(whole->dims()),
                                         whole->dims(), nodes);
    } else if (const Volume* lone = lone_volume(scene)) {
        frame.media[0] =
            make_medium(scene, *lone, media[0], UploadLayout(media), method, origin, has_chromatic_extinction(scene));
        if (method.nee == NEE_CACHED)
            frame.lattice = make_lattice_of(*lone, media[0], nodes);
    }
    frame.sensors[0] = sensor_params(scene, origin, std::max(0.5 * diagonal, reach_of_lamps(scene.lights, origin)));
    const LayerPlan layers = plan_layers(scene);
    frame.layers = layers.params;
    frame.lights[FRAME_BACKGROUND].radiance = scene.background;
    frame.lights[FRAME_BACKGROUND].group = group_layer(layers.groups, scene.background_group);
    if (const DirectionalLight* sun = lone_directional(scene))
        frame.lights[FRAME_DIRECTIONAL] = {sun->direction, sun->irradiance, group_layer(layers.groups, sun->group)};
    const std::vector<double> quantiles = filter_quantiles(scene.settings, FILTER_QUANTILES);
    std::copy(quantiles.begin(), quantiles.end(), frame.filter_quantiles);
    frame.march = make_march(scene, media, method, diagonal);
    frame.period = make_period(scene, media, origin);
    frame.roulette_threshold = static_cast<float>(scene.settings.roulette_threshold);
    // Beyond a million scatterings a path of any albedo that scenes have is worth nothing; the bound is counted.
    frame.max_depth = scene.settings.max_depth.value_or(1'000'000);
    frame.seed = seed;
    frame.crop_x = static_cast<std::uint32_t>(crop.x0);
    frame.crop_y = static_cast<std::uint32_t>(crop.y0);
    frame.crop_width = static_cast<std::uint32_t>(crop.x1 - crop.x0);
    frame.crop_height = static_cast<std::uint32_t>(crop.y1 - crop.y0);
    return frame;
}

} // namespace vkvol
