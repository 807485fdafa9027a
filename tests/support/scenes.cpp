#include "scenes.h"

#include <nanovdb/util/IO.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <numbers>
#include <unistd.h>

#include "image_io.h"
#include "tests/reference/camera.h"
#include "tests/reference/rng.h"

namespace vkvol {

namespace {

// Exists as long as the program.
class TemporaryDirectory {
public:
    TemporaryDirectory() : path_(std::filesystem::temp_directory_path() / fmt::format("vkvol-tests-{}", ::getpid())) {
        std::filesystem::create_directories(path_);
    }
    ~TemporaryDirectory() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

std::filesystem::path temporary_file(const char* extension) {
    static const TemporaryDirectory directory;
    static int count = 0;
    return directory.path() / fmt::format("{}.{}", count++, extension);
}

double hash(glm::ivec3 i, std::uint32_t octave) {
    return reference::pcg4d({std::uint32_t(i.x), std::uint32_t(i.y), std::uint32_t(i.z), octave})[0] * 0x1p-32;
}

// Random values at the integers, interpolated.
double value_noise(glm::dvec3 p, std::uint32_t octave) {
    const glm::dvec3 base = glm::floor(p), f = p - base;
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 c(corner & 1, corner >> 1 & 1, corner >> 2);
        const glm::dvec3 weight = glm::mix(1.0 - f, f, glm::dvec3(c));
        sum += weight.x * weight.y * weight.z * hash(glm::ivec3(base) + c, octave);
    }
    return sum;
}

} // namespace

GridFile write_grids(const std::vector<GridRecipe>& grids) {
    const std::filesystem::path path = temporary_file("nvdb");
    std::vector<nanovdb::GridHandle<>> handles;
    for (const GridRecipe& grid : grids) {
        const GridBytes bytes = make_grid_bytes(grid);
        auto buffer = nanovdb::HostBuffer::create(bytes.size());
        std::memcpy(buffer.data(), bytes.data(), bytes.size());
        handles.emplace_back(std::move(buffer));
    }
    nanovdb::io::writeGrids(path.string(), handles);
    return {path, grids.front().name};
}

GridFile write_grid(const GridRecipe& grid) {
    return write_grids({grid});
}

SkyLight write_sky(const RadianceMap& map, SkyMapping mapping) {
    Film film;
    film.picture_width = map.width;
    film.picture_height = map.height;
    film.crop = {0, map.width, 0, map.height};
    film.mean = map.texels;
    film.variance.resize(map.texels.size());
    film.samples.resize(map.texels.size());
    SkyLight sky;
    sky.file = temporary_file("exr");
    sky.mapping = mapping;
    write_exr(sky.file, film, {});
    return sky;
}

MeshFiles write_mesh(const Mesh& mesh) {
    const std::filesystem::path path = temporary_file("obj");
    std::ofstream(path) << as_obj(mesh);
    return {{path}};
}

glm::dvec3 center_of(const GridRecipe& grid) {
    return grid.linear * (glm::dvec3(grid.first + grid.last) / 2.0) + grid.translation;
}

float cloud_noise(glm::ivec3 voxel) {
    double sum = 0.0;
    for (std::uint32_t octave = 0; octave < 4; ++octave)
        sum += value_noise(glm::dvec3(voxel) / double(16 >> octave), octave) * std::ldexp(1.0, -int(octave) - 1);
    return static_cast<float>(std::max(0.0, std::min(1.0, (sum - 0.4) * 3.0)));
}

GridRecipe cloud_grid(Storage storage) {
    GridRecipe grid{{-17, -12, -19}, {14, 15, 10}, cloud_noise, storage};
    grid.linear = glm::dmat3(0.3);
    grid.translation = -center_of(grid);
    return grid;
}

Volume medium(decltype(Volume::shape) shape, double sigma_t, double albedo, double g) {
    Volume volume;
    volume.shape = std::move(shape);
    volume.sigma_a = Rgb(sigma_t * (1.0 - albedo));
    volume.sigma_s = Rgb(sigma_t * albedo);
    volume.unit = CoefficientUnit::world;
    volume.g = g;
    return volume;
}

Volume slab(double tau, double albedo) {
    return medium(Box{{0.0, 0.0, -0.5}, {2e4, 2e4, 1.0}}, tau, albedo);
}

const GridFile& cloud_file() {
    static const GridFile file = write_grid(cloud_grid());
    return file;
}

Volume smoke() {
    Volume volume = medium(Sphere{{0.1, -0.1, 0.0}, 1.5}, 3.0, 0.9, 0.4);
    volume.noise = Noise{0.9, 3, 0.5, 2.0};
    return volume;
}

Scene by(Scene scene, const char* integrator) {
    scene.settings.integrator = integrator;
    return scene;
}

Volume thin_cloud() {
    return medium(cloud_file(), 0.8, 0.9, 0.4);
}

Scene scene_of(const Volume& volume, double width, int pixels, double distance, glm::dvec3 target,
               glm::dvec3 pitch_yaw_roll) {
    Scene scene;
    scene.picture = {pixels, pixels, 0.0, 0.0, double(pixels), double(pixels)};
    scene.camera.fov = 2.0 * std::atan(0.5 * width / distance) * 180.0 / std::numbers::pi;
    scene.camera.pitch = pitch_yaw_roll.x;
    scene.camera.yaw = pitch_yaw_roll.y;
    scene.camera.roll = pitch_yaw_roll.z;
    scene.camera.position = glm::dvec3(0.0);
    const reference::Ray middle = reference::camera_ray(scene.camera, scene.picture, 0.5 * pixels, 0.5 * pixels);
    scene.camera.position = target - distance * middle.direction;
    scene.volumes = {volume};
    return scene;
}

std::filesystem::path write_text(const std::string& text) {
    const std::filesystem::path file = temporary_file("txt");
    std::ofstream(file) << text;
    return file;
}

Volume NamedPhase::of(Volume volume) const {
    volume.phase = kind;
    volume.g = g;
    volume.phase_details = details;
    return volume;
}

std::vector<NamedPhase> all_phases() {
    using enum PhaseFunction;
    const auto two = [](double g2, double share) { return PhaseDetails{.g2 = g2, .share = share}; };
    const auto with_alpha = [](double alpha) { return PhaseDetails{.alpha = alpha}; };
    const auto water = [](double diameter) { return PhaseDetails{.diameter = diameter}; };
    // A forward peak of 10^4 times the rest, a bow, a glory, and nothing between 100 and 110 degrees.
    static const std::filesystem::path bow = write_text("# made up\n0 10000\n0.5 3000\n1, 200\n2 40\n5 8\n20 2\n60 1\n"
                                                        "100 0\n110 0\n138 3\n140 6\n145 2\n178 2.5\n180 4\n");
    return {{"henyeyGreenstein", henyey_greenstein, 0.6},
            {"rayleigh", rayleigh},
            {"doubleHenyeyGreenstein", double_henyey_greenstein, 0.8, two(-0.4, 0.3)},
            {"draine", draine, 0.5, with_alpha(5.0)},
            {"draine backward", draine, -0.7, with_alpha(1.0)},
            {"draine even", draine, 0.0, with_alpha(40.0)},
            {"draine sharp", draine, 0.97, with_alpha(250.0)},
            {"droplets 0.05", droplets, 0.0, water(0.05)},
            {"droplets 1", droplets, 0.0, water(1.0)},
            {"droplets 3", droplets, 0.0, water(3.0)},
            {"droplets 20", droplets, 0.0, water(20.0)},
            {"table", table, 0.0, PhaseDetails{.file = bow}},
            {"fournierForand", fournier_forand, 0.0, PhaseDetails{.index = 1.05, .backscatter = 0.1}}};
}

Scene absorption(glm::dvec3 middle, glm::dvec3 edges, glm::ivec3 cells, std::uint32_t spp) {
    Scene scene;
    scene.camera.projection = Projection::absorption;
    scene.camera.position = middle;
    scene.camera.edges = edges;
    scene.camera.cells = cells;
    const int rows = cells.y * cells.z;
    scene.picture = {cells.x, rows, 0.0, 0.0, double(cells.x), double(rows)};
    scene.settings.spp = spp;
    return scene;
}

DirectionalLight sunlight(Rgb irradiance) {
    return {glm::normalize(glm::dvec3(1.0, 1.5, 1.0)), irradiance};
}

Scene sunlit_cloud(int pixels, std::uint32_t spp) {
    Scene scene = scene_of(medium(cloud_file(), 2.0, 0.9, 0.5), 13.0, pixels);
    scene.background = {0.3, 0.5, 0.9};
    scene.lights = {sunlight()};
    scene.settings.spp = spp;
    return scene;
}

} // namespace vkvol
