// Thermal radiation of layers, in a band.
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>

#include "planck_band.h"
#include "support/images.h"
#include "support/scene_text.h"

using namespace vkvol;

namespace {

constexpr double tau = 1.5;

// Of optical depth 1.5, 290 K below and 230 K on top, Planck's function linear in between, from 8 to 12 micrometres.
Scene air() {
    Scene scene = parse(R"(<box y="0.5" width="4000" height="1" depth="4000"/><layers>
        <layer height="0" sigma_t="1.5" albedo="0" emission="${= planck(290, 8, 12)}"/>
        <layer height="1" sigma_t="1.5" albedo="0" emission="${= planck(230, 8, 12)}"/></layers>)");
    scene.has_camera = true;
    scene.camera.projection = Projection::orthographic;
    scene.camera.view_height = 1e-3;
    scene.camera.yaw = 35.0;
    scene.picture = {8, 8, 0.0, 0.0, 8.0, 8.0};
    scene.settings.spp = 2000;
    return scene;
}

// Along a path of optical depth S through what shines `near` at its beginning and `far` at its end, before `beyond`.
double radiance(double S, double near, double far, double beyond) {
    return near * -std::expm1(-S) + (far - near) / S * (1.0 - std::exp(-S) * (1.0 + S)) + beyond * std::exp(-S);
}

} // namespace

TEST_CASE("air whose Planck function is linear in depth has its closed form's radiance", "[gpu][layers][closed_form][long]") {
    const double below = planck_band({290.0, 8.0, 12.0}), above = planck_band({230.0, 8.0, 12.0});
    for (const double angle : {90.0, 40.0}) { // with the horizon
        const double S = tau / std::sin(glm::radians(angle));
        Scene down = air();
        down.camera.position = {0.0, 5.0, 0.0};
        down.camera.pitch = -angle;
        down.background = Rgb(below); // a black ground
        CHECK_AGREEMENT(agree_with_means(render_here(down, 1).film,
                                         std::vector<Rgb>(64, Rgb(radiance(S, above, below, below))),
                                         fmt::format("thermal, from above, {}", angle)));
        Scene up = air();
        up.camera.position = {0.0, -5.0, 0.0};
        up.camera.pitch = angle;
        CHECK_AGREEMENT(agree_with_means(render_here(up, 2).film,
                                         std::vector<Rgb>(64, Rgb(radiance(S, below, above, 0.0))),
                                         fmt::format("thermal, from below, {}", angle)));
    }
}
