#include "scene_upload.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "blackbody.h"
#include "error.h"

namespace vkvol {

static_assert(std::is_standard_layout_v<shared::FrameParams>);
static_assert(sizeof(shared::CameraParams) == 4 * 12);
static_assert(sizeof(shared::GridParams) == 4 * 12 + 2 * 4);
static_assert(sizeof(shared::EmissionParams) == 2 * 12 + sizeof(shared::GridParams) + 3 * 16 + 5 * 4);
static_assert(sizeof(shared::VolumeParams) ==
              3 * 16 + 2 * 12 + sizeof(shared::GridParams) + 12 + 4 * 4 + sizeof(shared::EmissionParams));
static_assert(sizeof(shared::PassPush) <= 128, "the least push constant space that Vulkan promises");

namespace {

const Volume* find_volume(const Scene& scene) {
    if (scene.volumes.size() > 1)
        throw InputError("a scene with several volumes is not rendered by this version; keep one");
    return scene.volumes.empty() ? nullptr : &scene.volumes.front();
}

bool scatters_or_absorbs(const Volume& volume) {
    return (volume.sigma_a + volume.sigma_s) * volume.density_scale > 0.0;
}

int medium_kind(const Scene& scene, const LoadedVolume& loaded) {
    const Volume* volume = find_volume(scene);
    if (!volume || !scatters_or_absorbs(*volume))
        return MEDIUM_NONE;
    if (std::holds_alternative<Sphere>(volume->shape))
        return MEDIUM_SPHERE;
    if (std::holds_alternative<Box>(volume->shape))
        return MEDIUM_BOX;
    return loaded.field ? MEDIUM_GRID : MEDIUM_NONE;
}

// Extinction at density 1 [1 / world unit].
double world_sigma_t(const Volume& volume, const DensityField* field) {
    const double sigma_t = (volume.sigma_a + volume.sigma_s) * volume.density_scale;
    return field && volume.unit == CoefficientUnit::voxel ? sigma_t / field->voxel_size() : sigma_t;
}

// Medium space -> world: a ball, a cube, or the grid's own index space.
glm::dmat4 medium_to_world(const Volume& volume, const LoadedVolume& loaded) {
    const auto placed = [](glm::dvec3 center, glm::dvec3 half) {
        return glm::scale(glm::translate(glm::dmat4(1.0), center), half);
    };
    if (const auto* sphere = std::get_if<Sphere>(&volume.shape))
        return placed(sphere->center, glm::dvec3(sphere->radius));
    if (const auto* box = std::get_if<Box>(&volume.shape))
        return placed(box->center, box->size / 2.0);
    return loaded.field ? loaded.field->index_to_world : glm::dmat4(1.0);
}

struct Bounds {
    glm::dvec3 low{-1.0}, high{1.0};
};

// Medium space, where the density can differ from 0: one voxel around the active ones, for interpolation.
Bounds medium_bounds(const LoadedVolume& loaded) {
    if (!loaded.field)
        return {};
    return {glm::dvec3(loaded.field->voxel_min) - 1.0, glm::dvec3(loaded.field->voxel_max) + 1.0};
}

// `before`: the grid that lies ahead of this one in the buffers, if any.
shared::GridParams make_grid(const DensityField& field, const DensityField* before) {
    shared::GridParams params{};
    params.voxel_min = field.voxel_min;
    params.voxel_max = field.voxel_max;
    params.leaf_min = field.leaf_min;
    params.leaf_dims = field.leaf_dims;
    params.first_word = before ? static_cast<std::uint32_t>(before->bytes.size() / 4) : 0;
    params.first_entry = before ? static_cast<std::uint32_t>(before->leaf_table.size()) : 0;
    return params;
}

// Rows of the affine map from render space, whose origin is at `origin` in the world. Composed in double precision.
void fill_rows(glm::vec4 (&rows)[3], const glm::dmat4& space_to_world, glm::dvec3 origin) {
    const glm::dmat4 map = glm::inverse(space_to_world) * glm::translate(glm::dmat4(1.0), origin);
    for (int row = 0; row < 3; ++row)
        rows[row] = glm::vec4(map[0][row], map[1][row], map[2][row], map[3][row]);
}

shared::EmissionParams make_emission(const Volume& volume, const LoadedVolume& loaded, double albedo,
                                     glm::dvec3 origin) {
    shared::EmissionParams params{};
    params.constant = (1.0 - albedo) * volume.Le;
    if (!loaded.temperature)
        return params;
    const TemperatureEmission& emission = volume.temperature;
    params.color = (1.0 - albedo) * emission.color;
    params.grid = make_grid(*loaded.temperature, &*loaded.field);
    fill_rows(params.to_index, loaded.temperature->index_to_world, origin);
    params.kelvin_scale = static_cast<float>(emission.scale);
    params.kelvin_offset = static_cast<float>(emission.offset);
    params.kelvin_cutoff = static_cast<float>(emission.cutoff);
    params.table_low = 0.0f;
    params.table_high = static_cast<float>(loaded.hottest);
    return params;
}

// `origin`: of render space, in world coordinates.
shared::VolumeParams make_volume(const Volume& volume, const LoadedVolume& loaded, glm::dvec3 origin) {
    shared::VolumeParams params{};
    fill_rows(params.to_medium, medium_to_world(volume, loaded), origin);
    const Bounds bounds = medium_bounds(loaded);
    params.bounds_min = bounds.low;
    params.bounds_max = bounds.high;
    if (loaded.field) {
        params.density = make_grid(*loaded.field, nullptr);
        params.cell_dims = loaded.majorants->dims;
        params.cell_size = static_cast<float>(loaded.majorants->cell);
    }
    const double albedo = volume.sigma_s > 0.0 ? volume.sigma_s / (volume.sigma_a + volume.sigma_s) : 0.0;
    params.sigma_t = static_cast<float>(world_sigma_t(volume, loaded.field ? &*loaded.field : nullptr));
    params.albedo = static_cast<float>(albedo);
    params.g = static_cast<float>(volume.g);
    params.emission = make_emission(volume, loaded, albedo, origin);
    return params;
}

// The angles' rotation Rz(roll) * Ry(yaw) * Rx(pitch).
glm::dmat3 camera_rotation(const Camera& camera) {
    glm::dmat4 m(1.0);
    m = glm::rotate(m, glm::radians(camera.roll), glm::dvec3(0, 0, 1));
    m = glm::rotate(m, glm::radians(camera.yaw), glm::dvec3(0, 1, 0));
    m = glm::rotate(m, glm::radians(camera.pitch), glm::dvec3(1, 0, 0));
    return glm::dmat3(m);
}

shared::CameraParams make_camera(const Scene& scene, glm::dvec3 origin) {
    const Picture& picture = scene.picture;
    const double s = std::tan(glm::radians(scene.camera.fov) / 2.0);
    const double aspect = picture.reference_width / picture.reference_height;
    const double dx = 2.0 * aspect * s / picture.reference_width;
    const double dy = -2.0 * s / picture.reference_height;
    const glm::dmat3 rotation = camera_rotation(scene.camera);
    const glm::dvec3 corner(-aspect * s + picture.start_x * dx, s + picture.start_y * dy, -1.0);
    shared::CameraParams params{};
    params.position = scene.camera.position - origin;
    params.corner = rotation * corner;
    params.right = rotation * glm::dvec3(dx, 0.0, 0.0);
    params.down = rotation * glm::dvec3(0.0, dy, 0.0);
    return params;
}

} // namespace

namespace {

// A file without that grid, or one that holds no heat, does not glow: a warning, no error.
void load_temperature(const Volume& volume, const GridFile& file, LoadedVolume& loaded) {
    const TemperatureEmission& emission = volume.temperature;
    if (emission.color == Rgb(0.0) || volume.sigma_a == 0.0)
        return;
    if (!has_grid({file.path, emission.grid})) {
        loaded.warnings.push_back(
            fmt::format("{}: has no grid \"{}\": <emission> is without effect", file.path.string(), emission.grid));
        return;
    }
    DensityField field = load_density_field({file.path, emission.grid});
    if (field.active_voxels == 0)
        return;
    if (emission.model == TemperatureEmission::Model::blackbody) {
        loaded.hottest = std::max(emission.scale * field.max_value(), 0.0) + std::max(emission.offset, 0.0);
        if (loaded.hottest < 500.0 || loaded.hottest > 40000.0)
            loaded.warnings.push_back(fmt::format("{}: \"{}\" reaches {:.0f} kelvin by temperatureScale and "
                                                  "temperatureOffset; flames have 1000 to 3000",
                                                  file.path.string(), emission.grid, loaded.hottest));
        loaded.hottest = std::max(loaded.hottest, 1.0);
        loaded.blackbody = make_blackbody_table(0.0, loaded.hottest, emission.reference, BLACKBODY_ENTRIES);
    }
    loaded.temperature = std::move(field);
}

int emission_kind(const Volume& volume, const LoadedVolume& loaded) {
    if (volume.sigma_a == 0.0)
        return EMISSION_NONE;
    if (loaded.temperature)
        return volume.temperature.model == TemperatureEmission::Model::color ? EMISSION_COLOR : EMISSION_BLACKBODY;
    return volume.Le != Rgb(0.0) ? EMISSION_CONSTANT : EMISSION_NONE;
}

} // namespace

LoadedVolume load_volume(const Scene& scene) {
    LoadedVolume loaded;
    const Volume* volume = find_volume(scene);
    const GridFile* file = volume ? std::get_if<GridFile>(&volume->shape) : nullptr;
    if (!file)
        return loaded;
    DensityField field = load_density_field(*file);
    if (field.active_voxels == 0)
        return loaded;
    const double voxel_sigma_t = world_sigma_t(*volume, &field) * field.voxel_size() * scene.settings.majorant_scale;
    loaded.majorants = make_majorant_grid(field, scene.settings.majorant_cell, voxel_sigma_t);
    for (float& bound : loaded.majorants->bounds)
        bound *= static_cast<float>(scene.settings.majorant_scale);
    loaded.field = std::move(field);
    load_temperature(*volume, *file, loaded);
    return loaded;
}

Specialization specialize(const Scene& scene, const LoadedVolume& loaded, const Integrator& integrator) {
    if (scene.lights.size() > 1)
        throw InputError("a scene with several lights is not rendered by this version; keep one");
    Specialization constants{};
    const int medium = medium_kind(scene, loaded);
    const bool homogeneous = medium == MEDIUM_SPHERE || medium == MEDIUM_BOX;
    constants[SPEC_MEDIUM] = medium;
    constants[SPEC_GRID_TYPE] = loaded.field ? loaded.field->type : GRID_FLOAT;
    constants[SPEC_FILTER] = scene.settings.filter == Filter::nearest     ? FILTER_NEAREST
                             : scene.settings.filter == Filter::trilinear ? FILTER_TRILINEAR
                                                                          : FILTER_STOCHASTIC;
    const bool scattering = medium != MEDIUM_NONE && scene.volumes.front().sigma_s > 0.0;
    constants[SPEC_NEE] = scene.lights.empty() || !scattering ? NEE_NONE : integrator.nee;
    constants[SPEC_EMISSION] = medium != MEDIUM_NONE ? emission_kind(scene.volumes.front(), loaded) : EMISSION_NONE;
    constants[SPEC_TEMPERATURE_TYPE] = loaded.temperature ? loaded.temperature->type : GRID_FLOAT;
    constants[SPEC_FREE_FLIGHT] = homogeneous ? FREE_FLIGHT_ANALYTIC : integrator.free_flight;
    constants[SPEC_TRANSMITTANCE] = homogeneous ? TRANSMITTANCE_ANALYTIC : integrator.transmittance;
    constants[SPEC_STEPS] = 1;
    return constants;
}

shared::FrameParams make_frame(const Scene& scene, const LoadedVolume& loaded, Crop crop, std::uint32_t seed) {
    shared::FrameParams frame{};
    glm::dvec3 origin = scene.camera.position;
    if (const Volume* volume = find_volume(scene)) {
        const Bounds bounds = medium_bounds(loaded);
        origin = glm::dvec3(medium_to_world(*volume, loaded) * glm::dvec4((bounds.low + bounds.high) / 2.0, 1.0));
        frame.volume = make_volume(*volume, loaded, origin);
    }
    frame.camera = make_camera(scene, origin);
    if (!scene.lights.empty())
        frame.light = {scene.lights.front().direction, scene.lights.front().irradiance};
    frame.background = scene.background;
    frame.roulette_threshold = static_cast<float>(scene.settings.roulette_threshold);
    // Beyond a million scatterings a path of any albedo that scenes have is worth nothing; the bound is counted.
    frame.max_depth = scene.settings.max_depth.value_or(1'000'000);
    frame.seed = seed;
    frame.crop_x = static_cast<std::uint32_t>(crop.x0);
    frame.crop_y = static_cast<std::uint32_t>(crop.y0);
    frame.crop_width = static_cast<std::uint32_t>(crop.x1 - crop.x0);
    return frame;
}

} // namespace vkvol
