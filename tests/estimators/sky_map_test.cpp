// Maps of the sky: what they show, and how directions are drawn from them.
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "alias_table.h"
#include "kernels/test_items.h"
#include "light_table.h"
#include "sky_map.spv.h"
#include "support/kernel_runner.h"
#include "support/scenes.h"
#include "support/statistics.h"
#include "tests/reference/lights.h"
#include "tests/reference/phase.h"

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

// Look-ups in directions of which as many fall into every texel of the maps here, and as many draws.
Looks look(const SkyMap& sky, double rotation) {
    Scene scene;
    SkyLight light;
    light.rotation = rotation;
    scene.lights = {light};
    Assets assets;
    assets.sky = sky;
    const LightTable table = make_light_table(scene, assets, glm::dvec3(0.0), 1.0);
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
    looks.outputs = KernelRunner(sky_map_spv, {}, kernel).run<shared::SkyOutput>(looks.inputs);
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
// radiance changes by what differs between two texels.
TEST_CASE("a map of the sky shows what the reference sees in it", "[gpu][lights]") {
    for (const double rotation : {0.0, 75.0, -200.0}) {
        const SkyLight authored = [&] {
            SkyLight light = write_sky(sunset_map());
            light.rotation = rotation;
            return light;
        }();
        const auto sky = reference::load_sky({authored});
        const Looks looks = look(make_sky(sunset_map(), Rgb(1.0)), rotation);
        for (std::size_t i = 0; i < looks.inputs.size(); ++i) {
            const Rgb expected = sky->radiance(glm::normalize(glm::dvec3(looks.inputs[i].direction)));
            CAPTURE(rotation, i, looks.outputs[i].given_radiance.x, expected.x);
            REQUIRE(glm::distance(Rgb(looks.outputs[i].given_radiance), expected) < 9.8 * 24 * 4096 * 0x1p-23);
        }
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
}

TEST_CASE("the density found in a direction is that with which it was drawn", "[gpu][lights]") {
    const Looks looks = look(make_sky(sunset_map(), Rgb(1.0)), 20.0);
    int beyond = 0; // rounding carries some into the next texel
    for (const shared::SkyOutput& o : looks.outputs)
        beyond += std::abs(o.pdf_there - o.pdf) > 2e-3f * o.pdf ? 1 : 0;
    CHECK(beyond < 1 << 7);
}
