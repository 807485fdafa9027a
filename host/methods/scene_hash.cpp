#include "scene_hash.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <map>
#include <string>

#include "digest.h"
#include "estimator_traits.h"
#include "memory_grids.h"
#include "method.h"
#include "obj_file.h"
#include "preset.h"
#include "shared/constants.h"
#include "surface_lamps.h"

namespace vkvol {

namespace {

// A canonical text of the scene; numbers in their shortest exact form.
class Writer {
public:
    void add(const char* key, double value) { fmt::format_to(std::back_inserter(text_), "{}={};", key, value); }
    void add(const char* key, const glm::dvec3& value) {
        fmt::format_to(std::back_inserter(text_), "{}={},{},{};", key, value.x, value.y, value.z);
    }
    void add(const char* key, const std::string& value) {
        fmt::format_to(std::back_inserter(text_), "{}={}:{};", key, value.size(), value);
    }

    // Grids that many volumes share are gone through once.
    void add(const MemoryGrids& grids) {
        std::string& digests = digests_[&grids];
        if (digests.empty()) {
            Writer one;
            for (const MemoryGrids::Grid& grid : grids.grids)
                one.add(grid.name.c_str(),
                        digest_text({reinterpret_cast<const char*>(grid.bytes.data()), grid.bytes.size()}));
            digests = one.text_;
        }
        text_ += digests;
    }

    std::string hash() const { return digest_text(text_); }

private:
    std::string text_;
    std::map<const MemoryGrids*, std::string> digests_;
};

void add_file(Writer& writer, const std::filesystem::path& path) {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    writer.add("file", path.filename().string());
    writer.add("bytes", error ? -1.0 : double(size));
    writer.add("content", digest_of_file(path));
}

void add_shape(Writer& writer, const Volume& volume) {
    if (const Sphere* sphere = std::get_if<Sphere>(&volume.shape)) {
        writer.add("sphere", sphere->center);
        writer.add("radius", sphere->radius);
    } else if (const Box* box = std::get_if<Box>(&volume.shape)) {
        writer.add("box", box->center);
        writer.add("size", box->size);
    } else if (const GridFile* grid = std::get_if<GridFile>(&volume.shape)) {
        if (grid->memory)
            writer.add(*grid->memory);
        else
            add_file(writer, grid->path);
        writer.add("grid", grid->grid);
        if (volume.drift.exists()) {
            writer.add("velocity", volume.drift.grid);
            writer.add("seconds", volume.drift.seconds);
        }
        writer.add("unit", volume.unit == CoefficientUnit::world ? 1 : 0);
    } else if (is_everywhere(volume)) {
        writer.add("everywhere", 1.0);
    } else if (const MeshFiles* mesh = std::get_if<MeshFiles>(&volume.shape)) {
        for (const std::filesystem::path& path : mesh->paths)
            add_file(writer, path);
    }
    if (volume.layers) {
        writer.add("layers", glm::dvec3(volume.layers->axis, volume.layers->bottom, volume.layers->top));
        writer.add("scale_height", glm::dvec3(volume.layers->scale_height, volume.layers->reference, 0.0));
    }
    if (volume.noise) {
        writer.add("noise", volume.noise->frequency);
        writer.add("octaves", volume.noise->octaves);
        writer.add("gain", volume.noise->gain);
        writer.add("lacunarity", volume.noise->lacunarity);
    }
}

void add_phase(Writer& writer, const Volume& volume) {
    const PhaseDetails& details = volume.phase_details;
    if (volume.phase != PhaseFunction::henyey_greenstein)
        writer.add("phase", static_cast<int>(volume.phase));
    if (volume.phase == PhaseFunction::rayleigh && details.depolarization > 0.0)
        writer.add("depolarization", details.depolarization);
    if (volume.phase == PhaseFunction::double_henyey_greenstein)
        writer.add("second", glm::dvec3(details.g2, details.share, 0.0));
    if (volume.phase == PhaseFunction::draine)
        writer.add("alpha", details.alpha);
    if (volume.phase == PhaseFunction::droplets)
        writer.add("diameter", details.diameter);
    if (volume.phase == PhaseFunction::table)
        add_file(writer, details.file);
    if (volume.phase == PhaseFunction::fournier_forand) {
        writer.add("index", details.index);
        writer.add("backscatter", details.backscatter);
    }
}

void add_map(Writer& writer, const ValueMap& map) {
    if (!map.exists())
        return;
    writer.add("map", glm::dvec3(double(map.points.size()), map.rise, map.is_transfer ? 1.0 : 0.0));
    for (const MapPoint& point : map.points) {
        writer.add("point", glm::dvec3(point.value, point.density, 0.0));
        writer.add("albedo", point.albedo);
        writer.add("glow", point.emission);
    }
}

void add_volume(Writer& writer, const Volume& volume) {
    add_shape(writer, volume);
    add_map(writer, volume.map);
    if (volume.transform != glm::dmat4(1.0))
        for (int column = 0; column < 4; ++column)
            writer.add("transform", glm::dvec3(volume.transform[column]));
    writer.add("sigma_a", volume.sigma_a);
    writer.add("sigma_s", volume.sigma_s);
    writer.add("density_scale", volume.density_scale);
    writer.add("g", volume.g);
    add_phase(writer, volume);
    if (!volume.albedo_grid.empty())
        writer.add("albedo", volume.albedo_grid);
    writer.add("Le", volume.Le);
    const TemperatureEmission& emission = volume.temperature;
    writer.add("emission", emission.color);
    writer.add("model", emission.model == TemperatureEmission::Model::color ? 0 : 1);
    writer.add("temperature", emission.grid);
    writer.add("kelvin", glm::dvec3(emission.scale, emission.offset, emission.cutoff));
    writer.add("reference", emission.reference);
}

void add_light(Writer& writer, const DirectionalLight& light) {
    writer.add("direction", light.direction);
    writer.add("irradiance", light.irradiance);
}

void add_light(Writer& writer, const SunLight& light) {
    writer.add("sun", light.direction);
    writer.add("irradiance", light.irradiance);
    writer.add("angle", light.angle);
    if (light.limb_darkening > 0.0)
        writer.add("limb", light.limb_darkening);
}

void add_light(Writer& writer, const PointLight& light) {
    writer.add("point", light.position);
    writer.add("intensity", light.intensity);
}

void add_light(Writer& writer, const SpotLight& light) {
    writer.add("spot", light.position);
    writer.add("axis", light.direction);
    writer.add("intensity", light.intensity);
    writer.add("cone", glm::dvec3(light.angle, light.blend, 0.0));
}

void add_light(Writer& writer, const SphereLight& light) {
    writer.add("ball", light.center);
    writer.add("radius", light.radius);
    writer.add("radiance", light.radiance);
}

void add_light(Writer& writer, const DiskLight& light) {
    writer.add("disk", light.center);
    writer.add("normal", light.normal);
    writer.add("radius", light.radius);
    writer.add("radiance", light.radiance);
}

void add_light(Writer&, const SurfaceLight&) {} // known by its surface
void add_light(Writer&, const GlowLight&) {}    // by its medium

void add_light(Writer& writer, const RectangleLight& light) {
    writer.add("rectangle", light.center);
    writer.add("edge", light.edge_u);
    writer.add("other", light.edge_v);
    writer.add("radiance", light.radiance);
}

void add_light(Writer& writer, const SkyLight& light) {
    if (light.daylight) {
        writer.add("daylight", light.daylight->sun);
        writer.add("air", glm::dvec3(light.daylight->turbidity, light.daylight->ground, 0.0));
    } else {
        add_file(writer, light.file);
    }
    if (light.mapping == SkyMapping::equal_area)
        writer.add("mapping", 1);
    writer.add("rotation", light.rotation);
    if (light.mirror)
        writer.add("mirror", 1);
    writer.add("scale", light.scale);
}

void add_shape(Writer& writer, const BallSurface& ball) {
    writer.add("center", ball.center);
    writer.add("radius", ball.radius);
}

void add_shape(Writer& writer, const DiskSurface& disk) {
    writer.add("disk_center", disk.center);
    writer.add("disk_normal", disk.normal);
    writer.add("disk_radius", disk.radius);
}

void add_shape(Writer& writer, const RectangleSurface& rectangle) {
    writer.add("rectangle_center", rectangle.center);
    writer.add("rectangle_edge", rectangle.edge_u);
    writer.add("rectangle_other", rectangle.edge_v);
}

void add_shape(Writer& writer, const PlaneSurface& plane) {
    writer.add("plane", plane.point);
    writer.add("plane_normal", plane.normal);
}

void add_shape(Writer& writer, const TriangleSurface& mesh) {
    for (const glm::uvec3& triangle : mesh.triangles)
        for (int corner = 0; corner < 3; ++corner)
            writer.add("corner", mesh.vertices[triangle[corner]]);
    for (const glm::mat3& normals : mesh.normals)
        for (int corner = 0; corner < 3; ++corner)
            writer.add("normal", glm::dvec3(normals[corner]));
}

void add_shape(Writer& writer, const MeshSurface& mesh) {
    add_file(writer, mesh.file);
    if (mesh.normals != MeshNormals::of_file)
        writer.add("normals", static_cast<int>(mesh.normals));
}

void add_texture(Writer& writer, const Surface& surface) {
    const Material& material = surface.material;
    if (!material.texture.empty()) {
        add_file(writer, material.texture);
    } else if (const auto& image = material.image) {
        writer.add("texels", glm::dvec3(image->width, image->height, image->is_nearest ? 1.0 : 0.0));
        for (const glm::vec3& texel : image->colors)
            writer.add("texel", glm::dvec3(texel));
    }
    writer.add("repeat", glm::dvec3(material.repeat, 0.0));
    for (int column = 0; column < 3; ++column)
        writer.add("axis", surface.axes[column]);
    if (const auto* mesh = std::get_if<TriangleSurface>(&surface.shape))
        for (const glm::mat3x2& places : mesh->places)
            for (int corner = 0; corner < 3; ++corner)
                writer.add("place", glm::dvec3(places[corner], 0.0));
}

void add_surface(Writer& writer, const Surface& surface) {
    std::visit([&](const auto& shape) { add_shape(writer, shape); }, surface.shape);
    if (surface.transform != glm::dmat4(1.0))
        for (int column = 0; column < 4; ++column)
            writer.add("transform", glm::dvec3(surface.transform[column]));
    const Material& material = surface.material;
    writer.add("material", static_cast<int>(material.kind));
    writer.add("color", material.color);
    if (has_index(material))
        writer.add("ior", material.ior);
    if (material.kind == MaterialKind::conductor) {
        writer.add("eta", material.eta);
        writer.add("k", material.k);
    }
    if (material.roughness > 0.0)
        writer.add("roughness", material.roughness);
    if (is_textured(material))
        add_texture(writer, surface);
    writer.add("shine", surface.emission);
    if (surface.shines_both_ways)
        writer.add("sides", 2);
}

void add_view(Writer& writer, const Camera& camera, const Picture& picture) {
    writer.add("position", camera.position);
    writer.add("rotation", glm::dvec3(camera.pitch, camera.yaw, camera.roll));
    if (camera.projection == Projection::perspective)
        writer.add("fov", camera.fov);
    else
        writer.add("projection", static_cast<int>(camera.projection));
    if (camera.projection == Projection::irradiance)
        writer.add("size", glm::dvec3(camera.size, 0.0));
    if (camera.projection == Projection::absorption) {
        writer.add("edges", camera.edges);
        writer.add("cells", glm::dvec3(camera.cells));
    }
    for (const glm::dvec3& point : camera.points)
        writer.add("at", point);
    if (camera.projection == Projection::orthographic)
        writer.add("view_height", camera.view_height);
    if (camera.lens.radius > 0.0)
        writer.add("lens", glm::dvec3(camera.lens.radius, camera.lens.focus, 0.0));
    if (camera.lens.radius > 0.0 && camera.lens.blades > 0)
        writer.add("blades", glm::dvec3(camera.lens.blades, camera.lens.rotation, 0.0));
    writer.add("width", picture.width);
    writer.add("height", picture.height);
    writer.add("start", glm::dvec3(picture.start_x, picture.start_y, 0));
    writer.add("reference", glm::dvec3(picture.reference_width, picture.reference_height, 0));
}

// Unbiased estimators of the same light have the same expectation, however they get it.
void add_method(Writer& writer, const RenderSettings& settings, const Method& method) {
    writer.add("scattering", method.scattering);
    if (method.scattering == SCATTERING_MULTIPLE)
        writer.add("max_depth", settings.max_depth ? double(*settings.max_depth) : -1.0);
    writer.add("material_colour", method.material_colour ? 1 : 0);
    // Trilinear and stochastic look-ups have the same expectation.
    writer.add("nearest", method.filter == Filter::nearest ? 1 : 0);
    if (method.biases & bias_majorant) {
        writer.add("majorant", glm::dvec3(settings.majorant_scale, settings.majorant_cell, method.nee));
        writer.add("tracking", glm::dvec3(method.free_flight, method.transmittance, 0));
    }
    if (method.biases & (bias_specular_view | bias_caustics | bias_caustics_in_mirrors))
        writer.add("smooth", method.biases & bias_specular_view         ? 1
                             : !(method.biases & bias_caustics)         ? 3
                             : method.biases & bias_caustics_in_mirrors ? 4
                                                                        : 2);
    const March& march = settings.march;
    if (method.biases & bias_flight_steps) {
        writer.add("flight", glm::dvec3(method.free_flight, march.step, method.emission_at));
        if (method.flights_have(TRAIT_OPTICAL_STEPS)) // its steps end at the faces of majorant cells, too
            writer.add("steps", glm::dvec3(march.optical_step, settings.majorant_scale, settings.majorant_cell));
    }
    if (method.biases & bias_shadow_steps)
        writer.add("shadow_step", march.shadow_step > 0.0 ? march.shadow_step : march.step);
    if (method.biases & (bias_flight_steps | bias_shadow_steps)) {
        writer.add("jitter", method.jitter ? 1 : 0);
        writer.add("step_unit", march.unit == CoefficientUnit::world ? 1 : 0);
    }
}

// Of models, whose colour may be that of their matter.
void add_materials(Writer& writer, const std::vector<Volume>& volumes) {
    for (const Volume& volume : volumes)
        if (const MeshFiles* mesh = std::get_if<MeshFiles>(&volume.shape))
            for (const std::filesystem::path& path : mesh->paths)
                for (const std::filesystem::path& library : material_libraries(path))
                    add_file(writer, library);
}

void add_motion(Writer& writer, const Scene& scene) {
    const MotionBlur& blur = *scene.motion_blur;
    writer.add("motion", glm::dvec3(blur.open, blur.close, 0.0));
    for (const double time : telling_times(blur)) {
        Scene then = scene_of_time(scene, time);
        then.motion_blur.reset();
        writer.add("then", scene_hash(then));
    }
}

} // namespace

std::string scene_hash(const Scene& authored) {
    const Scene scene = with_preset(authored);
    const Method method = choose_method(scene);
    Writer writer;
    add_view(writer, scene.camera, scene.picture);
    if (!has_plain_pixels(scene.settings))
        writer.add("pixel",
                   glm::dvec3(static_cast<int>(scene.settings.pixel_filter), scene.settings.pixel_filter_radius, 0.0));
    for (const Volume& volume : scene.volumes)
        add_volume(writer, volume);
    const Scene shining = without_lamps_of_surfaces(scene); // the same picture, whether they are met or looked for
    for (const Surface& surface : shining.surfaces)
        add_surface(writer, surface);
    for (const Light& light : shining.lights)
        if (method.uses_lights() || is_met_by_chance(light))
            std::visit([&writer](const auto& kind) { add_light(writer, kind); }, light);
    // Where light scatters but once, what flights meet is scattered by looks alone.
    const auto shines = [](const Surface& surface) { return surface.emission != Rgb(0.0); };
    if (method.scattering == SCATTERING_SINGLE &&
        (std::any_of(scene.lights.begin(), scene.lights.end(), is_met_by_chance) ||
         std::any_of(shining.surfaces.begin(), shining.surfaces.end(), shines)))
        writer.add("looks", method.uses_lights() ? 1 : 0);
    if (method.biases & (bias_flight_steps | bias_shadow_steps))
        writer.add("mis", glm::dvec3(method.mis.value_or(MIS_BALANCE), method.nee, method.distance.value_or(-1)));
    if (method.biases & bias_shadow_steps)
        writer.add("shadows", method.transmittance);
    if (scene.periodic) {
        writer.add("periodic", scene.periodic->low);
        writer.add("size", scene.periodic->size());
    }
    writer.add("background", scene.background);
    if (scene.holds_out)
        writer.add("holdout", 1);
    add_method(writer, scene.settings, method);
    if (method.material_colour)
        add_materials(writer, scene.volumes);
    if (scene.motion_blur)
        add_motion(writer, scene);
    return writer.hash();
}

} // namespace vkvol
