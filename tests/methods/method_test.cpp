#include <catch2/catch.hpp>

#include <algorithm>
#include <fmt/format.h>
#include <set>

#include "error.h"
#include "integrators.h"
#include "method.h"
#include "preset.h"
#include "scene_facts.h"
#include "scene_hash.h"
#include "shared/constants.h"
#include "support/scene_text.h"
#include "support/test_directory.h"

using namespace vkvol;

namespace {

Scene scene_of(const std::string& integrator, int field, bool light = true) {
    Scene scene;
    scene.settings.integrator = integrator;
    Volume volume;
    if (field == FIELD_GRID)
        volume.shape = GridFile{"cloud.nvdb"};
    if (field == FIELD_NOISE)
        volume.noise = Noise{};
    scene.volumes = {volume};
    if (light)
        scene.lights = {DirectionalLight{{0, 1, 0}, Rgb(1.0)}};
    return scene;
}

// `request` as on the command line.
Scene requested(const std::string& request, int field, bool light = true) {
    const IntegratorRequest parsed = parse_integrator(request);
    Scene scene = scene_of(parsed.name, field, light);
    scene.settings.choices = parsed.choices;
    return scene;
}

Method method_of(const std::string& request, int field, bool light = true) {
    return choose_method(with_preset(requested(request, field, light)));
}

std::string error_of(const std::string& request, int field) {
    try {
        method_of(request, field);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

std::string warning_of(const Method& method) {
    return method.warnings.size() == 1 ? method.warnings[0] : std::to_string(method.warnings.size()) + " warnings";
}

void make_chromatic(Scene& scene) {
    scene.volumes.front().sigma_a = {0.1, 0.2, 0.4};
}

} // namespace

TEST_CASE("every axis has a name for each of its ids", "[cpu][method]") {
    CHECK(find_axis("scattering").names.size() == SCATTERING_MULTIPLE + 1);
    CHECK(find_axis("flight").names.size() == FREE_FLIGHT_COUNT);
    CHECK(find_axis("transmittance").names.size() == TRANSMITTANCE_COUNT);
    CHECK(find_axis("nee").names.size() == NEE_CACHED + 1);
    CHECK(find_axis("emission").names.size() == EMISSION_AT_STEPS + 1);
    CHECK(find_axis("firstFlight").names.size() == FIRST_FLIGHT_SPLIT + 1);
    CHECK(find_choice(find_axis("flight"), "spectral") == FREE_FLIGHT_SPECTRAL);
    CHECK(find_choice(find_axis("flight"), "march") == FREE_FLIGHT_MARCH);
    CHECK(find_choice(find_axis("transmittance"), "telescoping") == TRANSMITTANCE_TELESCOPING);
    CHECK(find_choice(find_axis("transmittance"), "ratio") == TRANSMITTANCE_RATIO);
    CHECK_THROWS_WITH(find_axis("fligth"), "unknown axis 'fligth'; did you mean flight?");
    CHECK_THROWS_WITH(find_choice(find_axis("flight"), "wieghted"),
                      "unknown flight 'wieghted'; did you mean weighted?");
}

TEST_CASE("integrators are asked for by name and choices", "[cpu][method]") {
    const IntegratorRequest request = parse_integrator("ratioTracking:flight=weighted:nee=tentative");
    CHECK(request.name == "ratioTracking");
    CHECK(request.choices.free_flight == FREE_FLIGHT_WEIGHTED);
    CHECK(request.choices.nee == NEE_TENTATIVE);
    CHECK_FALSE(request.choices.transmittance);
    CHECK(integrator_text(request) == "ratioTracking:flight=weighted:nee=tentative");
    CHECK(parse_integrator(":emission=steps").name.empty());
    CHECK_THROWS_WITH(parse_integrator("ratiotracking"), Catch::Contains("did you mean ratioTracking?"));
    CHECK_THROWS_WITH(parse_integrator("ratioTracking:weighted"), Catch::Contains("axis=choice"));
    CHECK_THROWS_WITH(parse_integrator("ratioTracking:"), Catch::Contains("axis=choice"));
    CHECK_THROWS_WITH(parse_integrator("ratioTracking:nee=none:nee=none"), "nee given twice");
}

// Both directions: the table's word on its bias is what comes out at varying density, and what is biased says so.
TEST_CASE("every integrator renders some medium", "[cpu][method]") {
    std::set<std::string> names;
    for (const Integrator& integrator : integrators()) {
        INFO(integrator.name);
        CHECK(names.insert(integrator.name).second);
        CHECK_FALSE(std::string(integrator.summary).empty());
        CHECK_FALSE(std::string(integrator.source).empty());
        const bool homogeneous =
            integrator.origin == Integrator::Origin::thesis_models && !(integrator.adjustments & adjust_default_noise);
        const Method method = method_of(integrator.name, homogeneous ? FIELD_CONSTANT : FIELD_GRID);
        CHECK(method.integrator == integrator.name);
        CHECK(method.scattering == integrator.scattering);
        CHECK(method.free_flight == integrator.free_flight);
        CHECK(method.nee == integrator.nee);
        CHECK(method.transmittance == integrator.transmittance);
        CHECK(method.warnings.empty());
        CHECK(method.biased.empty() == std::string(integrator.biased).empty());
        CHECK(method.biased.empty() == (method.biases == bias_none));
    }
    CHECK(names.size() == 21);
}

TEST_CASE("the best unbiased choice is taken where none is named", "[cpu][method]") {
    CHECK(method_of("", FIELD_GRID).integrator == "cachedRatioTracking");
    CHECK(method_of("", FIELD_CONSTANT).integrator == "ratioTracking");
    CHECK(method_of("", FIELD_GRID, false).integrator == "deltaTracking");
    // A surface that shines is a light, where it can be looked for.
    Scene room;
    room.surfaces.resize(1);
    room.surfaces[0].emission = Rgb(1.0);
    room.surfaces[0].shape = RectangleSurface{};
    CHECK(choose_integrator(room).name == std::string("ratioTracking"));
    room.surfaces[0].shape = RectangleSurface{}.triangles();
    CHECK(choose_integrator(room).name == std::string("ratioTracking"));
    CHECK(choose_method(with_preset(room)).by_chance.empty());
    CHECK(with_preset(room).lights.size() == 1);
    CHECK(with_preset(with_preset(room)).lights.size() == 1);
    room.settings.integrator = "bidirectional";
    CHECK(choose_method(with_preset(room)).paths == PATHS_CAMERA);
    room.settings.integrator = "deltaTracking";
    CHECK(with_preset(room).lights.empty());
    CHECK_THAT(choose_method(with_preset(room)).by_chance, Catch::Contains("of any surface without shadow rays"));
    room.settings.choices.paths = PATHS_BOTH; // which looks, too
    CHECK(with_preset(room).lights.size() == 1);
    room.settings = {};
    room.surfaces[0].shape = PlaneSurface{};
    CHECK(choose_integrator(room).name == std::string("deltaTracking"));
    CHECK_THAT(choose_method(with_preset(room)).by_chance, Catch::Contains("light of planes"));
    CHECK(method_of(":flight=weighted", FIELD_GRID).integrator == "cachedRatioTracking:flight=weighted");
    CHECK_NOTHROW(choose_method(Scene{}));
    for (const Integrator& integrator : integrators()) {
        Scene empty;
        empty.settings.integrator = integrator.name;
        CHECK_NOTHROW(choose_method(with_preset(empty)));
    }
}

TEST_CASE("homogeneous media are rendered analytically unless told otherwise", "[cpu][method]") {
    for (const char* name : {"ratioTracking", "regularTracking", "spectralTracking", "decompositionTracking",
                             "unbiasedRayMarching", "deltaTrackingNEE"}) {
        const Method method = method_of(name, FIELD_CONSTANT);
        CHECK(method.free_flight == FREE_FLIGHT_ANALYTIC);
        CHECK(method.transmittance == TRANSMITTANCE_ANALYTIC);
        CHECK(method.nee == NEE_COLLISIONS);
    }
    const Method told = method_of("ratioTracking:flight=weighted:transmittance=residual", FIELD_CONSTANT);
    CHECK(told.free_flight == FREE_FLIGHT_WEIGHTED);
    CHECK(told.transmittance == TRANSMITTANCE_RESIDUAL);
    const Method regular = method_of("ratioTracking:flight=regular:transmittance=regular", FIELD_CONSTANT);
    CHECK(regular.free_flight == FREE_FLIGHT_ANALYTIC);
    CHECK(regular.transmittance == TRANSMITTANCE_ANALYTIC);
    // A march knows the optical depth of constant density.
    const Method march = method_of("rayMarching", FIELD_CONSTANT);
    CHECK(march.free_flight == FREE_FLIGHT_MARCH);
    CHECK(march.biased.empty());
    CHECK_FALSE(method_of("homogeneousRayMarcherImproved", FIELD_CONSTANT).biased.empty());
    CHECK(method_of("homogeneousRayMarcherImproved", FIELD_CONSTANT, false).biased.empty());
}

TEST_CASE("what cannot be is an error with its remedy", "[cpu][method]") {
    for (int field : {FIELD_GRID, FIELD_NOISE}) {
        CHECK_THAT(error_of("densitySampling", field),
                   Catch::Contains("constant density") && Catch::Contains("; use "));
        CHECK_THAT(error_of("ratioTracking:flight=analytic", field), Catch::Contains("flight delta"));
        CHECK_THAT(error_of("ratioTracking:transmittance=analytic", field), Catch::Contains("transmittance ratio"));
        CHECK_THAT(error_of("homogeneousRayMarcherImproved", field), Catch::Contains("or march"));
        CHECK(error_of("homogeneousRayMarcherImproved:transmittance=march", field) == "no error");
    }
    CHECK_THAT(error_of("regularTracking", FIELD_NOISE), Catch::Contains("voxel to voxel"));
    CHECK_THAT(error_of("ratioTracking:transmittance=regular", FIELD_NOISE), Catch::Contains("voxel to voxel"));
    CHECK(error_of("regularTracking", FIELD_GRID) == "no error");
    CHECK_THAT(error_of("deltaTracing", FIELD_GRID), Catch::Contains("did you mean deltaTracking?"));
}

TEST_CASE("several media have no voxels and no control density in common", "[cpu][method]") {
    const auto method = [](const std::string& request) {
        Scene scene = requested(request, FIELD_GRID);
        scene.volumes.push_back(scene.volumes.front());
        return choose_method(with_preset(scene));
    };
    const Method regular = method("regularTracking");
    CHECK(regular.free_flight == FREE_FLIGHT_DELTA);
    CHECK(regular.transmittance == TRANSMITTANCE_RATIO);
    REQUIRE(regular.warnings.size() == 2);
    CHECK_THAT(regular.warnings[0], Catch::Contains("flights are delta: several volumes share no voxels"));
    CHECK_THAT(regular.warnings[1], Catch::Contains("by ratio tracking: several volumes share no voxels"));
    const Method flights = method("ratioTracking:flight=decomposition");
    CHECK(flights.free_flight == FREE_FLIGHT_DELTA);
    CHECK_THAT(warning_of(flights), Catch::Contains("flights are delta: several volumes have no control density"));
    const Method looks = method("residualRatioTracking");
    CHECK(looks.transmittance == TRANSMITTANCE_RATIO);
    CHECK_THAT(warning_of(looks), Catch::Contains("by ratio tracking: several volumes have no control density"));
}

TEST_CASE("unused transmittance is no obstacle", "[cpu][method]") {
    const Method method = method_of("densitySampling:flight=march", FIELD_GRID);
    CHECK(method.scattering == SCATTERING_NONE);
    CHECK(method.nee == NEE_NONE);
    CHECK(is_through(method));
    CHECK_THAT(warning_of(method_of("deltaTracking:transmittance=residual", FIELD_GRID)),
               Catch::Contains("no shadow rays"));
}

TEST_CASE("chromatic extinction takes spectral flights", "[cpu][method]") {
    for (const char* name : {"ratioTracking", "weightedTracking", "decompositionTracking"}) {
        Scene scene = scene_of(name, FIELD_GRID);
        make_chromatic(scene);
        const Method method = choose_method(scene);
        CHECK(method.free_flight == FREE_FLIGHT_SPECTRAL);
        CHECK(method.warnings.empty());
    }
    Scene scene = requested("ratioTracking:flight=weighted", FIELD_GRID);
    make_chromatic(scene);
    CHECK_THAT(warning_of(choose_method(scene)), Catch::Contains("spectral"));
    scene = scene_of("ratioTracking", FIELD_CONSTANT);
    make_chromatic(scene);
    CHECK(choose_method(scene).free_flight == FREE_FLIGHT_ANALYTIC);
    // Only the sum counts, up to its rounding.
    scene.volumes.front().sigma_a = {0.3, 0.1, 0.8};
    scene.volumes.front().sigma_s = {0.6, 0.8, 0.1};
    CHECK_FALSE(has_chromatic_extinction(scene));
}

TEST_CASE("next-event estimation needs a light, scattering, and the right flights", "[cpu][method]") {
    CHECK(method_of("ratioTracking", FIELD_GRID, false).nee == NEE_NONE);
    CHECK(method_of("ratioTracking:scattering=none", FIELD_GRID).nee == NEE_NONE);
    CHECK_THAT(warning_of(method_of("ratioTracking:nee=tentative", FIELD_GRID, false)), Catch::Contains("no light"));
    Scene absorber = scene_of("ratioTracking", FIELD_GRID);
    absorber.volumes.front().sigma_s = Rgb(0.0);
    CHECK(choose_method(absorber).nee == NEE_NONE);

    CHECK(method_of("cachedRatioTracking", FIELD_GRID).nee == NEE_CACHED);
    CHECK(method_of("cachedRatioTracking", FIELD_NOISE).nee == NEE_CACHED);
    CHECK(method_of("cachedRatioTracking", FIELD_CONSTANT).nee == NEE_COLLISIONS);
    CHECK_THAT(warning_of(method_of("ratioTracking:nee=cached", FIELD_CONSTANT)), Catch::Contains("for grids"));
    CHECK(method_of("ratioNEE", FIELD_GRID).nee == NEE_TENTATIVE);
    const Method silent = method_of("ratioNEE", FIELD_CONSTANT);
    CHECK(silent.nee == NEE_COLLISIONS);
    CHECK(silent.warnings.empty());
    const Method told = method_of("regularTracking:nee=tentative", FIELD_GRID);
    CHECK(told.nee == NEE_COLLISIONS);
    CHECK_THAT(warning_of(told), Catch::Contains("no null collisions"));
    CHECK(method_of("ratioTracking:scattering=single", FIELD_GRID).nee == NEE_COLLISIONS);
    CHECK(method_of("deltaTracking:nee=collisions", FIELD_GRID).nee == NEE_COLLISIONS);
}

TEST_CASE("marches through the medium send shadow rays from every step", "[cpu][method]") {
    const Method single = method_of("rayMarching:scattering=single", FIELD_GRID);
    CHECK(is_through(single));
    CHECK(single.nee == NEE_TENTATIVE);
    CHECK(single.warnings.empty());
    CHECK(method_of("adaptiveRayMarching:scattering=single", FIELD_GRID).nee == NEE_TENTATIVE);
    CHECK_THAT(warning_of(method_of("nanoVDBSimple:nee=collisions", FIELD_GRID)), Catch::Contains("every step"));
    CHECK(method_of("nanoVDBSimple:nee=none", FIELD_GRID).nee == NEE_NONE);
    CHECK_FALSE(is_through(method_of("rayMarching", FIELD_GRID)));
    CHECK_FALSE(is_through(method_of("regularTracking:scattering=single", FIELD_GRID)));
    CHECK(is_through(method_of("deltaTracking:scattering=none", FIELD_CONSTANT)));
    Scene flat = scene_of("nanoVDBSimple", FIELD_GRID); // maxDepth 0: light cannot scatter even once
    flat.settings.max_depth = 0;
    CHECK(choose_method(flat).scattering == SCATTERING_NONE);
}

TEST_CASE("emission is estimated at steps where that is unbiased", "[cpu][method]") {
    const auto at = [](const std::string& request, int field, bool chromatic) {
        Scene scene = requested(request, field);
        scene.volumes.front().Le = Rgb(1.0);
        if (chromatic)
            make_chromatic(scene);
        return choose_method(scene);
    };
    CHECK(at("ratioTracking", FIELD_GRID, false).emission_at == EMISSION_AT_COLLISIONS);
    for (const char* request : {"ratioTracking:emission=steps", "regularTracking:emission=steps"})
        CHECK(at(request, FIELD_GRID, false).emission_at == EMISSION_AT_STEPS);
    CHECK(at("ratioTracking:emission=steps", FIELD_GRID, true).emission_at == EMISSION_AT_STEPS);
    const Method chromatic = at("regularTracking:emission=steps", FIELD_GRID, true);
    CHECK(chromatic.emission_at == EMISSION_AT_COLLISIONS);
    CHECK_THAT(warning_of(chromatic), Catch::Contains("flight spectral"));
    CHECK(at("nanoVDBEmission:emission=steps", FIELD_GRID, false).emission_at == EMISSION_AT_COLLISIONS);
    CHECK(method_of("ratioTracking:emission=steps", FIELD_GRID).emission_at == EMISSION_AT_COLLISIONS);
}

TEST_CASE("an even glow is a closed form where flights are, before what is darker", "[cpu][method]") {
    const auto at = [](double background, double glow, const char* integrator) {
        Scene scene =
            parse(fmt::format("<sphere/><sigma_a r='1' g='2' b='3'/><sigma_s>1</sigma_s><medium r='{0}' g='{0}' "
                              "b='{0}'/><backgroundColor r='{1}' g='{1}' b='{1}'/><integrator>{2}</integrator>",
                              glow, background, integrator));
        return choose_method(scene).emission_at;
    };
    CHECK(at(0.0, 1.0, "ratioTracking") == EMISSION_AT_STEPS);
    CHECK(at(0.24, 1.0, "ratioTracking") == EMISSION_AT_STEPS);
    CHECK(at(0.26, 1.0, "ratioTracking") == EMISSION_AT_COLLISIONS); // more than half of red's glow
    CHECK(at(0.0, 0.0, "ratioTracking") == EMISSION_AT_COLLISIONS);
    CHECK(at(0.0, 1.0, "rayMarching") == EMISSION_AT_COLLISIONS);
}

TEST_CASE("the stochastic filter serves null-collision estimators alone", "[cpu][method]") {
    for (const char* name : {"ratioTracking", "deltaTrackingNEE", "residualRatioTracking", "weightedTracking",
                             "spectralTracking", "decompositionTracking", "ratioNEE"})
        CHECK(method_of(name, FIELD_GRID).filter == Filter::stochastic);
    for (const char* name : {"rayMarching", "adaptiveRayMarching", "regularTracking", "unbiasedRayMarching",
                             "nanoVDBSimple", "ratioTracking:transmittance=march"}) {
        INFO(name);
        Scene scene = requested(name, FIELD_GRID);
        CHECK(choose_method(scene).filter == Filter::trilinear);
        CHECK(choose_method(scene).warnings.empty());
        scene.settings.filter = Filter::stochastic;
        CHECK(choose_method(scene).filter == Filter::trilinear);
        CHECK_THAT(warning_of(choose_method(scene)), Catch::Contains("exponential of the mean"));
        scene.settings.filter = Filter::nearest;
        CHECK(choose_method(scene).filter == Filter::nearest);
        CHECK(choose_method(scene).warnings.empty());
    }
    // Without a light nothing asks for the transmittance.
    CHECK(method_of("unbiasedRayMarching", FIELD_GRID, false).filter == Filter::stochastic);
}

TEST_CASE("a majorant below the density biases those that trust it", "[cpu][method]") {
    const auto biases = [](const std::string& request) {
        Scene scene = requested(request, FIELD_GRID);
        scene.settings.majorant_scale = 0.5;
        return choose_method(scene).biases;
    };
    for (const char* request : {"ratioTracking", "decompositionTracking", "weightedTracking:transmittance=delta"})
        CHECK(biases(request) == bias_majorant);
    for (const char* request : {"weightedTracking", "spectralTracking:transmittance=residual", "regularTracking"})
        CHECK(biases(request) == bias_none);
    CHECK(method_of("ratioTracking:transmittance=march", FIELD_GRID).biases == bias_shadow_steps);
    CHECK(method_of("rayMarching:transmittance=ratio", FIELD_GRID).biases == bias_flight_steps);
}

TEST_CASE("presets adjust the scene as the original's integrators did", "[cpu][method]") {
    Scene scene = scene_of("densitySampling", FIELD_CONSTANT);
    CHECK(with_preset(scene).volumes[0].sigma_s == Rgb(0.0));
    CHECK(choose_method(with_preset(scene)).material_colour);
    CHECK(with_preset(requested("densitySampling:scattering=multiple", FIELD_CONSTANT)).volumes[0].sigma_s == Rgb(0.5));

    scene = scene_of("homogeneousRayMarcherNEE", FIELD_CONSTANT);
    scene.volumes[0].g = 0.5;
    CHECK(with_preset(scene).volumes[0].g == 0.0);
    CHECK(with_preset(scene).warnings.size() == 1);
    CHECK(with_preset(with_preset(scene)).warnings.size() == 1);
    CHECK_FALSE(choose_method(scene).jitter);
    CHECK(method_of("homogeneousRayMarcherImproved", FIELD_CONSTANT).jitter);

    scene = scene_of("heterogeneousPerlinNoise", FIELD_CONSTANT);
    CHECK(with_preset(scene).volumes[0].noise);
    CHECK(choose_method(with_preset(scene)).transmittance == TRANSMITTANCE_MARCH);
    scene.volumes[0].noise = Noise{3.0};
    CHECK(with_preset(scene).volumes[0].noise->frequency == 3.0);
    scene = scene_of("heterogeneousPerlinNoise", FIELD_GRID);
    CHECK_FALSE(with_preset(scene).volumes[0].noise);
    CHECK(with_preset(scene).warnings.size() == 1);

    scene = scene_of("nanoVDBSimple", FIELD_GRID);
    CHECK(with_preset(scene).warnings.empty());
    scene.volumes[0].temperature.color = scene.volumes[0].Le = Rgb(1.0);
    CHECK_FALSE(emits(with_preset(scene)));
    CHECK(with_preset(scene).warnings.size() == 1);
    scene.settings.integrator = "nanoVDBEmission";
    CHECK(emits(with_preset(scene)));
}

TEST_CASE("what a picture is expected to show is no part of the hash", "[cpu][method]") {
    Scene scene;
    const std::string plain = scene_hash(scene);
    scene.expected = Expected{Rgb(1.0), Rgb(0.0), true};
    CHECK(scene_hash(scene) == plain);
}

TEST_CASE("the hash tells expectations apart, not estimators", "[cpu][method]") {
    const auto hash = [](const std::string& request, const auto& change) {
        Scene scene = requested(request, FIELD_GRID);
        change(scene);
        return scene_hash(scene);
    };
    const auto keep = [](Scene&) {};
    const std::string unbiased = hash("ratioTracking", keep);
    for (const Integrator& integrator : integrators()) {
        if (integrator.scattering != SCATTERING_MULTIPLE || integrator.nee == NEE_NONE)
            continue;
        INFO(integrator.name);
        CHECK((hash(integrator.name, keep) == unbiased) == std::string(integrator.biased).empty());
    }
    CHECK(hash("ratioTracking:emission=steps", keep) == unbiased);
    CHECK(hash("ratioTracking:scattering=single", keep) != unbiased);
    CHECK(hash("deltaTracking", keep) != unbiased); // leaves the light out
    CHECK(hash("deltaTracking", keep) == hash("ratioTracking", [](Scene& scene) { scene.lights.clear(); }));

    const auto step = [](Scene& scene) { scene.settings.march.step = 0.25; };
    const auto optical_step = [](Scene& scene) { scene.settings.march.optical_step = 0.25; };
    const auto jitter = [](Scene& scene) { scene.settings.march.jitter = false; };
    const auto majorant = [](Scene& scene) { scene.settings.majorant_scale = 0.5; };
    CHECK(hash("ratioTracking", step) == unbiased);
    CHECK(hash("unbiasedRayMarching", step) == unbiased);
    CHECK(hash("ratioTracking", majorant) != unbiased);
    CHECK(hash("weightedTracking", majorant) == unbiased);
    const std::string march = hash("rayMarching", keep);
    CHECK(hash("rayMarching", step) != march);
    CHECK(hash("rayMarching", jitter) != march);
    CHECK(hash("rayMarching", optical_step) == march);
    CHECK(hash("adaptiveRayMarching", optical_step) != hash("adaptiveRayMarching", keep));
    CHECK(hash("rayMarching:transmittance=residual", keep) == hash("rayMarching:transmittance=ratio", keep));
    CHECK(hash("rayMarching:transmittance=residual", keep) != march);

    CHECK(hash("ratioTracking:transmittance=march", keep) != hash("ratioTracking:transmittance=jackknife", keep));
    const auto glowing = [](Scene& scene) {
        scene.surfaces.emplace_back().shape = BallSurface{{3.0, 0.0, 0.0}, 0.5};
        scene.surfaces.back().emission = Rgb(1.0);
    };
    // Where light scatters once, looks alone bring what shines to what scatters.
    CHECK(hash("ratioTracking:scattering=single", glowing) != hash("deltaTracking:scattering=single", glowing));

    Scene noise = scene_of("ratioTracking", FIELD_NOISE), other = noise;
    other.volumes[0].noise->octaves = 3;
    CHECK(scene_hash(noise) != scene_hash(other));
    CHECK(scene_hash(noise) != scene_hash(scene_of("ratioTracking", FIELD_CONSTANT)));
    other = scene_of("ratioTracking", FIELD_CONSTANT);
    other.volumes[0].shape = MeshFiles{{"/a/ball.obj"}};
    noise = other;
    noise.volumes[0].shape = MeshFiles{{"/b/ball.obj"}};
    CHECK(scene_hash(noise) == scene_hash(other));
    noise.volumes[0].shape = MeshFiles{{"/b/ball.obj", "/b/cube.obj"}};
    CHECK(scene_hash(noise) != scene_hash(other));
}

// Of single scattering by marches shadow rays are all there is: preset by preset.
TEST_CASE("what shines lights the marches that look for light", "[cpu][method]") {
    Scene scene = scene_of("deltaTracking", FIELD_CONSTANT);
    scene.settings.choices.scattering = SCATTERING_SINGLE;
    scene.surfaces.emplace_back().shape = BallSurface{{3.0, 0.0, 0.0}, 0.5};
    scene.surfaces.back().emission = Rgb(1.0);
    const auto lamps = [&] { return with_preset(scene).lights.size() - 1; };
    CHECK(lamps() == 0); // flights meet it
    scene.settings.choices.free_flight = FREE_FLIGHT_MARCH;
    CHECK(choose_method(with_preset(scene)).nee == NEE_TENTATIVE);
    CHECK(lamps() == 1);
    scene.settings.choices.nee = NEE_NONE;
    CHECK(lamps() == 0);
}

TEST_CASE("what shines is met where there is no end to march to", "[cpu][method]") {
    Scene scene = scene_of("deltaTracking", FIELD_CONSTANT);
    scene.volumes.front().shape = Everywhere{};
    scene.settings.choices.scattering = SCATTERING_SINGLE;
    scene.settings.choices.free_flight = FREE_FLIGHT_MARCH;
    scene.surfaces.emplace_back().shape = BallSurface{{3.0, 0.0, 0.0}, 0.5};
    scene.surfaces.back().emission = Rgb(1.0);
    const Scene taken = with_preset(scene);
    CHECK(choose_method(taken).nee == NEE_NONE);
    CHECK(taken.lights.size() == 1);
    CHECK(taken.surfaces.back().emission == Rgb(1.0));
}

TEST_CASE("a scene's hash has the colours of models where they show", "[cpu][method]") {
    const TestDirectory directory;
    const std::filesystem::path model = directory.write("a.obj", "mtllib a.mtl\n");
    const auto hash = [&](const char* colour, const std::string& integrator) {
        directory.write("a.mtl", std::string("newmtl m\nKd ") + colour + "\n");
        Scene scene = scene_of(integrator, FIELD_CONSTANT);
        scene.volumes[0].shape = MeshFiles{{model}};
        return scene_hash(scene);
    };
    CHECK(hash("1 0 0", "densitySampling") != hash("1 0 0.25", "densitySampling"));
    CHECK(hash("1 0 0", "ratioTracking") == hash("1 0 0.25", "ratioTracking"));
}
