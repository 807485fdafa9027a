// What bounds a domain: a ground by a map, and mirrors that make an eighth of a scene the whole.
#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "camera_view.h"
#include "shared/constants.h"
#include "shared/estimators.h"
#include "support/agreement.h"
#include "support/images.h"
#include "support/scenes.h"
#include "support/surface_scenes.h"
#include "support/thorough.h"

using namespace vkvol;

namespace {

const Rgb bright{0.9, 0.8, 0.7}, dark{0.1, 0.2, 0.05};

// A slab above y = 0 in a domain four across, and a sensor just above the ground that looks down on it, of a row of
// pixels: from afar stripes are one grey.
Scene slab_in_domain() {
    Scene scene;
    scene.volumes = {medium(Box{{0.0, 1.0, 0.0}, {4.0, 1.0, 4.0}}, 0.8, 0.9, 0.5)};
    scene.periodic = Periodic{{-2.0, 0.0, -2.0}, {2.0, 0.0, 2.0}};
    scene.lights = {DirectionalLight{glm::normalize(glm::dvec3(1.0, 1.5, 0.3)), {3.0, 2.0, 1.0}}};
    scene.camera.projection = Projection::irradiance;
    scene.camera.position = {0.0, 0.1, 0.0};
    look_along(scene.camera, {0.0, -1.0, 0.0}, {0.0, 0.0, 1.0});
    scene.camera.size = {4.0, 4.0};
    scene.picture = {8, 1, 0.0, 0.0, 8.0, 1.0};
    scene.settings.spp = 1 << 12;
    return scene;
}

// Stripes along z: bright from x = 0 to 1, dark to 2, and so on.
Surface striped_plane() {
    Surface plane;
    plane.shape = PlaneSurface{{0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
    plane.axes = glm::dmat3({1.0, 0.0, 0.0}, {0.0, 0.0, -1.0}, {0.0, 1.0, 0.0});
    plane.material.color = Rgb(1.0);
    plane.material.image = std::make_shared<const Texture>(Texture{2, 1, {glm::vec3(bright), glm::vec3(dark)}, true});
    plane.material.repeat = {0.5, 0.5};
    return plane;
}

std::vector<Surface> stripes() {
    std::vector<Surface> all;
    for (int i = -2; i < 2; ++i) {
        Surface& stripe = all.emplace_back();
        stripe.shape = RectangleSurface{{i + 0.5, 0.0, 0.0}, {0.5, 0.0, 0.0}, {0.0, 0.0, -2.0}};
        stripe.material.color = i % 2 == 0 ? bright : dark;
    }
    return all;
}

} // namespace

TEST_CASE("a ground by a map is the ground of its pieces where a domain repeats", "[gpu][periodic][surfaces]") {
    std::vector<Estimate> all;
    std::uint32_t seed = 0;
    for (const char* integrator : {"ratioTracking", "lightTracing"})
        for (const bool by_map : {true, false}) {
            Scene scene = slab_in_domain();
            scene.surfaces = by_map ? std::vector{striped_plane()} : stripes();
            scene.settings.integrator = integrator;
            all.push_back(
                {fmt::format("{}, {}", integrator, by_map ? "map" : "pieces"), render_here(scene, ++seed).film});
        }
    const PairwiseAgreement found = compare_all(all);
    CAPTURE(found.mean_pair, found.pixel_pair);
    CHECK(found.mean_z < z_limit(0.001, 3.0 * double(found.pairs)));
    CHECK(found.pixel_z < z_limit(0.001, double(found.tests)));
}

// Looks toward the sky end at mirrors, and flights that are thrown back find it.
TEST_CASE("an eighth between three mirrors is the whole", "[gpu][surfaces][lights][long]") {
    const auto symmetric = [](int column, int row) {
        const double up = std::abs(row - 7.5) / 7.5, across = std::abs((column + 16) % 16 - 7.5) / 7.5;
        return Rgb(0.3 + 2.0 * up, 0.5, 0.2 + across);
    };
    GridRecipe cloud{{-4, -4, -4}, {3, 3, 3}, [](glm::ivec3 voxel) { // of 8 parts alike
                         const glm::ivec3 v = glm::max(voxel, -1 - voxel);
                         return 0.1f + 0.3f * float((v.x + 2 * v.y + 3 * v.z) % 4);
                     }};
    cloud.linear = glm::dmat3(0.25);
    cloud.translation = glm::dvec3(0.125);
    for (const char* integrator : {"ratioTracking", "deltaTracking"}) {
        Scene whole =
            scene_of(medium(write_grid(cloud), 3.0, 0.9, 0.3), 2.4, 12, 4.0, glm::dvec3(0.0), {-35.0, 40.0, 0.0});
        for (int axis = 0; axis < 3; ++axis)
            REQUIRE(whole.camera.position[axis] > 0.0);
        whole.lights = {write_sky(make_map(32, 16, symmetric))};
        whole.settings.integrator = integrator;
        if (integrator == std::string("ratioTracking"))
            whole.settings.choices.mis = MIS_BALANCE; // else none looks toward a sky as even as this
        whole.settings.spp = 512;
        Scene eighth = whole;
        for (const glm::dvec3& normal :
             {glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(0.0, 1.0, 0.0), glm::dvec3(0.0, 0.0, 1.0)}) {
            Surface& mirror = eighth.surfaces.emplace_back();
            mirror.shape = PlaneSurface{{0.0, 0.0, 0.0}, normal};
            mirror.material = white(MaterialKind::mirror);
        }
        CHECK_AGREEMENT(agree(render_here(eighth, 1).film, render_here(whole, 2).film,
                              fmt::format("an eighth between mirrors, {}", integrator)));
    }
}

namespace {

struct ClosedCase {
    const char* name;
    Volume volume; // from y = 0 to 1
    double ground; // albedo
};

std::vector<ClosedCase> closed_cases() {
    const Box layer{{0.0, 0.5, 0.0}, {2.0, 1.0, 2.0}};
    Volume steep = medium(layer, 1.0, 0.9, 0.75);
    steep.layers = Layers{1, 0.0, 1.0, 0.0, 0.0};
    steep.map.points = {{0.0, 12.0}, {0.3, 3.0}, {0.3, 0.5}, {1.0, 0.1}};
    GridRecipe steps;
    steps.first = {-4, 0, -4};
    steps.last = {3, 7, 3};
    steps.linear = glm::dmat3(0.25, 0.0, 0.0, 0.0, 0.125, 0.0, 0.0, 0.0, 0.25);
    steps.translation = {0.125, 0.0625, 0.125};
    steps.value = [](glm::ivec3 voxel) { return voxel.x < 0 ? 1.0f : 9.0f; };
    Volume rayleigh = medium(layer, 0.3, 1.0);
    rayleigh.phase = PhaseFunction::rayleigh;
    return {{"a slab, no ground", medium(layer, 2.0, 0.8, 0.5), 0.0},
            {"Rayleigh's over snow", rayleigh, 0.9},
            {"layers over ground", steep, 0.3},
            {"a step cloud of voxels over ground", medium(write_grid(steps), 2.0, 0.99, 0.85), 0.2}};
}

// Power into the domain's area, and what goes up, stays in the ground, and stays in the medium.
void check_energy(const ClosedCase& c, const char* integrator) {
    Scene scene;
    scene.volumes = {c.volume};
    scene.settings.filter = Filter::nearest;
    scene.settings.spp = thorough() ? 1 << 13 : 1 << 11;
    scene.settings.integrator = integrator;
    scene.periodic = Periodic{{-1.0, 0.0, -1.0}, {1.0, 0.0, 1.0}};
    scene.lights = {DirectionalLight{glm::normalize(glm::dvec3(1.0, 0.8, 0.4)), {3.0, 2.0, 1.0}}};
    Surface ground;
    ground.shape = PlaneSurface{{0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
    ground.material = matte(c.ground);
    scene.surfaces = {ground};
    const Rgb in = Rgb(3.0, 2.0, 1.0) * glm::normalize(glm::dvec3(1.0, 0.8, 0.4)).y;
    Scene up = scene, down = scene,
          within = absorption({0.0, 0.5, 0.0}, {2.0, 1.0, 2.0}, {2, 4, 1}, scene.settings.spp);
    for (Scene* flux : {&up, &down}) {
        flux->camera.projection = Projection::irradiance;
        flux->camera.position = {0.0, flux == &up ? 1.25 : 0.0, 0.0};
        look_along(flux->camera, {0.0, flux == &up ? -1.0 : 1.0, 0.0}, {0.0, 0.0, 1.0});
        flux->camera.size = {2.0, 2.0};
        flux->picture = {2, 1, 0.0, 0.0, 2.0, 1.0};
    }
    within.volumes = scene.volumes;
    within.surfaces = scene.surfaces;
    within.periodic = scene.periodic;
    within.lights = scene.lights;
    within.settings = scene.settings;
    within.settings.integrator = "lightTracing"; // which alone counts what is absorbed
    glm::dvec3 power(0.0), variance(0.0);
    std::uint32_t seed = 1;
    for (const auto& [part, of] : {std::pair(up, 1.0), std::pair(down, 1.0 - c.ground), std::pair(within, 1.0)}) {
        const ImageMean mean = image_mean(render_here(part, seed++).film);
        power += of * mean.value;
        variance += of * of * *mean.standard_error * *mean.standard_error;
    }
    for (int channel = 0; channel < 3; ++channel) {
        CAPTURE(c.name, integrator, channel, power[channel], in[channel], std::sqrt(variance[channel]));
        CHECK(std::abs(power[channel] - in[channel]) < 4.0 * std::sqrt(variance[channel]));
        CHECK(std::sqrt(variance[channel]) < 0.04 * in[channel]);
    }
}

} // namespace

// R + T + A of closed cases, fluxes by particles and by paths.
TEST_CASE("what a domain reflects, lets through and absorbs is what comes in", "[gpu][periodic][counted][surfaces][long]") {
    int turn = 0;
    for (const ClosedCase& c : closed_cases())
        for (const char* integrator : in_turn<const char*>({"lightTracing", "ratioTracking"}, turn++, 2))
            check_energy(c, integrator);
}
