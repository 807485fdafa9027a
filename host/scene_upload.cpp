#include "scene_upload.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "error.h"

namespace vkvol {

static_assert(std::is_standard_layout_v<shared::FrameParams>);
static_assert(sizeof(shared::CameraParams) == 4 * 12);
static_assert(sizeof(shared::VolumeParams) == 3 * 16 + 7 * 12 + 4 * 4 + 12);
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

void fill_grid(shared::VolumeParams& params, const LoadedVolume& loaded) {
    const DensityField& field = *loaded.field;
    const MajorantGrid& majorants = *loaded.majorants;
    params.voxel_min = field.voxel_min;
    params.voxel_max = field.voxel_max;
    params.leaf_min = field.leaf_min;
    params.leaf_dims = field.leaf_dims;
    params.cell_dims = majorants.dims;
    params.cell_size = static_cast<float>(majorants.cell);
}

// `origin`: of render space, in world coordinates. The map render -> medium is composed in double precision.
shared::VolumeParams make_volume(const Volume& volume, const LoadedVolume& loaded, glm::dvec3 origin) {
    shared::VolumeParams params{};
    const glm::dmat4 to_medium =
        glm::inverse(medium_to_world(volume, loaded)) * glm::translate(glm::dmat4(1.0), origin);
    for (int row = 0; row < 3; ++row)
        params.to_medium[row] = glm::vec4(to_medium[0][row], to_medium[1][row], to_medium[2][row], to_medium[3][row]);
    const Bounds bounds = medium_bounds(loaded);
    params.bounds_min = bounds.low;
    params.bounds_max = bounds.high;
    if (loaded.field)
        fill_grid(params, loaded);
    const double albedo = volume.sigma_s > 0.0 ? volume.sigma_s / (volume.sigma_a + volume.sigma_s) : 0.0;
    params.sigma_t = static_cast<float>(world_sigma_t(volume, loaded.field ? &*loaded.field : nullptr));
    params.albedo = static_cast<float>(albedo);
    params.g = static_cast<float>(volume.g);
    params.emission = glm::vec3((1.0 - albedo) * volume.Le);
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
    constants[SPEC_EMISSION] =
        medium != MEDIUM_NONE && scene.volumes.front().sigma_a > 0.0 && scene.volumes.front().Le != Rgb(0.0);
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
