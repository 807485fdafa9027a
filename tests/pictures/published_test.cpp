// Figures that others have printed. tools/truth reads more of them, and better.
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "camera_view.h"
#include "shared/constants.h"
#include "support/images.h"
#include "support/scenes.h"

using namespace vkvol;
using std::numbers::pi;

namespace {

glm::dvec3 toward(double mu) {
    return {std::sqrt(1.0 - mu * mu), mu, 0.0};
}

// A box that fills its domain, its top at height 0.
Scene slab_scene(double tau, double albedo, double g = 0.0) {
    Scene scene;
    scene.volumes = {medium(Box{{0.0, -0.5 * tau, 0.0}, {4.0, tau, 4.0}}, 1.0, albedo, g)};
    scene.periodic = Periodic{{-2.0, 0.0, -2.0}, {2.0, 0.0, 2.0}};
    scene.settings.integrator = "ratioTracking";
    scene.settings.spp = 2048;
    return scene;
}

void read_flux(Scene& scene, double height, bool down, glm::dvec2 size, int columns, int rows) {
    scene.camera.projection = Projection::irradiance;
    scene.camera.position = {0.0, height, 0.0};
    look_along(scene.camera, down ? up_y : -up_y, {0.0, 0.0, down ? 1.0 : -1.0}); // columns along +x
    scene.camera.size = size;
    scene.picture = {columns, rows, 0.0, 0.0, double(columns), double(rows)};
}

void check(const Scene& scene, double expected, const std::string& name) {
    const std::vector<Rgb> means(std::size_t(scene.picture.width * scene.picture.height), Rgb(expected));
    CHECK_AGREEMENT(agree_with_means(render_here(scene, 5).film, means, name));
}

void check_flux(Scene scene, double height, bool down, double expected, const std::string& name) {
    read_flux(scene, height, down, {1.0, 1.0}, 8, 8);
    check(scene, expected, name);
}

} // namespace

// van de Hulst, "Multiple Light Scattering" (1980), table 12: radiance over mu0 at mu = 0.5, the sun's irradiance
// across itself being pi.
TEST_CASE("van de Hulst's slab that scatters evenly", "[gpu][image][published][long]") {
    for (const auto& [mu0, value] : {std::pair{1.0, .28616}, {.7, .34188}, {.3, .45353}}) {
        Scene scene = slab_scene(2.0, 0.8);
        scene.lights = {DirectionalLight{toward(mu0), Rgb(pi)}};
        scene.camera.projection = Projection::orthographic;
        scene.camera.view_height = 1e-2;
        scene.camera.position = glm::dvec3(0.0, 0.0, std::sqrt(0.75)) + 0.5 * up_y;
        look_along(scene.camera, -scene.camera.position, up_y);
        scene.picture = {8, 8, 0.0, 0.0, 8.0, 8.0};
        check(scene, value * mu0, fmt::format("van de Hulst, mu0 {}", mu0));
    }
}

TEST_CASE("printed fluxes of slabs", "[gpu][image][published][long]") {
    Scene forward = slab_scene(2.0, 0.9, 0.75); // van de Hulst, as quoted by Wang, Jacques and Zheng, "MCML" (1995)
    forward.lights = {DirectionalLight{up_y, Rgb(1.0)}};
    check_flux(forward, 1e-3, false, .09739, "forward, up");
    check_flux(forward, -2.001, true, .66096, "forward, down");
    for (const auto& [albedo, value] : {std::pair{.2, .0799451}, {1.0, .422922}}) { // Stamnes et al. (1988), test 1
        Scene thin = slab_scene(1.0 / 32.0, albedo);
        thin.lights = {DirectionalLight{toward(.1), Rgb(pi / .1)}};
        check_flux(thin, 1e-3, false, value, fmt::format("DISORT 1, {}", albedo));
    }
    Scene rayleigh = slab_scene(.2, .5); // Sweigart (1970), scalar
    rayleigh.volumes.front().phase = PhaseFunction::rayleigh;
    rayleigh.lights = {DirectionalLight{toward(.080442), Rgb(pi)}};
    check_flux(rayleigh, 1e-3, false, .0535063, "Rayleigh, up");
    check_flux(rayleigh, -.201, true, .0441791 + pi * .080442 * std::exp(-.2 / .080442), "Rayleigh, down");
    Scene layers = slab_scene(.25, .5); // Stamnes et al. (1988): below it another, under an even sky of flux 1
    layers.volumes.push_back(medium(Box{{0.0, -.375, 0.0}, {4.0, .25, 4.0}}, 1.0, .3));
    layers.background = Rgb(1.0 / pi);
    layers.surfaces.emplace_back().shape = PlaneSurface{{0.0, -.51, 0.0}, up_y};
    layers.surfaces.back().material.color = Rgb(0.0);
    check_flux(layers, 1e-3, false, .0929633, "layers, up");
    check_flux(layers, -.501, true, .513132, "layers, down");
}

// I3RC phase 1, case 1 (Cahalan et al. 2005), experiment 1: 32 columns over 0.5 km, of optical depth 2 and 18, the sun
// overhead. The consensus scatters by 0.1 % and 0.06 % of each.
TEST_CASE("the step cloud's columns", "[gpu][image][published][hard][long]") {
    constexpr double reflected[] = {0.27859, 0.26712, 0.25531, 0.24542, 0.23761, 0.23207, 0.22805, 0.22592,
                                    0.22597, 0.22796, 0.23176, 0.23787, 0.24578, 0.25563, 0.26676, 0.27939,
                                    0.32332, 0.36758, 0.39589, 0.41544, 0.43034, 0.44028, 0.44675, 0.45022,
                                    0.44978, 0.44676, 0.44118, 0.43032, 0.41623, 0.39624, 0.36826, 0.32325};
    constexpr double transmitted[] = {0.84654, 0.94825, 1.0049,  1.0359,  1.0539,  1.0638,  1.0697,  1.0706,
                                      1.0703,  1.0697,  1.064,   1.0543,  1.0363,  1.0045,  0.94871, 0.84774,
                                      0.44446, 0.35244, 0.32505, 0.31401, 0.30884, 0.30715, 0.30596, 0.30572,
                                      0.30614, 0.30642, 0.30683, 0.30907, 0.31385, 0.32537, 0.35255, 0.44375};
    constexpr int rows = 4;
    Scene scene;
    scene.volumes = {medium(Box{{-.125, .125, 0.0}, {.25, .25, 1.0}}, 2.0 / .25, 1.0, .85),
                     medium(Box{{.125, .125, 0.0}, {.25, .25, 1.0}}, 18.0 / .25, 1.0, .85)};
    scene.periodic = Periodic{{-.25, 0.0, -.5}, {.25, 0.0, .5}};
    scene.lights = {DirectionalLight{up_y, Rgb(1.0)}};
    scene.settings.spp = 4096;
    for (const bool down : {false, true}) {
        read_flux(scene, down ? 0.0 : .25, down, {.5, 1.0}, 32, rows);
        std::vector<Rgb> means;
        for (int i = 0; i < 32 * rows; ++i)
            means.emplace_back(down ? transmitted[i % 32] : reflected[i % 32]);
        CHECK_AGREEMENT(agree_with_means(render_here(scene, 7).film, means, down ? "step, down" : "step, up"));
    }
}
