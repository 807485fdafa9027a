// The scalar reference: whole paths made of every choice along the axes, against quadrature and each other.
#include <catch2/catch.hpp>

#include "tests/reference/test_media.h"

using namespace reference;
using vkvol::Rgb;

namespace {

const vkvol::DirectionalLight sun{glm::normalize(glm::dvec3(1, 2, -0.5)), {3.0, 2.0, 4.0}};

// The sample's medium under `scene`'s light, background and settings.
World world_of(const Sample& sample, vkvol::Scene scene) {
    scene.settings.majorant_scale = sample.medium.majorant_scale;
    scene.settings.roulette_threshold = 0.1;
    return make_world(scene, sample.medium);
}

vkvol::Scene scene_of(int scattering, int free_flight) {
    vkvol::Scene scene;
    scene.settings.choices.scattering = scattering;
    scene.settings.choices.free_flight = free_flight;
    return scene;
}

// Constant emission and, on grids, more of it where another field is hot.
void set_emission(Sample& sample) {
    Emission& emission = sample.medium.emission;
    emission.constant = {0.5, 0.2, 0.1};
    emission.temperature.color = {1.0, 2.0, 0.5};
    const auto value = [](glm::ivec3 i) { return 0.5 + 0.25 * ((i.x + 2 * i.y + 3 * i.z) % 5); };
    emission.grid = make_grid({-4, -4, -4}, {4, 4, 4}, value, 0.9 * sample.medium.grid()->linear, sample.ray.at(10.0));
}

struct FlightCase {
    Kind kind;
    int free_flight;
    double majorant_scale;
};

// Every unbiased flight, in media that it is for.
const std::vector<FlightCase>& unbiased() {
    static const std::vector<FlightCase> cases{{Kind::box, FREE_FLIGHT_ANALYTIC, 1},
                                               {Kind::chromatic_box, FREE_FLIGHT_ANALYTIC, 1},
                                               {Kind::rough_grid, FREE_FLIGHT_REGULAR, 1},
                                               {Kind::chromatic_grid, FREE_FLIGHT_REGULAR, 1},
                                               {Kind::rough_grid, FREE_FLIGHT_DELTA, 1},
                                               {Kind::noise_mesh, FREE_FLIGHT_DELTA, 2},
                                               {Kind::rough_grid, FREE_FLIGHT_WEIGHTED, 0.7},
                                               {Kind::rough_grid, FREE_FLIGHT_DECOMPOSITION, 1},
                                               {Kind::chromatic_grid, FREE_FLIGHT_SPECTRAL, 1},
                                               {Kind::chromatic_noise, FREE_FLIGHT_SPECTRAL, 1},
                                               {Kind::chromatic_box, FREE_FLIGHT_SPECTRAL, 2}};
    return cases;
}

} // namespace

TEST_CASE("the white furnace holds for every flight", "[cpu][reference]") {
    const auto check = [](const FlightCase& c) {
        CAPTURE(int(c.kind), c.free_flight, c.majorant_scale);
        Sample sample = make_sample(c.kind, c.majorant_scale);
        sample.medium.albedo = Rgb(1.0);
        sample.medium.g = 0.3;
        vkvol::Scene scene = scene_of(SCATTERING_MULTIPLE, c.free_flight);
        scene.background = {1.0, 0.5, 2.0};
        const World world = world_of(sample, scene);
        REQUIRE(world.method.free_flight == c.free_flight);
        CHECK(sample_ray(world, sample.ray, 8000, 211).z(scene.background) < 4.0);
    };
    for (const FlightCase& c : unbiased())
        check(c);
    // Marches lose nothing either, however long their steps; chromatic ones weight what their samples let through.
    for (const int march : {FREE_FLIGHT_MARCH, FREE_FLIGHT_ADAPTIVE}) {
        check({Kind::rough_grid, march, 1});
        check({Kind::chromatic_noise, march, 1});
    }
}

TEST_CASE("emission at steps and at collisions have the mean of the quadrature", "[cpu][reference]") {
    const int emission = GENERATE(EMISSION_AT_COLLISIONS, EMISSION_AT_STEPS);
    for (const FlightCase& c : unbiased()) {
        if (c.free_flight == FREE_FLIGHT_ANALYTIC) // marches through: tested below
            continue;
        CAPTURE(emission, int(c.kind), c.free_flight, c.majorant_scale);
        Sample sample = make_sample(c.kind, c.majorant_scale);
        sample.medium.emission.constant = {0.5, 0.2, 0.1};
        if (is_grid(c.kind))
            set_emission(sample);
        vkvol::Scene scene = scene_of(SCATTERING_NONE, c.free_flight);
        scene.settings.choices.emission = emission;
        scene.background = {0.3, 0.1, 0.2};
        const World world = world_of(sample, scene);
        const bool chromatic_depth = depth_sampled(c.free_flight) && is_chromatic(c.kind);
        REQUIRE(world.method.emission == (chromatic_depth ? EMISSION_AT_COLLISIONS : emission));
        const Rgb expected = unscattered_quadrature(sample.medium, scene.background, sample.ray, 4);
        CHECK(sample_ray(world, sample.ray, 20000, 223).z(expected) < 4.0);
    }
}

TEST_CASE("emission of scattered paths does not depend on where it is estimated", "[cpu][reference]") {
    for (const FlightCase& c : unbiased()) {
        CAPTURE(int(c.kind), c.free_flight, c.majorant_scale);
        Sample sample = make_sample(c.kind, c.majorant_scale);
        sample.medium.emission.constant = {0.5, 0.2, 0.1};
        if (is_grid(c.kind))
            set_emission(sample);
        vkvol::Scene scene = scene_of(SCATTERING_MULTIPLE, c.free_flight);
        const RgbMean at_collisions = sample_ray(world_of(sample, scene), sample.ray, 8000, 227);
        scene.settings.choices.emission = EMISSION_AT_STEPS;
        const RgbMean at_steps = sample_ray(world_of(sample, scene), sample.ray, 8000, 229);
        CHECK(z_between(at_collisions, at_steps) < 4.0);
    }
}

TEST_CASE("single scattering of every flight has the mean of the quadrature", "[cpu][reference]") {
    const int nee = GENERATE(NEE_COLLISIONS, NEE_TENTATIVE);
    for (const FlightCase& c : unbiased()) {
        if (nee == NEE_TENTATIVE && depth_sampled(c.free_flight))
            continue;
        CAPTURE(nee, int(c.kind), c.free_flight, c.majorant_scale);
        Sample sample = make_sample(c.kind, c.majorant_scale);
        sample.medium.g = 0.4;
        sample.medium.emission.constant = {0.05, 0.1, 0.02};
        vkvol::Scene scene = scene_of(SCATTERING_SINGLE, c.free_flight);
        scene.settings.integrator = "ratioTracking";
        scene.settings.choices.nee = nee;
        scene.lights = {sun};
        scene.background = {0.3, 0.1, 0.2};
        const World world = world_of(sample, scene);
        REQUIRE(world.method.nee == nee);
        const Rgb once = single_scattering_quadrature(sample.medium, sun, sample.ray, is_grid(c.kind) ? 2 : 1);
        const Rgb expected = once + unscattered_quadrature(sample.medium, scene.background, sample.ray);
        // The background is seen through the medium only, as in the quadrature.
        CHECK(sample_ray(world, sample.ray, 20000, 233).z(expected) < 4.0);
    }
}

TEST_CASE("all flights and shadow rays see the same multiple scattering", "[cpu][reference][long]") {
    const bool chromatic = GENERATE(false, true);
    Sample sample = make_sample(chromatic ? Kind::chromatic_grid : Kind::rough_grid);
    sample.medium.g = 0.4;
    set_emission(sample);
    vkvol::Scene scene;
    scene.lights = {sun};
    scene.background = {0.3, 0.1, 0.2};
    scene.settings.integrator = "regularTracking";
    const RgbMean expected = sample_ray(world_of(sample, scene), sample.ray, 40000, 239);
    for (const char* name :
         {"ratioTracking", "cachedRatioTracking", "ratioNEE", "deltaTrackingNEE", "weightedTracking",
          "decompositionTracking", "spectralTracking", "residualRatioTracking", "unbiasedRayMarching"}) {
        CAPTURE(chromatic, name);
        scene.settings.integrator = name;
        CHECK(z_between(sample_ray(world_of(sample, scene), sample.ray, 10000, 241), expected) < 4.0);
    }
    for (const char* name : {"rayMarching", "adaptiveRayMarching"}) { // of short steps
        CAPTURE(chromatic, name);
        scene.settings.integrator = name;
        scene.settings.march.step = 0.1; // voxels
        CHECK(z_between(sample_ray(world_of(sample, scene), sample.ray, 10000, 251), expected) < 4.0);
    }
}

TEST_CASE("marches through the medium approach the quadrature", "[cpu][reference]") {
    const Kind kind = GENERATE(Kind::rough_grid, Kind::chromatic_grid, Kind::noise_mesh, Kind::chromatic_box);
    const int free_flight = GENERATE(FREE_FLIGHT_MARCH, FREE_FLIGHT_ADAPTIVE);
    CAPTURE(int(kind), free_flight);
    Sample sample = make_sample(kind);
    sample.medium.g = -0.4;
    sample.medium.emission.constant = {0.5, 0.2, 0.1};
    vkvol::Scene scene = scene_of(SCATTERING_SINGLE, free_flight);
    scene.settings.choices.transmittance = is_grid(kind)              ? TRANSMITTANCE_REGULAR
                                           : kind == Kind::noise_mesh ? TRANSMITTANCE_RATIO
                                                                      : TRANSMITTANCE_ANALYTIC;
    scene.settings.integrator = "ratioTracking";
    scene.lights = {sun};
    scene.background = {0.3, 0.1, 0.2};
    scene.settings.march.step = 0.02;
    scene.settings.march.optical_step = 0.01;
    const Rgb once = single_scattering_quadrature(sample.medium, sun, sample.ray, is_grid(kind) ? 2 : 1);
    const Rgb unscattered = unscattered_quadrature(sample.medium, scene.background, sample.ray);
    const RgbMean both = sample_ray(world_of(sample, scene), sample.ray, 200, 257);
    for (int i = 0; i < 3; ++i) { // a step of optical depth x errs by a share of order x
        CHECK(both.channel[i].mean() ==
              Approx(once[i] + unscattered[i]).epsilon(0.004).margin(4.0 * both.channel[i].standard_error()));
    }
    scene.settings.choices.scattering = SCATTERING_NONE;
    const RgbMean alone = sample_ray(world_of(sample, scene), sample.ray, 200, 263);
    for (int i = 0; i < 3; ++i)
        CHECK(alone.channel[i].mean() == Approx(unscattered[i]).epsilon(1e-3));
}

TEST_CASE("density sampling is exact", "[cpu][reference]") {
    Sample sample = make_sample(Kind::chromatic_box);
    sample.medium.emission.constant = {0.5, 0.2, 0.1};
    vkvol::Scene scene;
    scene.settings.integrator = "densitySampling";
    scene.background = {0.3, 0.1, 0.2};
    Rng rng = stream(269);
    const Rgb L = radiance(world_of(sample, scene), sample.ray, 1.0, 0.0, rng);
    CHECK(glm::distance(L, unscattered_quadrature(sample.medium, scene.background, sample.ray)) < 1e-12);
    CHECK(rng.draw == 0u);
}

TEST_CASE("a pixel's first flight chooses its channel at random", "[cpu][reference]") {
    vkvol::Volume v = box({10, 10, 2}, 0.0, 0.0);
    v.sigma_a = {0.1, 0.3, 1.0};
    v.Le = {1.0, 2.0, 0.5};
    vkvol::Scene scene = pixel_scene(v, 10.0);
    scene.background = {0.3, 0.1, 0.2};
    const Rgb expected = unscattered_quadrature(load(v), scene.background, {{0, 0, 10}, {0, 0, -1}});
    CHECK(sample_pixel_rgb(load_world(scene), 20000, 271).z(expected) < 4.0);
}

TEST_CASE("roulette keeps the mean", "[cpu][reference]") {
    Sample sample = make_sample(GENERATE(Kind::rough_grid, Kind::chromatic_grid));
    sample.medium.sigma_t *= 3.0;
    vkvol::Scene scene = scene_of(SCATTERING_MULTIPLE, FREE_FLIGHT_DELTA);
    scene.background = {0.3, 0.1, 0.2};
    World world = world_of(sample, scene);
    world.scene.settings.roulette_threshold = 0.0;
    const RgbMean without = sample_ray(world, sample.ray, 20000, 277);
    world.scene.settings.roulette_threshold = 0.9;
    CHECK(z_between(sample_ray(world, sample.ray, 20000, 281), without) < 4.0);

    // Marches through the medium play it below a throughput of 1e-3, and are exact where the density is constant.
    Sample dense = make_sample(Kind::box);
    dense.medium.sigma_t *= 5.0;
    const Rgb T = chromatic_transmittance(dense.medium, dense.ray);
    REQUIRE(T.x < 7e-4);
    REQUIRE(T.x > 1e-4);
    scene = scene_of(SCATTERING_NONE, FREE_FLIGHT_MARCH);
    scene.background = Rgb(1.0);
    CHECK(sample_ray(world_of(dense, scene), dense.ray, 5000, 283).z(T) < 4.0);
}
