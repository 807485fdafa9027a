// Light that is scattered once: no flight meets what lies beyond all matter, and looks alone find it, drawn from the
// light and as matter and surfaces scatter.
#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <string>
#include <utility>

#include "shared/constants.h"
#include "support/agreement.h"
#include "support/images.h"
#include "support/scenes.h"
#include "support/test_device.h"
#include "support/test_sky.h"
#include "tests/reference/reference.h"

using namespace vkvol;

namespace {

// A ball of a phase function, before what the light brings.
Scene ball_before(const Light& light, PhaseFunction phase, double g) {
    Volume volume = medium(Sphere{{0.1, -0.1, 0.0}, 2.0}, 1.0, 0.95, g);
    volume.phase = phase;
    Scene scene = scene_of(volume, 5.0, 12, 25.0, glm::dvec3(0.0), {0.0, 25.0, 0.0});
    scene.background = Rgb(0.0);
    scene.lights = {light};
    scene.settings.spp = 512;
    scene.settings.choices.scattering = SCATTERING_SINGLE;
    return scene;
}

// Mean over pixels of the variance of a sample over the mean's square.
double noise_of(const Scene& scene, const Film& film) {
    double variance = 0.0, square = 0.0;
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        variance += double(film.variance[i].y) * scene.settings.spp;
        square += double(film.mean[i].y) * film.mean[i].y;
    }
    return variance / square;
}

} // namespace

TEST_CASE("what is scattered once of a sun or a sky is the reference's, by whatever directions are drawn",
          "[gpu][lights][long]") {
    const std::pair<std::string, Light> lights[] = {
        {"sun", SunLight{glm::normalize(glm::dvec3(1.0, 2.0, 0.5)), {3.0, 2.5, 2.0}, 8.0}},
        {"sun of more than half of all directions",
         SunLight{glm::normalize(glm::dvec3(1.0, 2.0, 0.5)), {3.0, 2.5, 2.0}, 220.0, 1.0}},
        {"map", write_sky(sunset_map())},
        {"square map", write_sky(square_map(), SkyMapping::equal_area)}};
    std::uint64_t seed = 1;
    for (const auto& [name, light] : lights) {
        Scene scene = ball_before(light, PhaseFunction::henyey_greenstein, name == "map" ? -0.8 : 0.85);
        const Film reference = render_reference(scene, ++seed);
        for (const int mis : {MIS_LIGHT, MIS_POWER, MIS_PHASE}) {
            if (mis == MIS_PHASE && name != "map")
                continue;
            scene.settings.choices.mis = mis;
            CHECK_AGREEMENT(agree(render_here(scene, ++seed).film, reference, fmt::format("{}, mis {}", name, mis)));
        }
    }
}

TEST_CASE("droplets scatter a sky, and a wide sun before the camera, once and with little noise",
          "[gpu][variances][lights]") {
    // Drawn from the lights alone 14 and 1.3: a few looks in a thousand go where droplets scatter most.
    for (const auto& [light, most] :
         {std::pair<Light, double>{write_sky(sunset_map()), 0.3},
          {SunLight{glm::normalize(glm::dvec3(-0.47, 0.05, -0.88)), Rgb(3.0), 30.0}, 0.2}}) {
        Scene scene = ball_before(light, PhaseFunction::droplets, 0.0);
        const double noise = noise_of(scene, render_here(scene, 1).film);
        scene.settings.choices.mis = MIS_LIGHT;
        const double by_light = noise_of(scene, render_here(scene, 1).film);
        CAPTURE(noise, by_light);
        CHECK(noise < most);
        CHECK(by_light > 5.0 * noise);
    }
}
