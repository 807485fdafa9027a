// The choice of a light: what the kernels draw, against the chances they state.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numbers>

#include "kernels/test_items.h"
#include "light_table.h"
#include "lights.spv.h"
#include "shared/constants.h"
#include "support/kernel_runner.h"
#include "support/statistics.h"
#include "tests/reference/reference_lights.h"
#include "tests/reference/rng.h"

using namespace vkvol;

namespace {

double uniform(std::uint32_t i, std::uint32_t which) {
    return reference::pcg4d({i, which, 3, 4})[0] * 0x1p-32;
}

// Points in a cube, of powers over three decades, a sphere, a spot and a directional light.
std::vector<Light> many_lights(int points) {
    std::vector<Light> lights;
    for (int i = 0; i < points; ++i) {
        const auto at = [&](std::uint32_t which) { return 20.0 * uniform(std::uint32_t(i), which) - 10.0; };
        lights.push_back(PointLight{{at(0), at(1), at(2)}, Rgb(std::pow(10.0, 3.0 * uniform(std::uint32_t(i), 3)))});
    }
    for (int i = 0; i < points / 4; ++i) { // aimed
        const auto at = [&](std::uint32_t which) { return 20.0 * uniform(std::uint32_t(i), which) - 10.0; };
        const glm::dvec3 position(at(4), at(5), at(6)), axis = glm::normalize(glm::dvec3(at(7), at(8), at(9)));
        if (i % 2 == 0)
            lights.push_back(SpotLight{position, axis, Rgb(30.0), 10.0 + 170.0 * uniform(std::uint32_t(i), 10), 0.5});
        else
            lights.push_back(DiskLight{position, axis, 0.3, Rgb(50.0)});
    }
    lights.push_back(SphereLight{{1.0, 2.0, 3.0}, 0.5, Rgb(30.0)});
    lights.push_back(SpotLight{{-3.0, 4.0, 0.0}, {0.0, -1.0, 0.0}, Rgb(100.0), 60.0, 0.5});
    lights.push_back(DirectionalLight{{0.0, 1.0, 0.0}, Rgb(2.0)});
    return lights;
}

std::vector<shared::LookOutput> look(const std::vector<Light>& lights, const glm::vec3& from, std::uint32_t count,
                                     bool on_surface = false, const glm::vec3& normal = glm::vec3(0.0f)) {
    Scene scene;
    scene.lights = lights;
    scene.surfaces.resize(on_surface ? 1 : 0);
    const LightTable table = make_light_table(scene, Assets{}, SurfaceTable{}, glm::dvec3(0.0), 60.0);
    KernelScene kernel;
    kernel.frame.choices = table.choices;
    kernel.frame.sky_count = table.sky_count;
    kernel.frame.lamp_first = table.lamp_first;
    kernel.frame.lamp_count = table.lamp_count;
    kernel.lights = &table;
    Specialization constants{};
    constants[SPEC_LIGHTS] = lights_kind(scene);
    constants[SPEC_SCATTERING] = SCATTERING_MULTIPLE;
    constants[SPEC_NEE] = NEE_COLLISIONS;
    std::vector<shared::LookInput> inputs;
    for (std::uint32_t i = 0; i < count; ++i)
        inputs.push_back({i, from, on_surface ? 1u : 0u, normal});
    return KernelRunner(lights_spv, constants, kernel).run<shared::LookOutput>(inputs);
}

} // namespace

TEST_CASE("lights are chosen with the chances that are stated", "[gpu][lights]") {
    constexpr std::uint32_t count = 1 << 18;
    for (const int points : {0, 1, 7, 1000})
        for (const glm::vec3 from : {glm::vec3(0.0f), glm::vec3(9.0f, -9.0f, 9.0f), glm::vec3(60.0f, 0.0f, 0.0f)}) {
            std::map<std::uint32_t, double> observed, chance;
            for (const shared::LookOutput& o : look(many_lights(points), from, count, points == 1000)) {
                observed[o.index] += 1.0;
                const auto [found, is_new] = chance.emplace(o.index, o.chance);
                REQUIRE(found->second == o.chance); // the same whenever it is drawn
            }
            std::vector<double> counts, expected;
            double total = 0.0;
            for (const auto& [index, p] : chance) {
                counts.push_back(observed[index]);
                expected.push_back(p * count);
                total += p;
            }
            // What was never drawn has little chance: the rest, as one more bin.
            counts.push_back(0.0);
            expected.push_back((1.0 - total) * count);
            CAPTURE(points, from.x, total);
            CHECK(total < 1.0 + 1e-5);
            CHECK(chi_square_test_p(counts, expected) > 1e-4);
        }
}

// From anywhere, the mean over looks of light / chance is the sum over all lights: here 1 / distance^2 by hand.
TEST_CASE("looks at a thousand lights find the light of all", "[gpu][lights]") {
    const std::vector<Light> all = many_lights(1000), lights(all.begin(), all.begin() + 1000);
    for (const glm::dvec3 from : {glm::dvec3(0.5, 0.2, 0.1), glm::dvec3(-9.0, 4.0, 8.0), glm::dvec3(30.0, 0.0, 0.0)}) {
        double expected = 0.0, squares = 0.0;
        for (const Light& light : lights) {
            const auto& point = std::get<PointLight>(light);
            const glm::dvec3 apart = point.position - from;
            const double given = point.intensity.x / glm::dot(apart, apart);
            expected += given;
            squares += given * given;
        }
        RunningMean mean;
        for (const shared::LookOutput& o : look(lights, glm::vec3(from), 1 << 17))
            mean.add(o.light.x);
        CAPTURE(from.x, mean.mean(), mean.standard_error(), expected);
        CHECK(t_test_p(mean, expected) > 1e-4);
        const double of_an_even_choice = 1000.0 * squares - expected * expected;
        CHECK(mean.variance() < of_an_even_choice / 5.0);
    }
}

// Likewise of lamps that shine into halves and cones of all directions, where there are surfaces: no light is lost
// beside the cones of the tree's nodes, and less is looked for where there is none.
TEST_CASE("looks from a surface at a thousand lamps find the light of all that shine there", "[gpu][lights]") {
    std::vector<Light> lights;
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const auto at = [&](std::uint32_t which) { return 20.0 * uniform(i, which) - 10.0; };
        const glm::dvec3 position(at(4), at(5), at(6)), axis = glm::normalize(glm::dvec3(at(7), at(8), at(9)));
        if (i % 2 == 0)
            lights.push_back(SpotLight{position, axis, Rgb(30.0), 10.0 + 170.0 * uniform(i, 10), uniform(i, 11)});
        else
            lights.push_back(DiskLight{position, axis, 0.02, Rgb(3e4)});
    }
    for (const glm::dvec3 from : {glm::dvec3(0.5, 0.2, 0.1), glm::dvec3(-9.0, 4.0, 8.0), glm::dvec3(30.0, 0.0, 0.0)}) {
        double expected = 0.0; // lamps are so small that four of their points are enough
        for (const Light& light : lights)
            for (const double u : {0.25, 0.75})
                for (const double v : {0.25, 0.75})
                    if (const auto toward = reference::towards(light, from, u, v))
                        expected += 0.25 * toward->light.x;
        std::array<RunningMean, 2> means;
        for (const bool on_surface : {false, true}) {
            for (const shared::LookOutput& o : look(lights, glm::vec3(from), 1 << 17, on_surface))
                means[on_surface].add(o.light.x);
            CAPTURE(from.x, on_surface, means[on_surface].mean(), means[on_surface].standard_error(), expected);
            CHECK(t_test_p(means[on_surface], expected) > 1e-4);
        }
        CHECK(means[1].variance() < 0.7 * means[0].variance());
    }
}

// A floor's light comes from before it: by how high they stand above it, lamps are chosen; those behind it, nearer and
// brighter as they may be, take few looks; and none before it is lost, also of those beside the floor's own plane.
TEST_CASE("a surface looks at the lamps before it", "[gpu][lights]") {
    std::vector<Light> lights;
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const auto at = [&](std::uint32_t which) { return uniform(i, which); };
        const bool is_above = i % 10 == 0;
        const glm::dvec3 position(20.0 * at(4) - 10.0, is_above ? 10.0 * at(5) : -2.0 * at(5), 20.0 * at(6) - 10.0);
        lights.push_back(PointLight{position, Rgb(is_above ? 1.0 : 30.0)});
    }
    const glm::dvec3 up(0.0, 1.0, 0.0);
    // Variances over the mean's square: 2.4, 7.3 and 2.0; by the boxes' tops alone 3.4, 9.9 and 3.0.
    const std::vector<std::pair<glm::dvec3, double>> at_most = {
        {{0.5, 0.0, 0.1}, 2.8}, {{-9.0, 0.0, 8.0}, 8.4}, {{30.0, 0.0, 0.0}, 2.4}};
    for (const auto& [from, bound] : at_most) {
        const auto lit = [&](const glm::dvec3& direction) { return std::max(glm::dot(direction, up), 0.0); };
        double expected = 0.0;
        for (const Light& light : lights) {
            const auto& point = std::get<PointLight>(light);
            const glm::dvec3 apart = point.position - from;
            expected += point.intensity.x / glm::dot(apart, apart) * lit(glm::normalize(apart));
        }
        std::array<RunningMean, 2> means;
        for (const bool knows : {false, true}) {
            for (const shared::LookOutput& o :
                 look(lights, glm::vec3(from), 1 << 17, true, glm::vec3(knows ? up : glm::dvec3(0.0))))
                means[knows].add(o.light.x * lit(o.direction));
            CAPTURE(from.x, knows, means[knows].mean(), means[knows].standard_error(), expected);
            CHECK(t_test_p(means[knows], expected) > 1e-4);
        }
        CHECK(means[1].variance() < bound * expected * expected);
        CHECK(means[1].variance() < 0.05 * means[0].variance());
    }
}

// By midpoints of the angle from the middle: of a square root that ends at the rim, they miss some steps^-1.5 = 4e-7.
TEST_CASE("a sun gives the irradiance that was authored, however dark its limb", "[cpu][lights]") {
    constexpr double pi = std::numbers::pi;
    constexpr int steps = 20000;
    for (const double angle : {0.53, 60.0, 180.0})
        for (const double darkening : {0.0, 0.6, 1.0}) {
            const SunLight sun{{0.0, 1.0, 0.0}, {2.0, 1.0, 0.5}, angle, darkening};
            const double rim = 0.5 * angle * pi / 180.0;
            double irradiance = 0.0, of_reference = 0.0;
            for (int i = 0; i < steps; ++i) {
                const double at = rim * (i + 0.5) / steps;
                const double mu = std::cos(std::asin(std::sin(at) / std::sin(rim)));
                const double facing = 2.0 * pi * std::sin(at) * std::cos(at) * rim / steps;
                irradiance += facing * peak_radiance(sun).x * (1.0 - darkening * (1.0 - mu));
                of_reference += facing * reference::disc_radiance(sun, {std::sin(at), std::cos(at), 0.0}).x;
            }
            CAPTURE(angle, darkening);
            CHECK(irradiance == Approx(2.0).epsilon(1e-6));
            CHECK(of_reference == Approx(2.0).epsilon(1e-6));
        }
}

// Single precision keeps a direction's place on the disc within 2^-22, or `off` of its radius. The reference is asked
// twice as far inwards, lest it be asked beyond the rim; so s, a square, is off by 6 `off`, and where it is 1 mu =
// sqrt(1 - s) by the root of that.
TEST_CASE("a look at a sun finds what the reference sees there", "[gpu][lights]") {
    const glm::dvec3 middle = glm::normalize(glm::dvec3(1.0, 2.0, 0.5));
    for (const double angle : {0.53, 60.0, 180.0})
        for (const double darkening : {0.0, 0.6, 1.0}) {
            const SunLight sun{middle, {2.0, 1.0, 0.5}, angle, darkening};
            const double off = 0x1p-22 / std::sin(0.5 * angle * std::numbers::pi / 180.0);
            const double most = peak_radiance(sun).x * (darkening * std::sqrt(6.0 * off) + 1e-5);
            RunningMean irradiance;
            for (const shared::LookOutput& o : look({sun}, glm::vec3(0.0f), 1 << 14)) {
                const glm::dvec3 direction = glm::normalize(glm::dvec3(o.direction));
                irradiance.add(o.light.x * glm::dot(direction, middle));
                const glm::dvec3 asked = glm::normalize(glm::mix(direction, middle, 2.0 * off));
                REQUIRE(std::abs(double(o.light.x) * o.pdf - reference::disc_radiance(sun, asked).x) < most);
            }
            CAPTURE(angle, darkening, irradiance.mean(), irradiance.standard_error());
            // Toward a small even disc all looks are alike, but for rounding.
            CHECK(std::abs(irradiance.mean() - 2.0) < 4.0 * irradiance.standard_error() + 1e-5);
        }
}
