// What particles cannot do, or would do badly: refused or said.
#include <catch2/catch.hpp>

#include "method.h"
#include "preset.h"
#include "shared/constants.h"
#include "support/scene_text.h"
#include "support/surface_scenes.h"

using namespace vkvol;
using Catch::Contains;

// From lights that are infinitely far they come only to what has an end.
TEST_CASE("what particles do not bring from afar is told", "[cpu][particles]") {
    Scene scene = before_smoke({surface_of(left_ball, MaterialKind::dielectric)}, {sunlight()});
    Surface ground;
    ground.shape = PlaneSurface{{0.0, -3.0, 0.0}, {0.0, 1.0, 0.0}};
    scene.surfaces.push_back(ground);
    CHECK_THAT(choose_method(with_preset(by(scene, "bidirectional"))).biased, Contains("without end"));
    scene.lights = {SunLight{{0.0, 1.0, 0.0}, Rgb(1.0), 10.0}};
    CHECK(choose_method(with_preset(by(scene, "bidirectional"))).biased.empty());
    CHECK_THAT(choose_method(with_preset(by(scene, "bidirectional"))).by_chance, Contains("suns and skies"));
    scene.surfaces.back().shape = RectangleSurface{{0.0, -3.0, 0.0}, {5.0, 0.0, 0.0}, {0.0, 0.0, -5.0}};
    CHECK(choose_method(with_preset(by(scene, "bidirectional"))).by_chance.empty());
}

TEST_CASE("no particles look for rows beyond a panorama's poles", "[cpu][particles]") {
    Scene scene = before_smoke({}, {PointLight{{1.2, 1.9, 1.5}, {12.0, 9.0, 6.0}}});
    scene.camera.projection = Projection::equirectangular;
    scene.picture = {16, 12, 0.0, 0.0, 16.0, 12.0};
    for (const char* integrator : {"lightTracing", "bidirectional"}) {
        CHECK_NOTHROW(choose_method(by(scene, integrator)));
        Scene above = by(scene, integrator), below = above;
        above.picture.start_y = -0.4;
        below.picture.height = 14;
        CHECK_THROWS_WITH(choose_method(above), Catch::Contains("beyond a pole"));
        CHECK_THROWS_WITH(choose_method(below), Catch::Contains("beyond a pole"));
    }
}

TEST_CASE("what particles cannot do is refused, with what can", "[particles]") {
    Scene scene = small_picture(smoke(), 4.0, {PointLight{{1.2, 1.9, 1.5}, {12.0, 9.0, 6.0}}});
    const auto refusal = [](const Scene& scene) -> std::string {
        try {
            choose_method(with_preset(scene));
        } catch (const std::exception& error) {
            return error.what();
        }
        return "";
    };
    Scene particles = by(scene, "lightTracing"), both = by(scene, "bidirectional");
    CHECK(refusal(particles).empty());
    CHECK(refusal(both).empty());
    SECTION("sensors of flux") {
        particles.camera.projection = both.camera.projection = Projection::irradiance;
        CHECK(refusal(particles).empty());
        CHECK_THAT(refusal(both), Contains("flux") && Contains("ratioTracking"));
    }
    SECTION("layers") {
        particles.layers = both.layers = 1;
        CHECK_THAT(refusal(particles), Contains("layers"));
        CHECK_THAT(refusal(both), Contains("layers"));
    }
    SECTION("what has no end") {
        Surface ground = surface_of(PlaneSurface{{0.0, -2.0, 0.0}, {0.0, 1.0, 0.0}}, MaterialKind::diffuse);
        particles.surfaces = both.surfaces = {ground};
        CHECK_THAT(refusal(particles), Contains("no end"));
        CHECK(refusal(both).empty()); // its paths find that
        particles.background = Rgb(0.0);
        CHECK(refusal(particles).empty());
        particles.surfaces.front().emission = Rgb(1.0);
        CHECK_THAT(refusal(particles), Contains("plane"));
    }
    SECTION("no lights to begin at") {
        both.lights.clear();
        const Method method = choose_method(with_preset(both));
        CHECK(method.paths == PATHS_CAMERA);
        REQUIRE(method.warnings.size() == 1);
        CHECK_THAT(method.warnings.front(), Contains("without lights"));
    }
    SECTION("other scattering, and looks from elsewhere") {
        particles.settings.choices.scattering = SCATTERING_SINGLE;
        particles.settings.choices.nee = NEE_TENTATIVE;
        const Method method = choose_method(with_preset(particles));
        CHECK(method.scattering == SCATTERING_MULTIPLE);
        CHECK(method.nee == NEE_COLLISIONS);
        CHECK(method.warnings.size() == 2);
    }
}
