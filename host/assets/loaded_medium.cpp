#include "loaded_medium.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

#include "blackbody.h"
#include "drift.h"
#include "error.h"
#include "layers.h"
#include "phase_params.h"
#include "phase_table.h"
#include "pilot_paths.h"
#include "render_limits.h"
#include "scene_facts.h"
#include "shared/estimators.h"
#include "value_map.h"

namespace vkvol {

Rgb world_sigma_t(const Volume& volume, const DensityField* field) {
    const Rgb sigma_t = (volume.sigma_a + volume.sigma_s) * volume.density_scale;
    return field && volume.unit == CoefficientUnit::voxel ? sigma_t / field->voxel_size() : sigma_t;
}

Majorants::Majorants(MajorantGrid grid) : MajorantGrid(std::move(grid)) {
    if (bounds.empty())
        return;
    mean = std::accumulate(bounds.begin(), bounds.end(), 0.0) / static_cast<double>(bounds.size());
    most = *std::max_element(bounds.begin(), bounds.end());
}

std::vector<const DensityField*> grids_of(const LoadedMedium& medium) {
    std::vector<const DensityField*> grids;
    for (const auto* grid : {&medium.field, &medium.temperature, &medium.albedo})
        if (*grid)
            grids.push_back(&**grid);
    return grids;
}

double hottest_radiance(const Volume& volume, const LoadedMedium& loaded) {
    if (!loaded.temperature)
        return 0.0;
    double most = loaded.largest_temperature;
    if (volume.temperature.model == TemperatureEmission::Model::blackbody) {
        most = 0.0;
        for (const glm::vec4& color : loaded.blackbody)
            for (int i = 0; i < 3; ++i)
                most = std::isfinite(color[i]) ? std::max(most, double(color[i]))
                                               : std::numeric_limits<double>::infinity();
    }
    return most * largest(volume.temperature.color);
}

std::vector<const DensityField*> distinct_grids(Media media) {
    std::set<const std::byte*> seen;
    std::vector<const DensityField*> grids;
    for (const LoadedMedium& medium : media)
        for (const DensityField* grid : grids_of(medium))
            if (seen.insert(grid->bytes.data()).second)
                grids.push_back(grid);
    return grids;
}

namespace {

bool glows_by_grid(const Volume& volume) {
    return volume.temperature.color * most_sigma_a(volume) != Rgb(0.0);
}

} // namespace

std::vector<GridFile> grid_files(const Scene& scene) {
    std::vector<GridFile> files;
    for (const Volume& volume : scene.volumes)
        if (const auto* file = std::get_if<GridFile>(&volume.shape))
            for (const std::string& grid : {file->grid, glows_by_grid(volume) ? volume.temperature.grid : "",
                                            volume.albedo_grid, volume.drift.exists() ? volume.drift.grid : ""})
                if (!grid.empty())
                    files.push_back(file->beside(grid));
    return files;
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

// Reads media. What several of them have is read and made once, and what is said of it is said once.
class Loader {
public:
    Loader(const Scene& scene, const Method& method, FieldCache& fields)
        : scene_(scene), method_(method), fields_(fields) {
        for (const Volume& volume : scene.volumes)
            knots_ = std::max(knots_, make_knots(volume.map).size());
    }

    LoadedMedium load(const Volume& volume);

private:
    DensityField field_of(const Volume& volume, const GridFile& file, GridValues values = GridValues::numbers,
                          bool goes_on = false);
    DensityField drifted(const Drift& drift, const GridFile& file, const DensityField& field, bool goes_on);
    float largest_value(const DensityField& field);
    void load_phase_nodes(const Volume& volume, LoadedMedium& loaded);
    void load_grid(const Volume& volume, const GridFile& file, LoadedMedium& loaded);
    void load_majorants(const Volume& volume, const DensityField& field, LoadedMedium& loaded);
    void load_layers(const Volume& volume, LoadedMedium& loaded);
    void scale_bounds(MajorantGrid& cells, LoadedMedium& loaded) const;
    SharedArray<shared::MapKnot> knots_of(const Volume& volume);
    void load_map(const Volume& volume, const GridFile& file, const DensityField& field, LoadedMedium& loaded);
    void load_temperature(const Volume& volume, const GridFile& file, LoadedMedium& loaded);
    void load_blackbody(const TemperatureEmission& emission, const GridFile& file, LoadedMedium& loaded);
    void load_albedo(const Volume& volume, const GridFile& file, LoadedMedium& loaded);
    void load_models(const Volume& volume, const MeshFiles& files, LoadedMedium& loaded);
    void warn(LoadedMedium& loaded, std::string message) {
        if (said_.insert(message).second)
            loaded.warnings.push_back(std::move(message));
    }

    const Scene& scene_;
    const Method& method_;
    FieldCache& fields_;
    // By the bytes of their grid, and its map.
    std::map<std::pair<const std::byte*, std::vector<double>>, std::shared_ptr<const Majorants>> majorants_;
    std::map<std::vector<double>, SharedArray<shared::MapKnot>> maps_;
    std::size_t knots_ = 0;                     // of the scene's longest map: one search serves all
    std::map<const std::byte*, float> largest_; // likewise
    // By the bytes of grid and velocities, seconds, and whether it goes on.
    std::map<std::tuple<const std::byte*, const std::byte*, double, bool>, DensityField> drifted_;
    std::map<std::pair<double, double>, SharedArray<glm::vec4>> blackbodies_;
    std::map<std::tuple<PhaseFunction, std::string, double, double>, SharedArray<shared::PhaseNode>>
        phases_; // by what they are made of
    std::set<std::string> said_;
};

DensityField Loader::field_of(const Volume& volume, const GridFile& file, GridValues values, bool goes_on) {
    DensityField field = fields_.take(file, values);
    if (volume.drift.exists())
        field = drifted(volume.drift, file, field, goes_on);
    field.place(volume.transform);
    return field;
}

// Once for all that have the grid at that time.
DensityField Loader::drifted(const Drift& drift, const GridFile& file, const DensityField& field, bool goes_on) {
    const DensityField velocity = fields_.take(file.beside(drift.grid), GridValues::vectors);
    const auto [found, is_new] =
        drifted_.try_emplace({field.bytes.data(), velocity.bytes.data(), drift.seconds, goes_on});
    if (!is_new)
        return found->second;
    try {
        return found->second = vkvol::drifted(field, velocity, drift.seconds, goes_on);
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: \"{}\": {}", file.path.string(), drift.grid, error.what()));
    }
}

float Loader::largest_value(const DensityField& field) {
    const auto [found, is_new] = largest_.try_emplace(field.bytes.data());
    if (is_new)
        found->second = field.max_value();
    return found->second;
}

void Loader::load_albedo(const Volume& volume, const GridFile& file, LoadedMedium& loaded) {
    if (volume.albedo_grid.empty())
        return;
    DensityField field = field_of(volume, file.beside(volume.albedo_grid), GridValues::numbers_or_colors, true);
    if (field.active_voxels == 0)
        throw InputError(
            fmt::format("{}: \"{}\" has no active voxel, and would make the medium black; leave <albedo> out",
                        file.path.string(), volume.albedo_grid));
    if (const float most = largest_value(field); most > 1.001f) // of white, quantised ones come out a digit above
        warn(loaded, fmt::format("{}: \"{}\" has values up to {:.4g}, and what is above 1 counts as 1: an albedo; "
                                 "divide them where they are made (colours of 8 bits by 255)",
                                 file.path.string(), volume.albedo_grid, most));
    if (largest_value(field) == 0.0f)
        warn(loaded, fmt::format("{}: \"{}\" is 0 everywhere: the medium absorbs all that it meets; name "
                                 "another grid (vkvol info lists them), or leave <albedo> out",
                                 file.path.string(), volume.albedo_grid));
    loaded.albedo = std::move(field);
}

// A file without that grid, or one that holds no heat, does not glow: a warning, no error.
void Loader::load_temperature(const Volume& volume, const GridFile& file, LoadedMedium& loaded) {
    const TemperatureEmission& emission = volume.temperature;
    if (!glows_by_grid(volume))
        return;
    if (!fields_.has(file.beside(emission.grid)))
        return warn(loaded, fmt::format("{}: has no grid \"{}\": <emission> is without effect", file.path.string(),
                                        emission.grid));
    const bool by_kelvin = emission.model == TemperatureEmission::Model::blackbody;
    DensityField field =
        field_of(volume, file.beside(emission.grid), by_kelvin ? GridValues::numbers : GridValues::numbers_or_colors);
    loaded.largest_temperature = field.active_voxels > 0 ? largest_value(field) : 0.0f;
    if (field.active_voxels == 0 || (loaded.largest_temperature <= 0.0f && !by_kelvin))
        warn(loaded, fmt::format("{}: \"{}\" has no value above 0: <emission> is without effect", file.path.string(),
                                 emission.grid));
    if (field.active_voxels == 0)
        return;
    if (by_kelvin)
        load_blackbody(emission, file, loaded);
    loaded.temperature = std::move(field);
}

void Loader::load_blackbody(const TemperatureEmission& emission, const GridFile& file, LoadedMedium& loaded) {
    loaded.hottest = std::max({emission.scale * loaded.largest_temperature + emission.offset, emission.offset, 0.0});
    if (loaded.hottest < 500.0 || loaded.hottest > 40000.0)
        warn(loaded, fmt::format("{}: \"{}\" reaches {:.0f} kelvin by temperatureScale and temperatureOffset; flames "
                                 "have 1000 to 3000, {}",
                                 file.path.string(), emission.grid, loaded.hottest,
                                 loaded.hottest < 500.0
                                     ? "and what is so cool hardly glows; raise temperatureScale"
                                     : "and beside what is so hot the brightness of flames is known the worse"));
    if (!(loaded.hottest <= hottest_kelvin))
        throw InputError(fmt::format("{}: \"{}\" reaches {:.3g} kelvin by temperatureScale and temperatureOffset, but "
                                     "{:g} is the most; lower temperatureScale",
                                     file.path.string(), emission.grid, loaded.hottest, hottest_kelvin));
    loaded.hottest = std::max(loaded.hottest, 1.0);
    SharedArray<glm::vec4>& table = blackbodies_[{loaded.hottest, emission.reference}];
    if (table.empty())
        table = make_blackbody_table(0.0, loaded.hottest, emission.reference, BLACKBODY_ENTRIES);
    loaded.blackbody = table;
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
    pilot.albedo =
        largest(most_map_albedo(volume) * volume.sigma_s) / std::max(largest(volume.sigma_a + volume.sigma_s), 1e-300);
    pilot.g = g;
    pilot.leaps = leaps(method);
    pilot.map = volume.map;
    return pilot;
}

void Loader::scale_bounds(MajorantGrid& cells, LoadedMedium& loaded) const {
    const auto scale = static_cast<float>(scene_.settings.majorant_scale);
    for (float& bound : cells.bounds)
        bound *= scale;
    for (shared::ControlCell& cell : loaded.controls)
        cell.residual *= scale;
}

// The cells' bounds are scaled after the controls are made: these bound the density itself. Of several media there are
// no controls, and cells are a matter of speed alone: then all that have the grid make do with those of the first.
void Loader::load_majorants(const Volume& volume, const DensityField& field, LoadedMedium& loaded) {
    std::shared_ptr<const Majorants>& known = majorants_[{field.bytes.data(), numbers_of(volume.map)}];
    if (known) {
        loaded.majorants = known;
        return;
    }
    const double scale = scene_.settings.majorant_scale;
    const double voxel_sigma_t = largest(world_sigma_t(volume, &field)) * field.voxel_size();
    MajorantGrid cells = choose_majorant_grid(
        field,
        pilot_scene(scene_, volume, method_, field, voxel_sigma_t * scale, mean_cosine(volume, loaded.phase_nodes)),
        scene_.settings.majorant_cell);
    const bool decomposes = method_.flights_have(TRAIT_CONTROL);
    if (decomposes || method_.shadow_rays_have(TRAIT_CONTROL))
        loaded.controls = make_controls(field, cells, decomposes ? 0.0 : voxel_sigma_t, volume.map);
    scale_bounds(cells, loaded);
    loaded.majorants = known = std::make_shared<const Majorants>(std::move(cells));
}

SharedArray<shared::MapKnot> Loader::knots_of(const Volume& volume) {
    if (!volume.map.exists())
        return {};
    SharedArray<shared::MapKnot>& known = maps_[numbers_of(volume.map)];
    if (known.empty()) {
        std::vector<shared::MapKnot> knots = make_knots(volume.map);
        pad_knots(knots, knots_);
        known = std::move(knots);
    }
    return known;
}

void Loader::load_layers(const Volume& volume, LoadedMedium& loaded) {
    loaded.is_layered = true;
    MajorantGrid cells = layer_cells(volume);
    if (method_.flights_have(TRAIT_CONTROL) || method_.shadow_rays_have(TRAIT_CONTROL))
        loaded.controls = layer_controls(volume);
    scale_bounds(cells, loaded);
    loaded.majorants = std::make_shared<const Majorants>(std::move(cells));
    loaded.map_knots = knots_of(volume);
}

void Loader::load_map(const Volume& volume, const GridFile& file, const DensityField& field, LoadedMedium& loaded) {
    loaded.map_knots = knots_of(volume);
    if (volume.map.exists() && loaded.majorants->most == 0.0)
        warn(loaded, fmt::format("{}: \"{}\" has values up to {:g}, which <{}> maps to nothing: there is no medium; "
                                 "give points among these values more than 0",
                                 file.path.string(), file.grid, largest_value(field),
                                 volume.map.is_transfer ? "transferFunction" : "densityMap"));
}

void Loader::load_grid(const Volume& volume, const GridFile& file, LoadedMedium& loaded) {
    if (volume.drift.exists() && volume.map.exists() && mapped_density(volume.map, 0.0) > 0.0)
        throw InputError(fmt::format("{}: \"{}\" moves the medium, which its map leaves no end: it gives density where "
                                     "the grid has 0; let it give none there, or leave velocity out",
                                     file.path.string(), volume.drift.grid));
    if (volume.drift.exists() && scene_.periodic)
        warn(loaded, fmt::format("{}: what \"{}\" carries out of a domain that repeats does not come in on the other "
                                 "side: the medium thins out along its borders by as much",
                                 file.path.string(), volume.drift.grid));
    DensityField field = field_of(volume, file);
    if (field.active_voxels == 0)
        return;
    if (field.background > 0.0f)
        warn(loaded, fmt::format("{}: \"{}\" has a background of {:g}: it fills the box of active voxels, "
                                 "and ends where they do",
                                 file.path.string(), file.grid, field.background));
    load_majorants(volume, field, loaded);
    load_map(volume, file, field, loaded);
    loaded.field = std::move(field);
    load_temperature(volume, file, loaded);
    load_albedo(volume, file, loaded);
}

void Loader::load_phase_nodes(const Volume& volume, LoadedMedium& loaded) {
    if (volume.phase != PhaseFunction::table && volume.phase != PhaseFunction::fournier_forand)
        return;
    const PhaseDetails& details = volume.phase_details;
    SharedArray<shared::PhaseNode>& nodes =
        phases_[{volume.phase, details.file.native(), details.index, details.backscatter}];
    if (nodes.empty()) {
        PhaseTable table = phase_table(volume);
        nodes = std::move(table.nodes);
        for (std::string& warning : table.warnings)
            warn(loaded, std::move(warning));
    }
    loaded.phase_nodes = nodes;
}

void Loader::load_models(const Volume& volume, const MeshFiles& files, LoadedMedium& loaded) {
    loaded.mesh = load_mesh(files, volume.transform);
    const glm::dvec3 middle = box_center(*loaded.mesh);
    const bool has_matter = (volume.sigma_a + volume.sigma_s) * volume.density_scale != Rgb(0.0);
    if (is_superposition(scene_) && has_matter)
        loaded.inside = std::make_shared<const InsideLattice>(make_inside_lattice(corners_about(*loaded.mesh, middle)));
    else
        loaded.bvh = build_bvh(*loaded.mesh, middle);
    if (method_.material_colour)
        loaded.warnings.insert(loaded.warnings.end(), loaded.mesh->warnings.begin(), loaded.mesh->warnings.end());
    if (method_.material_colour && !loaded.mesh->diffuse)
        loaded.warnings.push_back(fmt::format("{}: has no material with a diffuse colour; <medium> is what glows",
                                              files.paths.front().string()));
}

LoadedMedium Loader::load(const Volume& volume) {
    LoadedMedium loaded;
    load_phase_nodes(volume, loaded);
    if (const auto* file = std::get_if<GridFile>(&volume.shape))
        load_grid(volume, *file, loaded);
    if (volume.layers)
        load_layers(volume, loaded);
    if (const auto* files = std::get_if<MeshFiles>(&volume.shape))
        load_models(volume, *files, loaded);
    return loaded;
}

void load_sky(const SkyLight& sky, SkyCache& skies, Assets& assets) {
    try {
        assets.sky = skies.take(sky);
    } catch (const InputError& error) {
        throw InputError(sky.place.empty() ? error.what() : fmt::format("{}: {}", sky.place, error.what()));
    }
    for (const std::string& warning : assets.sky->warnings)
        assets.warnings.push_back(sky.place.empty() ? warning : fmt::format("{}: {}", sky.place, warning));
}

} // namespace

Assets load_assets(const Scene& scene, const Method& method, FieldCache* kept, SkyCache* skies) {
    check_scene_limits(scene);
    FieldCache own;
    SkyCache own_skies;
    FieldCache& fields = kept ? *kept : own;
    fields.retain(grid_files(scene));
    Loader loader(scene, method, fields);
    Assets assets;
    assets.media.reserve(scene.volumes.size());
    for (const Volume& volume : scene.volumes) {
        try {
            assets.media.push_back(loader.load(volume));
            check_limits(scene, volume, assets.media.back(), method);
            if (const std::string trouble = too_short_paths(scene, volume, assets.media.back()); !trouble.empty())
                assets.media.back().warnings.push_back(volume.place.empty() ? trouble : volume.place + ": " + trouble);
        } catch (const InputError& error) { // of the file, say; the scene says who asked for it
            if (volume.place.empty())
                throw;
            throw InputError(fmt::format("{}: {}", volume.place, error.what()));
        }
    }
    check_everywhere(scene, assets.media, method.scattering);
    check_way_out(scene, assets.media, method.scattering);
    if (std::string shut_out = lights_shut_out(scene); !shut_out.empty())
        assets.warnings.push_back(std::move(shut_out));
    if (is_superposition(scene))
        assets.superposition = superpose(scene, assets.media, method);
    if (assets.superposition)
        check_limits(scene, *assets.superposition, method);
    for (const Light& light : scene.lights)
        if (const auto* sky = std::get_if<SkyLight>(&light))
            load_sky(*sky, skies ? *skies : own_skies, assets);
    if (skies && !assets.sky)
        *skies = {};
    return assets;
}

} // namespace vkvol
