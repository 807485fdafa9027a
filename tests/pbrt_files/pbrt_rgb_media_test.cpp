// pbrt-v4's media with a colour in each voxel.
#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <fstream>
#include <random>

#include "density_field.h"
#include "error.h"
#include "pbrt_scenes.h"
#include "support/images.h"
#include "support/test_directory.h"

using namespace vkvol;
using Catch::Contains;

namespace {

constexpr glm::ivec3 dims(2, 3, 2);
constexpr int voxels = dims.x * dims.y * dims.z;

std::string rgb_medium(const std::string& parameters) {
    return "MakeNamedMedium \"m\" \"string type\" \"rgbgrid\" \"integer nx\" 2 \"integer ny\" 3 \"integer nz\" 2 " +
           parameters + "\nMaterial \"interface\" MediumInterface \"m\" \"\" Shape \"sphere\" \"float radius\" 99\n";
}

// Before terabytes are asked for.
std::string huge_medium() {
    return "MakeNamedMedium \"m\" \"string type\" \"rgbgrid\" \"integer nx\" 4096 \"integer ny\" 4096 \"integer nz\" "
           "4096 "
           "\"rgb sigma_s\" [ 1 1 1 ]\nMaterial \"interface\" MediumInterface \"m\" \"\" Shape \"sphere\"\n";
}

using Colors = std::vector<glm::dvec3>;

Colors random_colors(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> value(0.0, 2.0);
    Colors colors;
    for (int i = 0; i < voxels; ++i)
        colors.emplace_back(value(random), value(random), i % 5 == 0 ? 0.0 : value(random));
    return colors;
}

Colors multiples_of(const glm::dvec3& color, unsigned seed) {
    Colors colors;
    for (const glm::dvec3& random : random_colors(seed))
        colors.push_back(random.x * color);
    return colors;
}

std::string parameter(const char* name, const Colors& colors) {
    std::string text = fmt::format("\"rgb {}\" [", name);
    for (const glm::dvec3& color : colors)
        text += fmt::format(" {} {} {}", color.x, color.y, color.z);
    return text + " ] ";
}

// What all media of a scene together absorb, scatter and emit in a voxel, per length.
struct Voxel {
    glm::dvec3 sigma_a{0.0}, sigma_s{0.0}, emission{0.0};
};

Voxel voxel_of(const Scene& scene, glm::ivec3 at) {
    Voxel sum;
    for (const Volume& volume : scene.volumes) {
        const GridFile& file = std::get<GridFile>(volume.shape);
        const double density = load_density_field(file).value(at);
        sum.sigma_a += density * volume.sigma_a;
        sum.sigma_s += density * volume.sigma_s;
        if (volume.temperature.color != glm::dvec3(0.0))
            sum.emission += density * volume.sigma_a * volume.temperature.color *
                            double(load_density_field(file.beside(volume.temperature.grid)).value(at));
    }
    return sum;
}

glm::ivec3 place(int i) {
    return {i % dims.x, i / dims.x % dims.y, i / (dims.x * dims.y)};
}

} // namespace

TEST_CASE("media of a colour in each voxel add up to pbrt's", "[cpu][pbrt]") {
    struct Case {
        Colors sigma_a, sigma_s, glow;
        std::size_t media;
    };
    const glm::dvec3 warm(1.0, 0.5, 0.0), cold(0.2, 0.3, 0.7);
    const Case cases[] = {{random_colors(1), random_colors(2), {}, 6},
                          {multiples_of(warm, 1), multiples_of(cold, 2), {}, 2},
                          {multiples_of(warm, 1), multiples_of(cold, 2), multiples_of(cold, 3), 2},
                          {multiples_of(warm, 1), multiples_of(cold, 2), random_colors(3), 3}, // warm has no blue
                          {random_colors(1), multiples_of(cold, 2), multiples_of(warm, 3), 4}};
    for (const Case& each : cases) {
        const std::string glow = each.glow.empty() ? "" : parameter("Le", each.glow) + "\"float Lescale\" 3 ";
        const Scene scene =
            world_of(rgb_medium(parameter("sigma_a", each.sigma_a) + parameter("sigma_s", each.sigma_s) + glow +
                                "\"float scale\" 2 \"float g\" 0.4"));
        CHECK(scene.volumes.size() == each.media);
        for (const Volume& volume : scene.volumes)
            CHECK(volume.g == 0.4);
        double exposure = 0.0; // the same for all
        for (int i = 0; i < voxels; ++i) {
            const std::size_t at = std::size_t(i);
            const Voxel voxel = voxel_of(scene, place(i));
            // Grids are of single precision.
            CHECK(glm::length(voxel.sigma_a - 2.0 * each.sigma_a[at]) < 1e-5);
            CHECK(glm::length(voxel.sigma_s - 2.0 * each.sigma_s[at]) < 1e-5);
            if (each.glow.empty())
                continue;
            const glm::dvec3 expected = 2.0 * each.sigma_a[at] * 3.0 * each.glow[at];
            if (exposure == 0.0 && expected.x > 0.0)
                exposure = voxel.emission.x / expected.x;
            CHECK(glm::length(voxel.emission - exposure * expected) < 1e-5 * exposure);
        }
        // pbrt divides light by the integral of the observer where it comes from lights, and not where from these
        // grids.
        CHECK((each.glow.empty() || exposure == Approx(106.8569)));
    }
    // What is not there is 1.
    const Scene half = world_of(rgb_medium(parameter("sigma_s", random_colors(2))));
    CHECK(voxel_of(half, {1, 2, 1}).sigma_a == glm::dvec3(1.0));
}

// The reference knows media of one density; their colours differ from multiples of one by less than noise shows.
TEST_CASE("media of a colour in each voxel are rendered as one of as many densities", "[gpu][pbrt][long]") {
    const TestDirectory directory;
    const glm::dvec3 absorbed(1.0, 0.4, 0.2), scattered(0.6, 0.9, 1.2);
    std::string densities = "\"float density\" [";
    for (const glm::dvec3& random : random_colors(4))
        densities += fmt::format(" {}", random.x);
    const std::string lights = "LightSource \"distant\" \"rgb L\" [ 3 3 3 ] \"point3 from\" [ 1 2 3 ] LightSource "
                               "\"infinite\" \"rgb L\" [ .2 .3 .4 ]\n",
                      place = " \"point3 p0\" [ -1 -1 4 ] \"point3 p1\" [ 1 1 6 ] \"float g\" .3";
    const auto picture = [&](const std::string& medium) {
        Scene scene = world_of(lights + medium);
        scene.picture.width = 16;
        scene.picture.height = 12;
        scene.settings.spp = 1024;
        return scene;
    };
    std::string uniform =
        rgb_medium(densities +
                   fmt::format(" ] \"rgb sigma_a\" [ {} {} {} ] \"rgb sigma_s\" [ {} {} {} ]", absorbed.x, absorbed.y,
                               absorbed.z, scattered.x, scattered.y, scattered.z) +
                   place);
    uniform.replace(uniform.find("rgbgrid"), 7, "uniformgrid");
    Scene one = picture(uniform);
    REQUIRE(one.volumes.size() == 1);
    GridFile& file = std::get<GridFile>(one.volumes.front().shape); // the reference reads files alone
    const std::filesystem::path there = directory.path / file.path;
    std::ofstream(there, std::ios::binary) << nvdb_file_of(*file.memory);
    file = {there, file.grid, {}};
    const Film reference = render_reference(one, 2);
    for (const bool is_even : {false, true}) {
        Colors a = multiples_of(absorbed, 4), s = multiples_of(scattered, 4);
        if (!is_even) {
            a[3].x *= 1.0001;
            s[5].z *= 1.0001;
        }
        const Scene many = picture(rgb_medium(parameter("sigma_a", a) + parameter("sigma_s", s) + place));
        CHECK(many.volumes.size() == (is_even ? 2 : 6));
        CHECK_AGREEMENT(agree(render_here(many, 1).film, reference, is_even ? "two media" : "six media"));
    }
}

TEST_CASE("wrong colours in voxels are refused with their place", "[cpu][pbrt]") {
    CHECK_THROWS_WITH(world_of(huge_medium()), Contains("has 1 colours; expected nx ny nz = 68719476736"));
    const auto refused = [](const std::string& parameters, const std::string& reason) {
        CAPTURE(parameters);
        CHECK_THROWS_WITH(world_of(rgb_medium(parameters)), Contains(reason) && Contains("s.pbrt:"));
    };
    refused("", "expected one of them");
    refused("\"rgb sigma_s\" [ 1 1 1 ]", "\"sigma_s\" has 1 colours; expected nx ny nz = 12");
    refused("\"rgb sigma_s\" [ 1 1 ]", "red, green and blue of each voxel");
    refused("\"float sigma_s\" [ 1 1 1 ]", "red, green and blue of each voxel");
    refused(parameter("sigma_s", Colors(voxels, glm::dvec3(-1.0))), "has -1 among its values");
    refused(parameter("sigma_s", random_colors(1)) + parameter("Le", random_colors(2)), "\"Le\" without \"sigma_a\"");
}
