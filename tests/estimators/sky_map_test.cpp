// Maps of the sky: what they show, and how directions are drawn from them.
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <numbers>

#include "alias_table.h"
#include "kernels/test_items.h"
#include "light_table.h"
#include "sky_map.spv.h"
#include "support/kernel_runner.h"
#include "support/scenes.h"
#include "support/statistics.h"
#include "tests/reference/phase.h"
#include "tests/reference/reference_lights.h"

using namespace vkvol;
using std::numbers::pi;

namespace {

// A sun of one texel, a hundred thousand times as bright as what is around, near the zenith or not.
RadianceMap sun_map(int row) {
    return make_map(24, 12,
                    [row](int x, int y) { return x == 5 && y == row ? Rgb(1e5, 8e4, 5e4) : Rgb(0.3, 0.5, 1.0); });
}

RadianceMap half_dark() {
    return make_map(8, 6, [](int x, int y) { return x < 3 && y < 2 ? Rgb(1.0, 2.0, 3.0) : Rgb(0.0); });
}

struct Looks {
    std::vector<shared::SkyInput> inputs;
    std::vector<shared::SkyOutput> outputs;
    std::vector<double> angles; // solid, of which the inputs' directions are the middles; together the sphere
};

// The same in a square.
RadianceMap square_sun(int column, int row) {
    return make_map(12, 12,
                    [=](int x, int y) { return x == column && y == row ? Rgb(1e5, 8e4, 5e4) : Rgb(0.3, 0.5, 1.0); });
}

// Look-ups in directions of which as many fall into every texel of the equirectangular maps here, and as many draws.
Looks look(const SkyMap& sky, double rotation, SkyMapping mapping = SkyMapping::equirectangular) {
    Scene scene;
    SkyLight light;
    light.rotation = rotation;
    light.mapping = mapping;
    scene.lights = {light};
    Assets assets;
    assets.sky = std::make_shared<const SkyMap>(sky);
    const LightTable table = make_light_table(scene, assets, SurfaceTable{}, glm::dvec3(0.0), 1.0);
    KernelScene kernel;
    kernel.frame.sky = make_sky_params(scene, assets);
    kernel.frame.seed = 7;
    kernel.lights = &table;
    kernel.sky = &sky;
    Looks looks;
    constexpr int columns = 480, rows = 264;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const double latitude = pi * (row + 0.5) / rows, longitude = 2.0 * pi * (column + 0.5) / columns;
            looks.inputs.push_back({static_cast<std::uint32_t>(looks.inputs.size()),
                                    {std::sin(latitude) * std::sin(longitude), std::cos(latitude),
                                     -std::sin(latitude) * std::cos(longitude)}});
            looks.angles.push_back(2.0 * pi / columns * (std::cos(pi * row / rows) - std::cos(pi * (row + 1) / rows)));
        }
    Specialization constants{};
    constants[SPEC_LIGHTS] = lights_kind(scene);
    looks.outputs = KernelRunner(sky_map_spv, constants, kernel).run<shared::SkyOutput>(looks.inputs);
    return looks;
}

} // namespace

TEST_CASE("an alias table draws in proportion", "[cpu][lights]") {
    const std::vector<double> weights = {0.0, 1.0, 3.0, 1e-6, 0.5, 7.25, 0.0};
    const std::vector<shared::AliasEntry> table = make_alias_table(weights);
    std::vector<double> chances(weights.size(), 0.0);
    double sum = 0.0;
    for (std::size_t i = 0; i < table.size(); ++i) {
        const double own = table[i].other == i ? 1.0 : table[i].keep * 0x1p-32;
        chances[i] += own / double(table.size());
        chances[table[i].other] += (1.0 - own) / double(table.size());
        sum += weights[i];
    }
    for (std::size_t i = 0; i < table.size(); ++i)
        CHECK(chances[i] == Approx(weights[i] / sum).margin(1e-9));
}

// The device's longitude and latitude are off by 4096 ulp at most, as Vulkan lets atan be: a texel spans 2 pi / 24, and
// radiance changes by what differs between two texels. A quarter of a square's diamond is a quarter of a turn, too.
TEST_CASE("a map of the sky shows what the reference sees in it", "[gpu][lights]") {
    for (const SkyMapping mapping : {SkyMapping::equirectangular, SkyMapping::equal_area})
        for (const double rotation : {0.0, 75.0, -200.0}) {
            const RadianceMap map = mapping == SkyMapping::equal_area ? square_map() : sunset_map();
            SkyLight authored = write_sky(map, mapping);
            authored.rotation = rotation;
            const auto sky = reference::load_sky({authored});
            const Looks looks = look(make_sky(map, Rgb(1.0), mapping), rotation, mapping);
            for (std::size_t i = 0; i < looks.inputs.size(); ++i) {
                const Rgb expected = sky->radiance(glm::normalize(glm::dvec3(looks.inputs[i].direction)));
                CAPTURE(rotation, i, looks.outputs[i].given_radiance.x, expected.x);
                REQUIRE(glm::distance(Rgb(looks.outputs[i].given_radiance), expected) < 9.8 * 24 * 4096 * 0x1p-23);
            }
        }
}

// In pbrt's formulas, of whose maps z is upwards, and which its left-handed coordinates turn about: (x, y, z) is
// (x, z, y) here.
TEST_CASE("the middle of a square map is the zenith, -z is above it and +x to its right", "[cpu][lights]") {
    const auto place = [](const glm::dvec3& world) { return reference::equal_area_place({world.x, world.z, world.y}); };
    CHECK(place({0, 1, 0}) == glm::dvec2(0.5, 0.5));
    CHECK(glm::distance(place({0, 0, -1}), glm::dvec2(0.5, 0.0)) < 1e-12);
    CHECK(glm::distance(place({1, 0, 0}), glm::dvec2(1.0, 0.5)) < 1e-12);
    CHECK(glm::distance(place({0, 0, 1}), glm::dvec2(0.5, 1.0)) < 1e-12);
    CHECK(glm::distance(place({-1e-9, -1, 1e-9}), glm::dvec2(0.0, 1.0)) < 1e-8);
    CHECK(glm::distance(place(glm::normalize(glm::dvec3(1, 0, -1))), glm::dvec2(0.75, 0.25)) < 1e-12);
}

// A step of 1e-4 of the square spans a parallelogram of that much of the sphere, but for the step's square; not across
// the lines on which the mapping has a kink.
TEST_CASE("the reference's squares have equal areas", "[cpu][lights]") {
    for (int j = 0; j < 40; ++j)
        for (int i = 0; i < 40; ++i) {
            const glm::dvec2 at((i + 0.37) / 40.0, (j + 0.61) / 40.0);
            const double h = 1e-4;
            const auto direction = [&](double x, double y) {
                return reference::equal_area_direction(at + glm::dvec2(x, y));
            };
            const double area =
                glm::length(glm::cross(direction(h, 0) - direction(-h, 0), direction(0, h) - direction(0, -h)));
            CAPTURE(i, j);
            REQUIRE(area == Approx(4.0 * pi * 4.0 * h * h).epsilon(1e-4));
            REQUIRE(glm::distance(reference::equal_area_place(direction(0, 0)), at) < 1e-12);
        }
}

// Length that no texel's side exceeds in a map of n x n: the mapping stretches by less than 2 anywhere (most at the
// middles of the square's edges, by 1.73).
double longest_side(int n) {
    return 2.0 * std::sqrt(4.0 * pi) / n;
}

// As pbrt's imgtool makes a square map of an equirectangular one: longitude there begins at x, and turns towards y.
// Between four texels, with weights, the mean distance from them is at most their diagonal's half; and this radiance
// changes by what a direction does.
TEST_CASE("a square map made of another shows the same sky, a quarter of a turn on", "[gpu][lights]") {
    const auto file = [](double u, double v) { // of an equirectangular map
        const double latitude = pi * v, longitude = 2.0 * pi * u;
        return Rgb(2.0 + std::sin(latitude) * std::cos(longitude), 2.0 + std::sin(latitude) * std::sin(longitude),
                   2.0 + std::cos(latitude));
    };
    const RadianceMap flat = make_map(256, 128, [&](int x, int y) { return file((x + 0.5) / 256, (y + 0.5) / 128); });
    const RadianceMap square = make_map(128, 128, [&](int x, int y) {
        const glm::dvec3 d = reference::equal_area_direction((glm::dvec2(x, y) + 0.5) / 128.0);
        const double turns = std::atan2(d.y, d.x) / (2.0 * pi);
        return file(turns - std::floor(turns), std::acos(d.z) / pi);
    });
    const Looks a = look(make_sky(flat, Rgb(1.0)), 30.0);
    const Looks b = look(make_sky(square, Rgb(1.0), SkyMapping::equal_area), 30.0 - 90.0, SkyMapping::equal_area);
    double most = 0.0;
    for (std::size_t i = 0; i < a.outputs.size(); ++i)
        most = std::max(most, double(glm::distance(a.outputs[i].given_radiance, b.outputs[i].given_radiance)));
    CHECK(most < (longest_side(128) + pi / 128.0) / std::sqrt(2.0));
}

// By the same sines and arcs as above.
TEST_CASE("the place of a direction is where that direction is", "[gpu][lights]") {
    for (const SkyMapping mapping : {SkyMapping::equirectangular, SkyMapping::equal_area})
        for (const double rotation : {0.0, 20.0}) {
            const Looks looks =
                look(make_sky(make_map(8, 8, [](int, int) { return Rgb(1.0); }), Rgb(1.0), mapping), rotation, mapping);
            for (std::size_t i = 0; i < looks.inputs.size(); ++i) {
                CAPTURE(rotation, i);
                REQUIRE(glm::distance(looks.outputs[i].given_again, looks.inputs[i].direction) <
                        2.0 * pi * 4096 * 0x1p-23);
            }
        }
}

// A furnace without noise: where all texels are alike every direction has the same density, and is worth the same.
TEST_CASE("every look at a square map of ones finds all of its light", "[gpu][lights]") {
    const RadianceMap ones = make_map(9, 9, [](int, int) { return Rgb(1.0); });
    const Looks looks = look(make_sky(ones, Rgb(1.0), SkyMapping::equal_area), 10.0, SkyMapping::equal_area);
    for (const shared::SkyOutput& o : looks.outputs) {
        REQUIRE(o.light.x / o.pdf == Approx(4.0 * pi).epsilon(1e-6));
        REQUIRE(o.given_pdf == Approx(1.0 / (4.0 * pi)).epsilon(1e-6));
    }
}

// Radiance 2 + d.a for some axis a: its integral is 8 pi, that of it times d is 4 pi a / 3. What is interpolated is off
// as above. Integrals are off by the square of that, and more only in texels that the horizon crosses, where slopes
// jump: two of n.
TEST_CASE("looks at a square map find a known gradient", "[gpu][lights]") {
    const glm::dvec3 axis = glm::normalize(glm::dvec3(0.3, 0.8, -0.5));
    constexpr int n = 256;
    const RadianceMap map = make_map(n, n, [&](int x, int y) {
        const glm::dvec3 d = reference::equal_area_direction((glm::dvec2(x, y) + 0.5) / double(n));
        return Rgb(2.0 + glm::dot(glm::dvec3(d.x, d.z, d.y), axis));
    });
    const SkyMap sky = make_sky(map, Rgb(1.0), SkyMapping::equal_area);
    const double h = longest_side(n), off = 4.0 * pi * (h * h + h * 2.0 / n);
    CHECK(std::abs(sky.fluence.x - 8.0 * pi) < off);
    const Looks looks = look(sky, 0.0, SkyMapping::equal_area);
    RunningMean all, along[3];
    for (std::size_t i = 0; i < looks.outputs.size(); ++i) {
        const shared::SkyOutput& o = looks.outputs[i];
        REQUIRE(std::abs(o.given_radiance.x - 2.0 - glm::dot(glm::dvec3(looks.inputs[i].direction), axis)) <
                h / std::sqrt(2.0));
        all.add(o.light.x / o.pdf);
        for (const int c : {0, 1, 2})
            along[c].add(o.light.x / o.pdf * o.direction[c]);
    }
    CHECK(std::abs(all.mean() - 8.0 * pi) < 4.0 * all.standard_error() + off);
    for (const int c : {0, 1, 2}) {
        CAPTURE(c, along[c].mean(), along[c].standard_error());
        CHECK(std::abs(along[c].mean() - 4.0 * pi / 3.0 * axis[c]) < 4.0 * along[c].standard_error() + off);
    }
}

TEST_CASE("directions are drawn from a map with the density that it states", "[gpu][lights]") {
    const auto [name, map] = GENERATE(table<std::string, RadianceMap>({{"sunset", sunset_map()},
                                                                       {"sun", sun_map(4)},
                                                                       {"sun at the zenith", sun_map(0)},
                                                                       {"sun at the nadir", sun_map(11)},
                                                                       {"dark half", half_dark()}}));
    CAPTURE(name);
    const SkyMap sky = make_sky(map, Rgb(1.0));
    const Looks looks = look(sky, 45.0); // whole texels of all maps
    const double count = double(looks.outputs.size());
    RunningMean light;
    double total = 0.0, fluence = 0.0;
    constexpr int bins = 12;
    std::vector<double> observed(bins * bins, 0.0), expected(bins * bins, 0.0);
    const auto bin = [&](const glm::vec3& d) { // whole rows and columns of the grid
        const double turn = std::atan2(double(d.x), double(d.z)) / (2.0 * pi) + 0.5;
        const double latitude = std::atan2(std::hypot(double(d.x), double(d.z)), double(d.y)) / pi;
        return std::min(int(latitude * bins), bins - 1) * bins + std::min(int(turn * bins), bins - 1);
    };
    for (std::size_t i = 0; i < looks.outputs.size(); ++i) {
        const shared::SkyOutput& o = looks.outputs[i];
        REQUIRE(std::abs(glm::length(o.direction) - 1.0f) < 1e-5f);
        REQUIRE(o.pdf > 0.0f);
        light.add(double(o.light.x) / o.pdf);
        total += looks.angles[i] * o.given_pdf;
        fluence += looks.angles[i] * o.given_radiance.x;
        observed[bin(o.direction)] += 1.0;
        expected[bin(looks.inputs[i].direction)] += count * looks.angles[i] * o.given_pdf;
    }
    // A texel's density is a constant over the sine, so that a cell of h = pi / 264 rows has it but for h^2 / 24 = 6e-6
    // of it; the rest is rounding.
    CHECK(total == Approx(1.0).epsilon(1e-4));
    CAPTURE(light.mean(), light.standard_error(), fluence);
    // Radiance is linear in a cell, whose middle misses its slope times h^2 / 12 of the cotangent: 1e-3 of a sun at the
    // pole.
    CHECK(std::abs(light.mean() - fluence) < 4.0 * light.standard_error() + 0.001 * fluence);
    // The bins' counts are Poisson, of a mean that the grid knows as well as the total.
    double z = 0.0;
    for (int b = 0; b < bins * bins; ++b)
        z = std::max(z, std::abs(observed[b] - expected[b]) / std::sqrt(std::max(expected[b], 5.0)));
    CHECK(z < 4.5);
}

// Binned by the texels themselves, over each of which the density is a constant; and what is interpolated has the
// texels' sum as its integral, since each gives as much to others as it takes. Rounding carries few over a texel's
// edge.
TEST_CASE("directions are drawn from a square map with the density that it states", "[gpu][lights]") {
    const auto [name, map] = GENERATE(table<std::string, RadianceMap>({{"square", square_map()},
                                                                       {"sun at the zenith", square_sun(5, 6)},
                                                                       {"sun at the horizon", square_sun(9, 8)},
                                                                       {"sun at an edge", square_sun(8, 11)},
                                                                       {"sun at the nadir", square_sun(0, 0)}}));
    CAPTURE(name);
    const SkyMap sky = make_sky(map, Rgb(1.0), SkyMapping::equal_area);
    const Looks looks = look(sky, 0.0, SkyMapping::equal_area);
    const auto texel = [&](const glm::vec3& direction) {
        const glm::dvec3 d = glm::normalize(glm::dvec3(direction));
        const glm::dvec2 place = reference::equal_area_place({d.x, d.z, d.y}) * double(map.width);
        return std::min(std::size_t(place.y), std::size_t(map.width - 1)) * map.width +
               std::min(std::size_t(place.x), std::size_t(map.width - 1));
    };
    const double angle = 4.0 * pi / double(sky.texels.size());
    std::vector<double> observed(sky.texels.size(), 0.0), expected;
    double total = 0.0;
    for (const glm::vec4& entry : sky.texels) {
        expected.push_back(entry.w * angle * double(looks.outputs.size()));
        total += entry.w * angle;
    }
    RunningMean light;
    int beyond = 0;
    for (std::size_t i = 0; i < looks.outputs.size(); ++i) {
        const shared::SkyOutput& o = looks.outputs[i];
        const std::size_t at = texel(o.direction);
        beyond += o.pdf != sky.texels[at].w || o.given_pdf != sky.texels[texel(looks.inputs[i].direction)].w ? 1 : 0;
        observed[at] += 1.0;
        light.add(double(o.light.x) / o.pdf);
    }
    CHECK(beyond < 1 << 7);
    CHECK(total == Approx(1.0).epsilon(1e-6));
    CHECK(chi_square_test_p(observed, expected) > 1e-4);
    CAPTURE(light.mean(), light.standard_error(), sky.fluence.x);
    CHECK(t_test_p(light, sky.fluence.x) > 1e-4);
}

// A texel that touches a bright one with its corner has a 64th of that as its mean, and a quarter there: 16 times its
// share. In a polar row the sine is up to twice its mean.
TEST_CASE("no direction drawn from a map is worth much more than another", "[gpu][lights]") {
    for (const int row : {0, 4, 11}) {
        const Looks looks = look(make_sky(sun_map(row), Rgb(1.0)), 0.0);
        double most = 0.0;
        RunningMean mean;
        for (const shared::SkyOutput& o : looks.outputs) {
            const double value = (o.light.x + o.light.y + o.light.z) / o.pdf;
            mean.add(value);
            most = std::max(most, value);
        }
        CAPTURE(row, most, mean.mean());
        CHECK(most < (row == 4 ? 17.0 : 33.0) * mean.mean());
    }
    const auto square = SkyMapping::equal_area;
    for (const shared::SkyOutput& o : look(make_sky(square_sun(8, 11), Rgb(1.0), square), 0.0, square).outputs)
        REQUIRE(o.light.x / o.pdf < 17.0 * make_sky(square_sun(8, 11), Rgb(1.0), square).fluence.x);
}

TEST_CASE("the density found in a direction is that with which it was drawn", "[gpu][lights]") {
    const Looks looks = look(make_sky(sunset_map(), Rgb(1.0)), 20.0);
    int beyond = 0; // rounding carries some into the next texel
    for (const shared::SkyOutput& o : looks.outputs)
        beyond += std::abs(o.pdf_there - o.pdf) > 2e-3f * o.pdf ? 1 : 0;
    CHECK(beyond < 1 << 7);
}

TEST_CASE("a map of the sky is read again where its file or what is made of it changed, and else not",
          "[cpu][lights]") {
    SkyCache skies;
    SkyLight light = write_sky(sun_map(2));
    const auto first = skies.take(light);
    light.rotation = 30.0; // which its light table has
    CHECK(skies.take(light) == first);
    light.scale = Rgb(2.0);
    const auto twice = skies.take(light);
    CHECK(twice->texels.front().x == Approx(2.0 * first->texels.front().x));
    light.mirror = true;
    CHECK(skies.take(light)->texels != twice->texels);
    const SkyLight other = write_sky(half_dark());
    std::filesystem::copy_file(other.file, light.file, std::filesystem::copy_options::overwrite_existing);
    CHECK(skies.take(light)->width == 8);
    light.daylight = Daylight{};
    const auto day = skies.take(light);
    CHECK(skies.take(light) == day);
    light.daylight->turbidity = 5.0;
    CHECK(skies.take(light) != day);
}
