// Maps of the sky that are nearly even: flights alone find their light.
#include <catch2/catch.hpp>

#include "even_sky.h"
#include "method.h"
#include "shared/constants.h"
#include "shared/estimators.h"
#include "support/agreement.h"
#include "support/images.h"
#include "support/scenes.h"

using namespace vkvol;

namespace {

// As bright as `top` straight up, as `bottom` straight down, and linear between rows.
SkyLight gradient(double top, double bottom) {
    return write_sky(make_map(16, 8, [&](int, int row) { return Rgb(top + (bottom - top) * row / 7.0); }));
}

Scene cloud_under(std::vector<Light> lights) {
    Scene scene = scene_of(medium(Sphere{{0.0, 0.0, 0.0}, 1.0}, 2.0, 0.95, 0.6), 2.6, 12);
    scene.volumes.front().noise = Noise{1.3, 2, 0.5, 2.0};
    scene.lights = std::move(lights);
    scene.settings.integrator = "ratioTracking";
    scene.settings.spp = 128;
    return scene;
}

Film render_by(Scene scene, std::optional<int> mis, std::uint32_t seed) {
    scene.settings.choices.mis = mis;
    return render_here(scene, seed).film;
}

Film render_without_looks(Scene scene, std::uint32_t seed) {
    scene.settings.choices.nee = NEE_NONE;
    return render_here(scene, seed).film;
}

} // namespace

TEST_CASE("a map's unevenness is its radiance's mean square over its mean's", "[cpu][lights]") {
    CHECK(load_sky(write_sky(make_map(8, 4, [](int, int) { return Rgb(3.0, 2.0, 1.0); }))).unevenness == Approx(1.0));
    // Of half of all directions.
    const auto half = [](int, int row) { return Rgb(row < 4 ? 2.0 : 0.0); };
    CHECK(load_sky(write_sky(make_map(16, 8, half))).unevenness == Approx(2.0));
    // Of a quarter, in a map of equal areas.
    const auto quarter = [](int column, int row) { return Rgb(row < 4 && column < 4 ? 1.0 : 0.0); };
    const SkyLight square = write_sky(make_map(8, 8, quarter), SkyMapping::equal_area);
    CHECK(load_sky(square).unevenness == Approx(4.0));
}

TEST_CASE("no look goes toward an even sky unless told so", "[gpu][image][lights]") {
    const Scene even = cloud_under({gradient(2.0, 0.5)});
    REQUIRE(load_sky(std::get<SkyLight>(even.lights.front())).unevenness < 1.6);
    Scene steep = even;
    steep.lights = {write_sky(make_map(16, 8, [](int, int row) { return Rgb(row == 1 ? 9.0 : 0.1); }))};
    REQUIRE(load_sky(std::get<SkyLight>(steep.lights.front())).unevenness > 2.1);
    CHECK(same_bits(render_by(even, {}, 1), render_without_looks(even, 1)));
    CHECK_THAT(render_here(even, 1).specialization, Catch::Contains("an even sky by flights alone"));
    CHECK(same_bits(render_by(steep, {}, 1), render_by(steep, MIS_BALANCE, 1)));
    CHECK_AGREEMENT(agree(render_by(even, {}, 1), render_by(even, MIS_BALANCE, 2), "an even sky"));
    // A third of it bright: that depends on how far ahead media scatter, and on surfaces.
    Scene third = even;
    third.lights = {write_sky(make_map(16, 8, [](int, int row) { return Rgb(row < 3 ? 2.0 : 0.0); }))};
    const double unevenness = load_sky(std::get<SkyLight>(third.lights.front())).unevenness;
    REQUIRE(unevenness > 2.1);
    REQUIRE(unevenness < 6.0);
    CHECK(same_bits(render_by(third, {}, 1), render_by(third, MIS_BALANCE, 1)));
    third.volumes.front().g = 0.9;
    CHECK(same_bits(render_by(third, {}, 1), render_without_looks(third, 1)));
    // Of what is even but for one part in a hundred, a peak.
    Scene peaked = third;
    peaked.volumes.front().g = 0.0;
    peaked.volumes.front().phase = PhaseFunction::double_henyey_greenstein;
    peaked.volumes.front().phase_details.g2 = 0.95;
    peaked.volumes.front().phase_details.share = 0.01;
    CHECK(same_bits(render_by(peaked, {}, 1), render_by(peaked, MIS_BALANCE, 1)));
    third.surfaces.emplace_back();
    CHECK(same_bits(render_by(third, {}, 1), render_by(third, MIS_BALANCE, 1)));
    // Light that is scattered once is found by looks.
    Scene once = even;
    once.settings.choices.scattering = SCATTERING_SINGLE;
    CHECK(same_bits(render_by(once, {}, 1), render_by(once, MIS_BALANCE, 1)));
}

TEST_CASE("beside an even sky looks go toward the other lights", "[gpu][image][lights]") {
    const Scene scene =
        cloud_under({gradient(1.0, 0.4), SunLight{glm::normalize(glm::dvec3(1.0, 2.0, 0.5)), Rgb(2.0), 5.0},
                     PointLight{{1.5, 1.0, 1.0}, Rgb(1.0)}});
    const Film film = render_by(scene, {}, 1), shared = render_by(scene, MIS_BALANCE, 2);
    CHECK_AGREEMENT(agree(film, shared, "an even sky, a sun and a point"));
    CHECK_FALSE(same_bits(film, render_by(scene, MIS_BALANCE, 1)));
    LightTable table;
    table.choices = 3;
    table.rows.resize(4);
    table.rows[1].kind = LIGHT_MAP;
    for (const auto& [i, chance] : {std::pair(0, 0.3f), std::pair(1, 0.5f), std::pair(2, 0.2f)})
        table.rows[std::size_t(i)].chance = chance;
    leave_sky_to_flights(table);
    CHECK(table.rows[0].chance == Approx(0.6));
    CHECK(table.rows[1].chance == 0.0f);
    CHECK(table.rows[2].chance == Approx(0.4));
    CHECK(table.rows[1].alias.keep == 0);
    CHECK(table.rows[0].alias.other != 1);
    CHECK(table.rows[2].alias.other != 1);
}

TEST_CASE("how even a sky must be depends on what scatters, what else shines and who reads", "[cpu][lights]") {
    Scene cloud = cloud_under({gradient(2.0, 0.5)});
    const std::vector<LoadedMedium> none(1);
    const auto most = [&](const Scene& scene) { // the largest unevenness that is left to flights, to 0.1
        SkyMap sky;
        const Method method = choose_method(scene);
        for (sky.unevenness = 0.95; is_left_to_flights(scene, none, method, &sky); sky.unevenness += 0.1)
            ;
        return sky.unevenness - 0.05;
    };
    CHECK(most(cloud) == Approx(2.1));
    Scene ahead = cloud;
    ahead.volumes.front().g = 0.8;
    CHECK(most(ahead) == Approx(6.0));
    Scene lit = ahead;
    lit.lights.emplace_back(PointLight{{3.0, 0.0, 0.0}, Rgb(1.0)});
    CHECK(most(lit) == Approx(1.6));
    lit.volumes.front().g = 0.85;
    CHECK(most(lit) == Approx(4.0));
    Scene floor = ahead;
    floor.surfaces.emplace_back();
    CHECK(most(floor) == Approx(1.6));
    Scene reading = ahead;
    reading.camera.projection = Projection::fluence;
    reading.camera.points = {glm::dvec3(0.0)};
    CHECK(most(reading) == Approx(1.6));
    Scene told = ahead;
    told.settings.choices.nee = NEE_COLLISIONS;
    CHECK(most(told) < 1.0);
    told = ahead;
    told.settings.choices.mis = MIS_BALANCE;
    CHECK(most(told) < 1.0);
}
