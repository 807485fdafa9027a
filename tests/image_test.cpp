// Whole pictures: the renderer against the scalar reference, per pixel and in the mean.
#include <catch2/catch.hpp>

#include "support/images.h"
#include "support/scenes.h"

using namespace vkvol;

namespace {

constexpr int pixels = 24;
constexpr std::uint32_t samples = 256;
constexpr Rgb sky{0.3, 0.5, 0.9};

Scene ball(double g) {
    Scene scene = scene_of(medium(Sphere{}, 4.0, 0.95, g), 2.4, pixels);
    scene.background = sky;
    scene.lights = {sunlight()};
    scene.settings.spp = samples;
    return scene;
}

void check_against_reference(Scene scene, const std::string& name) {
    for (const char* integrator : {"deltaTracking", "ratioTracking"}) {
        scene.settings.integrator = integrator;
        const Film device = render_here(scene, 1).film;
        const Agreement agreement = agree(device, render_reference(scene, 2), name + ", " + integrator);
        INFO(agreement.report);
        CHECK(agreement.ok);
    }
}

} // namespace

TEST_CASE("homogeneous spheres equal the reference", "[gpu][image][sphere]") {
    for (const double g : {0.8, -0.8})
        check_against_reference(ball(g), "sphere, g " + std::to_string(g));
}
