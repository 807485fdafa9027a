// The scalar reference: which estimators a name, a scene and explicit choices lead to.
#include <catch2/catch.hpp>

#include <array>

#include "tests/reference/test_media.h"

using namespace reference;

namespace {

Method resolve(Kind kind, const std::string& name, const vkvol::AxisChoices& choices = {}, bool lit = true) {
    vkvol::Scene scene;
    scene.settings.integrator = name;
    scene.settings.choices = choices;
    if (lit)
        scene.lights.resize(1);
    Sample sample = make_sample(kind);
    return resolve_method(scene, sample.medium);
}

std::array<int, 5> axes(const Method& m) {
    return {m.scattering, m.free_flight, m.transmittance, m.nee, m.emission};
}

constexpr int none = SCATTERING_NONE, single = SCATTERING_SINGLE, multiple = SCATTERING_MULTIPLE;

} // namespace

TEST_CASE("every preset is what its name says, in a grey grid", "[cpu][reference]") {
    const auto check = [](const char* name, int scattering, int free_flight, int transmittance, int nee) {
        CAPTURE(name);
        CHECK(axes(resolve(Kind::rough_grid, name)) ==
              std::array{scattering, free_flight, transmittance, nee, EMISSION_AT_COLLISIONS});
    };
    const int collisions = NEE_COLLISIONS, ratio = TRANSMITTANCE_RATIO;
    // Depth-sampled flights have no tentative collisions.
    check("nanoVDBSimple", single, FREE_FLIGHT_MARCH, TRANSMITTANCE_MARCH, collisions);
    check("nanoVDBEmission", single, FREE_FLIGHT_MARCH, TRANSMITTANCE_MARCH, collisions);
    check("heterogeneousPerlinNoise", single, FREE_FLIGHT_MARCH, TRANSMITTANCE_MARCH, collisions);
    check("deltaTracking", multiple, FREE_FLIGHT_DELTA, ratio, NEE_NONE);
    check("ratioTracking", multiple, FREE_FLIGHT_DELTA, ratio, collisions);
    check("", multiple, FREE_FLIGHT_DELTA, ratio, NEE_CACHED);
    check("cachedRatioTracking", multiple, FREE_FLIGHT_DELTA, ratio, NEE_CACHED);
    check("ratioNEE", multiple, FREE_FLIGHT_DELTA, ratio, NEE_TENTATIVE);
    check("deltaTrackingNEE", multiple, FREE_FLIGHT_DELTA, TRANSMITTANCE_DELTA, collisions);
    check("regularTracking", multiple, FREE_FLIGHT_REGULAR, TRANSMITTANCE_REGULAR, collisions);
    check("rayMarching", multiple, FREE_FLIGHT_MARCH, TRANSMITTANCE_MARCH, collisions);
    check("adaptiveRayMarching", multiple, FREE_FLIGHT_ADAPTIVE, TRANSMITTANCE_MARCH, collisions);
    check("weightedTracking", multiple, FREE_FLIGHT_WEIGHTED, ratio, collisions);
    check("decompositionTracking", multiple, FREE_FLIGHT_DECOMPOSITION, TRANSMITTANCE_RESIDUAL, collisions);
    check("spectralTracking", multiple, FREE_FLIGHT_SPECTRAL, ratio, collisions);
    check("residualRatioTracking", multiple, FREE_FLIGHT_DELTA, TRANSMITTANCE_RESIDUAL, collisions);
    check("unbiasedRayMarching", multiple, FREE_FLIGHT_DELTA, TRANSMITTANCE_TELESCOPING, collisions);
    CHECK(resolve(Kind::rough_grid, "", {}, false).name == "deltaTracking");
}

TEST_CASE("homogeneous media are solved in closed form, unless told otherwise", "[cpu][reference]") {
    for (const char* name : {"deltaTracking", "ratioNEE", "regularTracking", "weightedTracking",
                             "decompositionTracking", "spectralTracking", "unbiasedRayMarching"})
        for (const Kind kind : {Kind::box, Kind::chromatic_box}) {
            const Method method = resolve(kind, name);
            CHECK(method.free_flight == FREE_FLIGHT_ANALYTIC);
            CHECK(method.transmittance == TRANSMITTANCE_ANALYTIC);
            CHECK(method.nee != NEE_TENTATIVE);
        }
    CHECK(resolve(Kind::box, "rayMarching").free_flight == FREE_FLIGHT_MARCH);
    CHECK(resolve(Kind::box, "rayMarching").transmittance == TRANSMITTANCE_ANALYTIC);
    for (const char* name : {"homogeneousRayMarcherNEE", "homogeneousRayMarcherImproved"}) {
        const Method method = resolve(Kind::box, name);
        CHECK(axes(method) == std::array{single, FREE_FLIGHT_MARCH, TRANSMITTANCE_ANALYTIC, NEE_COLLISIONS, 0});
        CHECK(method.march.jitter == (method.name == "homogeneousRayMarcherImproved"));
    }
    CHECK(axes(resolve(Kind::box, "densitySampling")) ==
          std::array{none, FREE_FLIGHT_ANALYTIC, TRANSMITTANCE_ANALYTIC, NEE_NONE, 0});

    vkvol::AxisChoices choices;
    choices.free_flight = FREE_FLIGHT_DELTA;
    choices.transmittance = TRANSMITTANCE_RATIO;
    CHECK(resolve(Kind::box, "regularTracking", choices).free_flight == FREE_FLIGHT_DELTA);
    CHECK(resolve(Kind::chromatic_box, "regularTracking", choices).free_flight == FREE_FLIGHT_SPECTRAL);
    CHECK(resolve(Kind::box, "regularTracking", choices).transmittance == TRANSMITTANCE_RATIO);
    choices.free_flight = FREE_FLIGHT_REGULAR;
    choices.transmittance = TRANSMITTANCE_REGULAR;
    CHECK(resolve(Kind::box, "ratioTracking", choices).free_flight == FREE_FLIGHT_ANALYTIC);
    CHECK(resolve(Kind::box, "ratioTracking", choices).transmittance == TRANSMITTANCE_ANALYTIC);
}

TEST_CASE("choices replace the preset's and follow from each other", "[cpu][reference]") {
    for (const char* name : {"ratioTracking", "weightedTracking", "decompositionTracking", "spectralTracking"})
        CHECK(resolve(Kind::chromatic_grid, name).free_flight == FREE_FLIGHT_SPECTRAL);
    CHECK(resolve(Kind::chromatic_grid, "regularTracking").free_flight == FREE_FLIGHT_REGULAR);
    CHECK(resolve(Kind::rough_grid, "ratioTracking", {}, false).nee == NEE_NONE);

    vkvol::AxisChoices choices;
    choices.scattering = none;
    CHECK(resolve(Kind::rough_grid, "ratioNEE", choices).nee == NEE_NONE);
    choices.scattering = single;
    CHECK(resolve(Kind::rough_grid, "ratioNEE", choices).nee == NEE_TENTATIVE);
    choices.free_flight = FREE_FLIGHT_REGULAR;
    CHECK(resolve(Kind::rough_grid, "ratioNEE", choices).nee == NEE_COLLISIONS);
    choices.emission = EMISSION_AT_STEPS;
    CHECK(resolve(Kind::rough_grid, "ratioNEE", choices).emission == EMISSION_AT_STEPS);
    CHECK(resolve(Kind::chromatic_grid, "ratioNEE", choices).emission == EMISSION_AT_COLLISIONS);
    choices.free_flight = FREE_FLIGHT_DELTA;
    CHECK(resolve(Kind::chromatic_grid, "ratioNEE", choices).emission == EMISSION_AT_STEPS);
    choices.transmittance = TRANSMITTANCE_TELESCOPING;
    choices.nee = NEE_COLLISIONS;
    CHECK(axes(resolve(Kind::rough_grid, "spectralTracking", choices)) ==
          std::array{single, FREE_FLIGHT_DELTA, TRANSMITTANCE_TELESCOPING, NEE_COLLISIONS, EMISSION_AT_STEPS});
}

TEST_CASE("choices that a medium does not allow are errors", "[cpu][reference]") {
    CHECK_THROWS(resolve(Kind::box, "somethingElse"));
    CHECK_THROWS(resolve(Kind::rough_grid, "densitySampling"));
    CHECK_THROWS(resolve(Kind::noise_sphere, "densitySampling"));
    CHECK_THROWS(resolve(Kind::rough_grid, "homogeneousRayMarcherImproved")); // its shadow rays are analytic
    CHECK_THROWS(resolve(Kind::noise_mesh, "regularTracking"));
    vkvol::AxisChoices choices;
    choices.transmittance = TRANSMITTANCE_REGULAR;
    CHECK_THROWS(resolve(Kind::noise_sphere, "ratioTracking", choices));
    CHECK_NOTHROW(resolve(Kind::noise_sphere, "ratioTracking", choices, false)); // no shadow rays
    choices = {};
    choices.free_flight = FREE_FLIGHT_ANALYTIC;
    CHECK_THROWS(resolve(Kind::rough_grid, "ratioTracking", choices));
    vkvol::Volume v = volume(0.1, 0.2);
    v.noise = vkvol::Noise{};
    CHECK_THROWS(with_grid(random_grid(), v));
    vkvol::Scene two;
    two.volumes.resize(2);
    two.volumes.back().sigma_a.y += 0.1; // races are for grey extinction
    CHECK_THROWS(load_world(two));
}

TEST_CASE("march lengths and what presets change in the volume", "[cpu][reference]") {
    const Sample grid = make_sample(Kind::rough_grid), box = make_sample(Kind::box);
    const double voxel = grid.medium.grid()->voxel_length();
    CHECK(resolve_march({}, grid.medium).step == Approx(0.5 * voxel));
    CHECK(resolve_march({}, box.medium).step == 0.2);
    vkvol::March march;
    march.step = 3.0;
    CHECK(resolve_march(march, grid.medium).step == Approx(3.0 * voxel));
    CHECK(resolve_march(march, grid.medium).shadow_step == Approx(3.0 * voxel));
    CHECK(resolve_march(march, box.medium).step == 3.0);
    march.unit = vkvol::CoefficientUnit::world;
    march.shadow_step = 5.0;
    CHECK(resolve_march(march, grid.medium).step == 3.0);
    CHECK(resolve_march(march, grid.medium).shadow_step == 5.0);

    vkvol::Volume v = volume(0.1, 0.2, 0.7);
    v.Le = vkvol::Rgb(1.0);
    v.temperature.color = vkvol::Rgb(2.0);
    CHECK(preset_volume("homogeneousRayMarcherNEE", v).g == 0.0);
    CHECK(preset_volume("homogeneousRayMarcherImproved", v).g == 0.7);
    CHECK(preset_volume("nanoVDBSimple", v).Le == vkvol::Rgb(0.0));
    CHECK(preset_volume("nanoVDBSimple", v).temperature.color == vkvol::Rgb(0.0));
    CHECK(preset_volume("nanoVDBEmission", v).Le == vkvol::Rgb(1.0));
    CHECK(preset_volume("heterogeneousPerlinNoise", v).noise->frequency == vkvol::Noise{}.frequency);
    v.noise = vkvol::Noise{3.0};
    CHECK(preset_volume("heterogeneousPerlinNoise", v).noise->frequency == 3.0);
    CHECK_FALSE(preset_volume("rayMarching", volume(0.1, 0.2)).noise);
}
