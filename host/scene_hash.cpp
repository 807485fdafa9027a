#include "scene_hash.h"

#include <algorithm>
#include <cstdint>
#include <fmt/format.h>
#include <iterator>

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

    // FNV-1a, 64 bit.
    std::string hash() const {
        std::uint64_t hash = 14695981039346656037ull;
        for (const char c : text_) {
            hash ^= static_cast<unsigned char>(c);
            hash *= 1099511628211ull;
        }
        return fmt::format("{:016x}", hash);
    }

private:
    std::string text_;
};

void add_shape(Writer& writer, const Volume& volume) {
    if (const Sphere* sphere = std::get_if<Sphere>(&volume.shape)) {
        writer.add("sphere", sphere->center);
        writer.add("radius", sphere->radius);
    } else if (const Box* box = std::get_if<Box>(&volume.shape)) {
        writer.add("box", box->center);
        writer.add("size", box->size);
    } else if (const GridFile* grid = std::get_if<GridFile>(&volume.shape)) {
        std::error_code error;
        const std::uintmax_t size = std::filesystem::file_size(grid->path, error);
        writer.add("file", grid->path.filename().string());
        writer.add("bytes", error ? -1.0 : double(size));
        writer.add("grid", grid->grid);
        writer.add("unit", volume.unit == CoefficientUnit::world ? 1 : 0);
    }
}

void add_volume(Writer& writer, const Volume& volume) {
    add_shape(writer, volume);
    writer.add("sigma_a", volume.sigma_a);
    writer.add("sigma_s", volume.sigma_s);
    writer.add("density_scale", volume.density_scale);
    writer.add("g", volume.g);
    writer.add("Le", volume.Le);
    const TemperatureEmission& emission = volume.temperature;
    writer.add("emission", emission.color);
    writer.add("model", emission.model == TemperatureEmission::Model::color ? 0 : 1);
    writer.add("temperature", emission.grid);
    writer.add("kelvin", glm::dvec3(emission.scale, emission.offset, emission.cutoff));
    writer.add("reference", emission.reference);
}

void add_view(Writer& writer, const Camera& camera, const Picture& picture) {
    writer.add("position", camera.position);
    writer.add("rotation", glm::dvec3(camera.pitch, camera.yaw, camera.roll));
    writer.add("fov", camera.fov);
    writer.add("width", picture.width);
    writer.add("height", picture.height);
    writer.add("start", glm::dvec3(picture.start_x, picture.start_y, 0));
    writer.add("reference", glm::dvec3(picture.reference_width, picture.reference_height, 0));
}

} // namespace

std::string scene_hash(const Scene& scene) {
    Writer writer;
    add_view(writer, scene.camera, scene.picture);
    for (const Volume& volume : scene.volumes)
        add_volume(writer, volume);
    for (const DirectionalLight& light : scene.lights) {
        writer.add("direction", light.direction);
        writer.add("irradiance", light.irradiance);
    }
    writer.add("background", scene.background);
    writer.add("max_depth", scene.settings.max_depth ? double(*scene.settings.max_depth) : -1.0);
    // Trilinear and stochastic look-ups have the same expectation.
    writer.add("nearest", scene.settings.filter == Filter::nearest ? 1 : 0);
    writer.add("majorant_scale", std::min(1.0, scene.settings.majorant_scale));
    return writer.hash();
}

} // namespace vkvol
