// What a scene has, as methods and kernels ask for it.
#include <catch2/catch.hpp>

#include "method.h"
#include "preset.h"
#include "scene_facts.h"
#include "shared/constants.h"
#include "support/scene_text.h"
#include "support/scenes.h"

using namespace vkvol;

TEST_CASE("a volume without density is not there, whatever its coefficients", "[cpu][method]") {
    Volume volume = medium(Sphere{{0.0, 0.0, 0.0}, 1.0}, 1.0, 0.0);
    volume.sigma_s = {1.0, 0.5, 0.0};
    volume.Le = Rgb(1.0);
    Scene scene = parse("<volumes><volume><sphere/></volume></volumes>");
    scene.volumes.push_back(volume);
    CHECK(can_scatter(volume));
    CHECK(has_chromatic_extinction(scene));
    CHECK(emits(scene));
    scene.volumes.back().density_scale = 0.0; // as one that fades has it at last
    CHECK_FALSE(can_scatter(scene.volumes.back()));
    CHECK_FALSE(has_chromatic_extinction(scene));
    CHECK_FALSE(emits(scene));
}

TEST_CASE("light of media that glow unevenly is found on surfaces by chance", "[cpu][method]") {
    Scene scene;
    scene.volumes.resize(1);
    scene.volumes[0].shape = Sphere{};
    scene.volumes[0].sigma_a = Rgb(1.0);
    scene.volumes[0].Le = Rgb(1.0);
    CHECK(choose_method(with_preset(scene)).by_chance.empty());
    scene.surfaces.resize(1);
    scene.surfaces[0].shape = RectangleSurface{};
    CHECK(choose_method(with_preset(scene)).by_chance.empty()); // an even ball is looked for
    scene.volumes[0].noise = Noise{};
    CHECK_THAT(
        choose_method(with_preset(scene)).by_chance,
        Catch::Contains("that glow, for which no shadow ray looks, on surfaces, which integrator lightTracing brings"));
    scene.settings.integrator = "lightTracing";
    CHECK(choose_method(with_preset(scene)).by_chance.empty());
    scene.settings.integrator.clear();
    scene.settings.choices.scattering = SCATTERING_NONE; // nothing that surfaces scatter is seen
    CHECK(choose_method(with_preset(scene)).by_chance.empty());
    scene.settings.choices = {};
    scene.surfaces.clear();
    CHECK(choose_method(with_preset(scene)).by_chance.empty());
}
