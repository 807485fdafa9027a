#include "loaded_medium.h"

#include <algorithm>
#include <fmt/format.h>

#include "blackbody.h"
#include "error.h"
#include "phase_params.h"
#include "phase_table.h"
#include "pilot_paths.h"
#include "render_limits.h"
#include "shared/estimators.h"
#include "supported.h"

namespace vkvol {

Rgb world_sigma_t(const Volume& volume, const DensityField* field) {
    const Rgb sigma_t = (volume.sigma_a + volume.sigma_s) * volume.density_scale;
    return field && volume.unit == CoefficientUnit::voxel ? sigma_t / field->voxel_size() : sigma_t;
}

std::vector<const DensityField*> grids_of(const LoadedMedium& medium) {
    std::vector<const DensityField*> grids;
    for (const auto* grid : {&medium.field, &medium.temperature, &medium.albedo})
        if (*grid)
            grids.push_back(&**grid);
    return grids;
}

double largest(const Rgb& color) {
    return std::max({color.x, color.y, color.z});
}

glm::dvec3 lowest_corner(const Mesh& mesh) {
    glm::dvec3 low = mesh.vertices.front();
    for (const glm::dvec3& vertex : mesh.vertices)
        low = glm::min(low, vertex);
    return low;
}

glm::dvec3 box_center(const Mesh& mesh) {
    const glm::dvec3 low = lowest_corner(mesh);
    glm::dvec3 high = low;
    for (const glm::dvec3& vertex : mesh.vertices)
        high = glm::max(high, vertex);
    return 0.5 * (low + high);
}

bool leaps(const Method& method) {
    return method.flights_have(TRAIT_CELLS) && !method.shadow_rays_have(TRAIT_VOXELS | TRAIT_CONTROL);
}

namespace {

DensityField load_field(const Volume& volume, const GridFile& file, FieldCache* kept,
                        GridValues values = GridValues::numbers) {
    DensityField field = kept ? kept->take(file, values) : load_density_field(file, values);
    field.place(volume.transform);
    return field;
}

void load_albedo(const Volume& volume, const GridFile& file, FieldCache* kept, LoadedMedium& loaded) {
    if (volume.albedo_grid.empty())
        return;
    DensityField field = load_field(volume, {file.path, volume.albedo_grid}, kept, GridValues::numbers_or_colors);
    if (field.active_voxels == 0)
        throw InputError(
            fmt::format("{}: \"{}\" has no active voxel, and would make the medium black; leave <albedo> out",
                        file.path.string(), volume.albedo_grid));
    if (field.max_value() == 0.0f)
        loaded.warnings.push_back(fmt::format("{}: \"{}\" is 0 everywhere: the medium absorbs all that it meets; name "
                                              "another grid (vkvol info lists them), or leave <albedo> out",
                                              file.path.string(), volume.albedo_grid));
    loaded.albedo = std::move(field);
}

// A file without that grid, or one that holds no heat, does not glow: a warning, no error.
void load_temperature(const Volume& volume, const GridFile& file, FieldCache* kept, LoadedMedium& loaded) {
    const TemperatureEmission& emission = volume.temperature;
    if (emission.color * most_sigma_a(volume) == Rgb(0.0))
        return;
    if (!has_grid({file.path, emission.grid})) {
        loaded.warnings.push_back(
            fmt::format("{}: has no grid \"{}\": <emission> is without effect", file.path.string(), emission.grid));
        return;
    }
    const bool by_kelvin = emission.model == TemperatureEmission::Model::blackbody;
    DensityField field = load_field(volume, {file.path, emission.grid}, kept,
                                    by_kelvin ? GridValues::numbers : GridValues::numbers_or_colors);
    if (field.active_voxels == 0)
        return;
    if (by_kelvin) {
        loaded.hottest = std::max(emission.scale * field.max_value(), 0.0) + std::max(emission.offset, 0.0);
        if (loaded.hottest < 500.0 || loaded.hottest > 40000.0)
            loaded.warnings.push_back(fmt::format("{}: \"{}\" reaches {:.0f} kelvin by temperatureScale and "
                                                  "temperatureOffset; flames have 1000 to 3000",
                                                  file.path.string(), emission.grid, loaded.hottest));
        if (!(loaded.hottest <= hottest_kelvin))
            throw InputError(
                fmt::format("{}: \"{}\" reaches {:.3g} kelvin by temperatureScale and temperatureOffset, but "
                            "{:g} is the most; lower temperatureScale",
                            file.path.string(), emission.grid, loaded.hottest, hottest_kelvin));
        loaded.hottest = std::max(loaded.hottest, 1.0);
        loaded.blackbody = make_blackbody_table(0.0, loaded.hottest, emission.reference, BLACKBODY_ENTRIES);
    }
    loaded.temperature = std::move(field);
}

// A direction in which shadow rays go: any will do.
glm::dvec3 some_light(const std::vector<Light>& lights) {
    for (const Light& light : lights) {
        if (const auto* directional = std::get_if<DirectionalLight>(&light))
            return directional->direction;
        if (const auto* sun = std::get_if<SunLight>(&light))
            return sun->direction;
    }
    return {0.0, 1.0, 0.0};
}

PilotScene pilot_scene(const Scene& scene, const Volume& volume, const Method& method, const DensityField& field,
                       double sigma_t, double g) {
    const glm::dmat4 to_index = glm::inverse(field.index_to_world);
    PilotScene pilot;
    pilot.eye = to_index * glm::dvec4(scene.camera.position, 1.0);
    if (method.nee == NEE_COLLISIONS || method.nee == NEE_TENTATIVE)
        pilot.light = glm::normalize(glm::dvec3(to_index * glm::dvec4(some_light(scene.lights), 0.0)));
    pilot.sigma_t = sigma_t;
    pilot.albedo = largest(volume.sigma_s) / std::max(largest(volume.sigma_a + volume.sigma_s), 1e-300);
    pilot.g = g;
    pilot.leaps = leaps(method);
    return pilot;
}

// The cells' bounds are scaled after the controls are made: these bound the density itself.
void load_grid(const Scene& scene, const Volume& volume, const Method& method, const GridFile& file, FieldCache* kept,
               LoadedMedium& loaded) {
    DensityField field = load_field(volume, file, kept);
    if (field.active_voxels == 0)
        return;
    if (field.background > 0.0f)
        loaded.warnings.push_back(fmt::format("{}: \"{}\" has a background of {:g}: it fills the box of active voxels, "
                                              "and ends where they do",
                                              file.path.string(), file.grid, field.background));
    const double scale = scene.settings.majorant_scale;
    const double voxel_sigma_t = largest(world_sigma_t(volume, &field)) * field.voxel_size();
    loaded.majorants = choose_majorant_grid(
        field,
        pilot_scene(scene, volume, method, field, voxel_sigma_t * scale, mean_cosine(volume, loaded.phase_nodes)),
        scene.settings.majorant_cell);
    const bool decomposes = method.flights_have(TRAIT_CONTROL);
    if (decomposes || method.shadow_rays_have(TRAIT_CONTROL))
        loaded.controls = make_controls(field, *loaded.majorants, decomposes ? 0.0 : voxel_sigma_t);
    for (float& bound : loaded.majorants->bounds)
        bound *= static_cast<float>(scale);
    for (shared::ControlCell& cell : loaded.controls)
        cell.residual *= static_cast<float>(scale);
    loaded.field = std::move(field);
    load_temperature(volume, file, kept, loaded);
    load_albedo(volume, file, kept, loaded);
}

void load_files(const Scene& scene, const Volume& volume, const Method& method, FieldCache* kept,
                LoadedMedium& loaded) {
    if (volume.phase == PhaseFunction::table) {
        PhaseTable table = load_phase_table(volume.phase_details.file);
        loaded.phase_nodes = std::move(table.nodes);
        loaded.warnings = std::move(table.warnings);
    }
    if (const auto* file = std::get_if<GridFile>(&volume.shape))
        load_grid(scene, volume, method, *file, kept, loaded);
    if (const auto* files = std::get_if<MeshFiles>(&volume.shape)) {
        loaded.mesh = load_mesh(*files, volume.transform);
        loaded.bvh = build_bvh(*loaded.mesh, box_center(*loaded.mesh));
        if (method.material_colour)
            loaded.warnings.insert(loaded.warnings.end(), loaded.mesh->warnings.begin(), loaded.mesh->warnings.end());
        if (method.material_colour && !loaded.mesh->diffuse)
            loaded.warnings.push_back(fmt::format("{}: has no material with a diffuse colour; <medium> is what glows",
                                                  files->paths.front().string()));
    }
}

void load_sky(const SkyLight& sky, Assets& assets) {
    try {
        assets.sky = load_sky(sky);
    } catch (const InputError& error) {
        throw InputError(sky.place.empty() ? error.what() : fmt::format("{}: {}", sky.place, error.what()));
    }
    if (assets.sky->mended > 0)
        assets.warnings.push_back(fmt::format("{}: {} texels were negative or not finite, and count as 0",
                                              sky.file.string(), assets.sky->mended));
}

} // namespace

Assets load_assets(const Scene& scene, const Method& method, FieldCache* kept) {
    check_supported(scene);
    Assets assets;
    for (const Volume& volume : scene.volumes) {
        LoadedMedium& loaded = assets.media.emplace_back();
        try {
            load_files(scene, volume, method, kept, loaded);
            check_limits(scene, volume, loaded, method);
        } catch (const InputError& error) { // of the file, say; the scene says who asked for it
            if (volume.place.empty())
                throw;
            throw InputError(fmt::format("{}: {}", volume.place, error.what()));
        }
    }
    if (is_superposition(scene))
        assets.superposition = superpose(scene, assets.media, method);
    for (const Light& light : scene.lights)
        if (const auto* sky = std::get_if<SkyLight>(&light))
            load_sky(*sky, assets);
    return assets;
}

void keep_fields(FieldCache& kept, const Scene& scene, Assets assets) {
    for (std::size_t i = 0; i < assets.media.size(); ++i) {
        LoadedMedium& medium = assets.media[i];
        const auto* file = std::get_if<GridFile>(&scene.volumes[i].shape);
        if (file && medium.field)
            kept.keep(*file, std::move(*medium.field));
        if (file && medium.temperature)
            kept.keep({file->path, scene.volumes[i].temperature.grid}, std::move(*medium.temperature));
        if (file && medium.albedo)
            kept.keep({file->path, scene.volumes[i].albedo_grid}, std::move(*medium.albedo));
    }
}

} // namespace vkvol
