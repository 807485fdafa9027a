// Pictures lit by lights of every kind, against the reference, which asks all lights everywhere and weights nothing;
// and the ways to share work between looks and flights, against each other.
#include <algorithm>
#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <numeric>

#include "shared/constants.h"
#include "support/agreement.h"
#include "support/images.h"
#include "support/scenes.h"
#include "support/statistics.h"
#include "support/test_device.h"
#include "support/thorough.h"
#include "tests/reference/reference.h"

using namespace vkvol;

namespace {

const SkyLight& sunset() {
    static const SkyLight sky = write_sky(sunset_map());
    return sky;
}

const SkyLight& square_sky() {
    static const SkyLight sky = write_sky(square_map(), SkyMapping::equal_area);
    return sky;
}

struct NamedLights {
    std::string name;
    std::vector<Light> lights;
};

// About the scenes below, whose media reach some 5 from the origin. None is within a medium: by distance sampling
// alone what a point gives has no variance there.
std::vector<NamedLights> all_lights() {
    const SunLight sun{glm::normalize(glm::dvec3(1.0, 2.0, 0.5)), {3.0, 2.5, 2.0}, 8.0};
    const PointLight point{{6.0, 5.0, 4.0}, {120.0, 90.0, 60.0}};
    const SpotLight spot{
        {0.0, 9.0, 3.0}, glm::normalize(glm::dvec3(0.0, -3.0, -1.0)), {200.0, 250.0, 300.0}, 40.0, 0.5};
    const SphereLight ball{{4.5, 5.5, 2.0}, 1.2, {14.0, 10.0, 6.0}};
    const DiskLight disk{{-5.0, 4.5, 2.0}, glm::normalize(glm::dvec3(5.0, -4.0, -2.0)), 1.5, {10.0, 12.0, 14.0}};
    const RectangleLight rectangle{{0.0, -6.0, 1.0}, {0.0, 0.0, 1.0}, {2.0, 0.0, 0.0}, {9.0, 6.0, 12.0}};
    return {
        {"directional lights",
         {sunlight({3.0, 2.5, 1.5}), DirectionalLight{glm::normalize(glm::dvec3(-2.0, 1.0, -0.5)), {1.0, 2.0, 4.0}}}},
        {"sun", {sun}},
        {"wide sun", {SunLight{sun.direction, sun.irradiance, 120.0}}},
        {"wide sun of a dark limb", {SunLight{sun.direction, sun.irradiance, 120.0, 1.0}}},
        {"point", {point}},
        {"spot", {spot}},
        {"sky", {sunset()}},
        {"square sky", {square_sky()}},
        {"ball", {ball}},
        {"disk", {disk}},
        {"rectangle", {rectangle}},
        {"everything", {sunlight(), sun, point, spot, ball, sunset(), disk, rectangle}}};
}

Scene lit_by(const Volume& volume, double width, const std::vector<Light>& lights, std::uint32_t spp) {
    Scene scene = scene_of(volume, width, 16, 25.0, glm::dvec3(0.0), {10.0, 25.0, -5.0});
    scene.background = {0.05, 0.1, 0.15};
    scene.lights = lights;
    scene.settings.spp = spp;
    scene.settings.filter = Filter::trilinear;
    return scene;
}

// Single scattering of the scene's one light, by quadrature along `across` by `across` rays through each pixel.
std::vector<Rgb> single_scattering(const Scene& scene, int across) {
    const reference::Medium medium = reference::load(scene.volumes.front(), Filter::trilinear);
    std::vector<Rgb> means;
    for (int y = 0; y < scene.picture.height; ++y)
        for (int x = 0; x < scene.picture.width; ++x) {
            Rgb sum(0.0);
            for (int k = 0; k < across * across; ++k)
                sum += reference::single_scattering_quadrature(medium, scene.lights.front(),
                                                               reference::camera_ray(scene.camera, scene.picture,
                                                                                     x + (k % across + 0.5) / across,
                                                                                     y + (k / across + 0.5) / across));
            means.push_back(sum / double(across * across));
        }
    return means;
}

Volume cloud(double g = 0.5) {
    return medium(cloud_file(), 2.0, 0.9, g);
}

} // namespace

TEST_CASE("every light equals the reference's, in a cloud", "[gpu][lights]") {
    for (const NamedLights& lit : in_turn(all_lights(), 0)) {
        const Scene scene = lit_by(cloud(), 11.0, lit.lights, 256);
        CHECK_AGREEMENT(agree(render_here(scene, 1).film, render_reference(scene, 2), lit.name + ", cloud"));
    }
}

TEST_CASE("every light equals the reference's, in a ball and in a mesh", "[gpu][lights][mesh]") {
    const Mesh bodies =
        join(make_box({-3.0, -1.0, -1.0}, {-0.5, 1.5, 1.0}, 1), make_box({0.5, -2.0, -2.0}, {3.0, 1.0, 1.0}, 1));
    std::vector<NamedLights> lights = in_turn(all_lights(), 1);
    if (!thorough())
        lights.push_back(all_lights().back()); // everything
    for (const NamedLights& lit : lights) {
        const Scene ball = lit_by(medium(Sphere{{0.1, -0.1, 0.0}, 2.0}, 1.5, 0.95, -0.4), 5.0, lit.lights, 256);
        CHECK_AGREEMENT(agree(render_here(ball, 3).film, render_reference(ball, 4), lit.name + ", ball"));
        if (lit.name != "everything" && !(thorough() && lit.name == "point"))
            continue; // what else there is to see in a mesh ends at no lamp
        const Scene mesh = lit_by(medium(write_mesh(bodies), 1.0, 0.8, 0.3), 8.0, lit.lights, 256);
        CHECK_AGREEMENT(agree(render_here(mesh, 5).film, render_reference(mesh, 6), lit.name + ", mesh"));
    }
}

// Software drivers read tables and skies as texels, unless they are too large. (GPUs do not.)
TEST_CASE("lights are the same as texels and as storage", "[gpu][lights][long]") {
    if (!test_device().is_cpu())
        return;
    RenderJob storage;
    storage.plan.most_texel_bytes = 1;
    for (const NamedLights& lit : all_lights()) {
        if (lit.name != "sky" && lit.name != "square sky" && lit.name != "everything")
            continue;
        CAPTURE(lit.name);
        const Scene scene = lit_by(medium(Sphere{{0.1, -0.1, 0.0}, 2.0}, 1.5, 0.95, -0.4), 5.0, lit.lights, 4);
        CHECK(same_bits(render_here(scene, 1).film, render_here(scene, 1, storage).film));
    }
}

// Shadow rays to a lamp in the midst end there, in every estimator. A hole around the lamp keeps the variance finite.
TEST_CASE("shadow rays end at a lamp within the medium", "[gpu][lights][long]") {
    GridRecipe shell = cloud_grid();
    const auto value = shell.value;
    shell.value = [value](glm::ivec3 i) {
        return glm::length(glm::dvec3(i) - glm::dvec3(0.0, 3.0, 2.0)) < 5.0 ? 0.0f : value(i);
    };
    const glm::dvec3 lamp = glm::dvec3(shell.linear * glm::dvec3(0.0, 3.0, 2.0)) + shell.translation;
    const Volume volume = medium(write_grid(shell), 2.0, 0.9, 0.3);
    Scene scene = lit_by(volume, 11.0, {PointLight{lamp, Rgb(30.0, 20.0, 10.0)}}, 192);
    scene.settings.integrator = "ratioTracking";
    const Film reference = render_reference(scene, 7);
    const std::vector<std::pair<int, int>> ways = {
        {TRANSMITTANCE_RATIO, NEE_COLLISIONS},   {TRANSMITTANCE_DELTA, NEE_COLLISIONS},
        {TRANSMITTANCE_REGULAR, NEE_COLLISIONS}, {TRANSMITTANCE_RESIDUAL, NEE_COLLISIONS},
        {TRANSMITTANCE_RATIO, NEE_TENTATIVE},    {TRANSMITTANCE_TELESCOPING, NEE_COLLISIONS},
        {TRANSMITTANCE_RATIO, NEE_CACHED}};
    for (const auto& [transmittance, nee] : in_turn(ways, 0)) {
        scene.settings.choices.transmittance = transmittance;
        scene.settings.choices.nee = nee;
        CHECK_AGREEMENT(agree(render_here(scene, 8).film, reference,
                              fmt::format("lamp, transmittance {}, nee {}", transmittance, nee)));
    }
}

// From along flights, in all shapes and with all that a look takes; by free flights alone the same, with more noise.
// As a searchlight does: looks from along a flight are drawn about where it begins, far before the medium.
TEST_CASE("a lamp at the eye lights what is before it", "[gpu][lights]") {
    const Volume fog = medium(Box{{0, 0, 0}, glm::dvec3(4.0)}, 0.2, 0.95, 0.0);
    Scene scene = lit_by(fog, 2.5, {PointLight{{0.0, 0.0, 2.5}, Rgb(20.0)}}, 1024);
    scene.camera.position = {0.0, 0.0, 2.5};
    scene.settings.choices.distance = DISTANCE_MIXED;
    const RenderResult result = render_here(scene, 55);
    CHECK(result.counts.non_finite == 0);
    CHECK_AGREEMENT(agree(result.film, render_reference(scene, 56), "a lamp at the eye"));
}

TEST_CASE("looks from along flights find what lights of a place give", "[gpu][lights]") {
    Volume chromatic = cloud();
    chromatic.sigma_s = {2.0, 1.0, 0.4};
    Volume noise = medium(Box{{0, 0, 0}, {6.0, 5.0, 6.0}}, 1.5, 0.9, 0.3);
    noise.noise = Noise{};
    const std::pair<const char*, Volume> volumes[] = {{"cloud", cloud()},
                                                      {"chromatic cloud", chromatic},
                                                      {"noise", noise},
                                                      {"ball", medium(Sphere{{0.1, -0.1, 0.0}, 3.0}, 0.7, 0.95, -0.4)}};
    std::vector<std::pair<std::string, Scene>> scenes;
    for (const auto& [name, volume] : volumes)
        for (const NamedLights& lit : all_lights()) {
            const bool is_cloud = name == std::string("cloud");
            if (lit.name == "everything" || (is_cloud && (lit.name == "spot" || lit.name == "ball")))
                scenes.emplace_back(fmt::format("{}, {}, from along flights", lit.name, name),
                                    lit_by(volume, 11.0, lit.lights, 128));
        }
    for (auto [name, scene] : in_turn(scenes, 1)) {
        scene.settings.choices.distance = DISTANCE_MIXED;
        CHECK_AGREEMENT(agree(render_here(scene, 51).film, render_reference(scene, 52), name));
    }
    Scene scene = lit_by(cloud(), 11.0, all_lights().back().lights, 128);
    const Film reference = render_reference(scene, 54);
    scene.settings.choices.distance = DISTANCE_MIXED;
    std::vector<std::pair<int, int>> flights{{FREE_FLIGHT_REGULAR, NEE_COLLISIONS}};
    for (const int flight : {FREE_FLIGHT_WEIGHTED, FREE_FLIGHT_DECOMPOSITION, FREE_FLIGHT_SPECTRAL})
        for (const int nee : {NEE_COLLISIONS, NEE_TENTATIVE})
            flights.push_back({flight, nee});
    for (const auto& [flight, nee] : in_turn(flights, 0)) {
        scene.settings.choices.free_flight = flight;
        scene.settings.choices.nee = nee;
        CHECK_AGREEMENT(agree(render_here(scene, 53).film, reference,
                              fmt::format("flight {}, nee {}, from along flights", flight, nee)));
    }
}

// Whose part of a flight, as single precision has it, is rounding.
TEST_CASE("looks from along flights leave what is far away to collisions", "[gpu][lights]") {
    Scene scene = lit_by(medium(Box{{0.0, 0.0, 0.0}, {4.0, 3.0, 3.0}}, 0.4, 0.9, 0.2), 5.0, {}, 512);
    scene.background = Rgb(0.0);
    scene.settings.integrator = "ratioTracking";
    for (const double apart : {1e6, 1e7, 5e7, 1e9}) {
        const glm::dvec3 place = apart * glm::normalize(glm::dvec3(0.9, 0.5, 0.1));
        scene.lights = {PointLight{place, Rgb(2.0 * apart * apart)}};
        scene.settings.choices.distance = DISTANCE_FLIGHTS;
        const Film flights = render_here(scene, 41).film;
        scene.settings.choices.distance = DISTANCE_MIXED;
        CHECK_AGREEMENT(agree(render_here(scene, 42).film, flights, fmt::format("a point {} away", apart)));
    }
}

// Only what is in the cone, or before the lamp, is drawn of a flight: rays across a cone, along it toward the lamp and
// away from it, within it and past its back. The rims are hard where light would be missed first.
TEST_CASE("looks from along flights know what a spot or a flat lamp lights", "[gpu][lights]") {
    const glm::dvec3 across = glm::normalize(glm::dvec3(0.3, -1.0, 0.2)), along(0.05, 0.02, -1.0);
    const std::pair<const char*, Light> lights[] = {
        {"across", SpotLight{{0.2, 1.4, -0.1}, across, Rgb(8.0), 20.0, 0.0}},
        {"away", SpotLight{{0.1, -0.1, 2.5}, glm::normalize(along), Rgb(8.0), 60.0, 0.0}},
        {"toward", SpotLight{{-0.1, 0.2, -1.2}, glm::normalize(-along), Rgb(4.0), 50.0, 0.0}},
        {"wide", SpotLight{{0.3, 0.2, 0.4}, across, Rgb(4.0), 170.0, 0.0}},
        {"half", SpotLight{{0.3, 0.2, 0.4}, across, Rgb(4.0), 180.0, 0.3}},
        {"disk", DiskLight{{0.5, 0.3, 0.1}, across, 0.4, Rgb(6.0)}},
        {"facing", RectangleLight{{-0.3, 0.1, 0.2}, {0.0, 0.0, 0.3}, {0.3, 0.0, 0.0}, Rgb(6.0)}}};
    for (const auto& [name, light] : in_turn(std::vector(std::begin(lights), std::end(lights)), 0)) {
        Scene scene = lit_by(medium(Sphere{{0.1, -0.1, 0.0}, 2.0}, 0.8, 0.9, 0.3), 5.0, {light}, 256);
        scene.settings.choices.distance = DISTANCE_FLIGHTS;
        Scene mixed = scene;
        mixed.settings.choices.distance = DISTANCE_MIXED;
        const Film expected = render_reference(scene, 61);
        CHECK_AGREEMENT(agree(render_here(mixed, 62).film, expected, fmt::format("{}, from along flights", name)));
        if (name != std::string("across"))
            continue;
        // By quadrature, once scattered: a sliver of the cone that were never drawn would be missed by a mean, not by
        // noise.
        std::get<SpotLight>(mixed.lights.front()).blend = 1.0; // smooth across a pixel
        mixed.background = Rgb(0.0);
        mixed.settings.max_depth = 1;
        mixed.settings.spp = 2048;
        const Film by_both = render_here(mixed, 63).film;
        CHECK_AGREEMENT(agree_with_means(by_both, single_scattering(mixed, 12), "a cone in fog"));
        // What it is for: a free flight ends in such a cone once in some ten times.
        const auto noise = [](const Film& film) {
            return std::accumulate(film.variance.begin(), film.variance.end(), 0.0,
                                   [](double sum, const glm::vec3& variance) { return sum + variance.y; });
        };
        Scene deep = mixed;
        mixed.settings.choices.distance = DISTANCE_FLIGHTS;
        CHECK(noise(by_both) < 0.1 * noise(render_here(mixed, 64).film));
        // Behind six mean free paths next to no flight comes to the cone, and what is found there by looks has to count
        // in full: a sample's variance over the squared mean is 65 here, and 600 if flights are taken to come there
        // always.
        deep.volumes.front().sigma_a *= 3.75;
        deep.volumes.front().sigma_s *= 3.75;
        const Film behind = render_here(deep, 65).film;
        const double squared = std::accumulate(behind.mean.begin(), behind.mean.end(), 0.0,
                                               [](double sum, const glm::vec3& mean) { return sum + mean.y * mean.y; });
        CHECK(deep.settings.spp * noise(behind) / squared < 200.0);
    }
}

// Near enough to the light that free flights alone would need a thousand times as many samples.
TEST_CASE("single scattering from a lamp in the fog equals the quadrature", "[gpu][lights][closed_form]") {
    const double tau = GENERATE(0.2, 2.0);
    Scene scene = scene_of(medium(Box{{0, 0, 0}, {2.0, 2.0, 2.0}}, tau, 0.9, 0.4), 1.2, 16, 20.0, glm::dvec3(0.0),
                           {10.0, -20.0, 0.0});
    scene.lights = {PointLight{{0.1, 0.9, 0.2}, Rgb(20.0)}};
    scene.settings.spp = 1024;
    scene.settings.max_depth = 1;
    CHECK_AGREEMENT(agree_with_means(render_here(scene, 55).film, single_scattering(scene, 4),
                                     fmt::format("a lamp in the fog, tau {}", tau)));
}

TEST_CASE("single scattering from lamps equals the quadrature", "[gpu][lights][closed_form]") {
    const Light light =
        GENERATE(Light(PointLight{{3.0, 2.5, 1.0}, Rgb(20.0)}),
                 Light(SpotLight{{0.0, 4.0, 2.0}, glm::normalize(glm::dvec3(0.0, -2.0, -1.0)), Rgb(60.0), 60.0, 1.0}));
    const double tau = GENERATE(0.1, 3.0);
    Scene scene = scene_of(medium(Box{{0, 0, 0}, {2.0, 2.0, 1.0}}, tau, 0.9, 0.4), 1.2, 16, 20.0, glm::dvec3(0.0),
                           {10.0, -20.0, 0.0});
    scene.lights = {light};
    scene.settings.spp = 2048;
    scene.settings.max_depth = 1;
    CHECK_AGREEMENT(agree_with_means(render_here(scene, 9).film, single_scattering(scene, 2),
                                     fmt::format("lamp {}, tau {}", light.index(), tau)));
}

// Looks are weighted by phase_eval and flights drawn by phase_sample: their sum tells whether these agree.
TEST_CASE("a furnace of a map of ones, of every phase function", "[gpu][lights][furnace][phase][long]") {
    const SkyLight ones = write_sky(make_map(8, 4, [](int, int) { return Rgb(1.0, 0.5, 2.0); }));
    for (const NamedPhase& phase : in_turn(all_phases(), 0, 3)) {
        Scene scene = lit_by(phase.of(medium(cloud_file(), 1.0, 1.0)), 11.0, {ones}, 64);
        scene.background = Rgb(0.0);
        RunningMean mean;
        for (const glm::vec3& pixel : render_here(scene, 15).film.mean)
            mean.add(pixel.z);
        CAPTURE(phase.name, mean.mean(), mean.standard_error());
        CHECK(t_test_p(mean, 2.0, 1e-5) > 1e-4);
    }
}

TEST_CASE("looks and flights find the same light, by every phase function", "[gpu][lights][agreement][phase][long]") {
    const SunLight sun{glm::normalize(glm::dvec3(1.0, 2.0, 0.5)), {5.0, 4.0, 3.0}, 60.0};
    std::uint32_t seed = 70;
    for (const NamedPhase& phase : all_phases()) {
        // Looks alone seldom find the peak of sharper ones, and seem too dark with too little noise.
        if (phase.name != "draine" &&
            (!thorough() || (phase.name != "doubleHenyeyGreenstein" && phase.name != "droplets 1")))
            continue;
        std::vector<Estimate> estimates;
        for (const int mis : {MIS_BALANCE, MIS_LIGHT, MIS_PHASE}) {
            const SphereLight ball{{5.5, 5.5, 2.0}, 2.5, Rgb(2.0)};
            Scene scene = lit_by(phase.of(medium(cloud_file(), 2.0, 0.9)), 11.0, {sun, sunset(), ball}, 256);
            scene.settings.integrator = "ratioTracking";
            scene.settings.choices.mis = mis;
            estimates.push_back({fmt::format("{}, mis {}", phase.name, mis), render_here(scene, seed++).film});
        }
        const PairwiseAgreement all = compare_all(estimates);
        CAPTURE(all.mean_pair, all.mean_z);
        CHECK(all.mean_z < z_limit(1e-3, 3.0 * 3.0 * double(all.pairs)));
    }
}

// What is scattered from all directions alike is what comes from all of them.
TEST_CASE("a furnace of a map of ones", "[gpu][lights][furnace][long]") {
    const SkyLight ones = write_sky(make_map(8, 4, [](int, int) { return Rgb(1.0, 0.5, 2.0); }));
    for (const double g : {0.0, 0.9, -0.7})
        for (const int mis : {MIS_BALANCE, MIS_POWER, MIS_LIGHT, MIS_PHASE}) {
            if (g <= 0.0 && mis != MIS_BALANCE)
                continue;
            Scene scene = lit_by(cloud(g), 11.0, {ones}, 64);
            scene.volumes.front() = medium(cloud_file(), 1.0, 1.0, g);
            scene.background = Rgb(0.0);
            scene.settings.choices.mis = mis;
            RunningMean mean;
            for (const glm::vec3& pixel : render_here(scene, 10).film.mean)
                mean.add(pixel.z);
            CAPTURE(g, mis, mean.mean(), mean.standard_error());
            CHECK(t_test_p(mean, 2.0, 1e-5) > 1e-4);
        }
}

TEST_CASE("a sky is seen where no medium is", "[gpu][lights][long]") {
    Scene scene = lit_by(cloud(), 40.0,
                         {sunset(), SunLight{glm::normalize(glm::dvec3(-1.0, 0.2, -2.0)), Rgb(2.0), 20.0, 0.8}}, 64);
    scene.camera.fov = 120.0;
    CHECK_AGREEMENT(agree(render_here(scene, 11).film, render_reference(scene, 12), "a sky around a cloud"));
    scene.volumes.clear();
    CHECK_AGREEMENT(agree(render_here(scene, 13).film, render_reference(scene, 14), "a sky alone"));
    SkyLight turned = square_sky();
    turned.rotation = 100.0;
    scene.lights = {turned};
    CHECK_AGREEMENT(agree(render_here(scene, 17).film, render_reference(scene, 18), "a square sky alone"));
}

// Before, within and behind the medium, one before another, through it and past it.
TEST_CASE("lamps are seen", "[gpu][lights]") {
    const std::vector<Light> lamps = {
        SphereLight{{0.5, 0.5, 8.0}, 0.6, {3.0, 1.0, 1.0}}, SphereLight{{-1.0, 0.5, 0.0}, 1.0, {1.0, 4.0, 1.0}},
        RectangleLight{{1.0, -1.0, -7.0}, {3.0, 0.0, 0.0}, {0.0, 4.0, 0.0}, {2.0, 2.0, 9.0}},
        DiskLight{{3.0, 2.0, 3.0}, {0.0, 0.0, 1.0}, 1.5, {5.0, 5.0, 0.0}}};
    std::vector<std::pair<const char*, int>> ways;
    for (const char* integrator : {"ratioTracking", "ratioNEE"})
        for (const int scattering : {SCATTERING_NONE, SCATTERING_SINGLE, SCATTERING_MULTIPLE})
            ways.emplace_back(integrator, scattering);
    for (const auto& [integrator, scattering] : in_turn(ways, 2)) {
        Scene scene = lit_by(cloud(), 12.0, lamps, 192);
        scene.camera = scene_of(cloud(), 12.0, 16, 25.0).camera;
        scene.settings.integrator = integrator;
        scene.settings.choices.scattering = scattering;
        CHECK_AGREEMENT(agree(render_here(scene, 31).film, render_reference(scene, 32),
                              fmt::format("lamps, {}, scattering {}", integrator, scattering)));
    }
    Scene absorbing = lit_by(medium(Sphere{{0, 0, 0}, 2.0}, 0.7, 0.0), 12.0, lamps, 64);
    CHECK_AGREEMENT(agree(render_here(absorbing, 33).film, render_reference(absorbing, 34), "lamps and an absorber"));
    absorbing.settings.choices.scattering = SCATTERING_NONE; // flights go through at once
    CHECK_AGREEMENT(agree(render_here(absorbing, 35).film, render_reference(absorbing, 36), "lamps, straight on"));
    const Mesh cube = make_box({-1.5, -1.5, -1.5}, {1.5, 1.5, 1.5}, 1);
    Scene mesh = lit_by(medium(write_mesh(cube), 1.0, 0.5), 12.0, lamps, 64);
    mesh.camera = scene_of(cloud(), 12.0, 16, 25.0).camera; // the first lamp is before the cube
    CHECK_AGREEMENT(agree(render_here(mesh, 37).film, render_reference(mesh, 38), "lamps and a mesh"));
    absorbing.volumes.clear();
    CHECK_AGREEMENT(agree(render_here(absorbing, 35).film, render_reference(absorbing, 36), "lamps alone"));
}

// One behind another. In empty space it is half of the time by their light that one is chosen, so that a sample is as
// far from the mean as p / (1 - p) has it, of p of the bright one about 3/4; and what a wall hides of it is no more
// than twice as rare as by number.
TEST_CASE("lamps before one another are seen with bounded noise", "[gpu][lights][surfaces]") {
    Scene scene = lit_by({}, 1.0,
                         {DiskLight{{0.0, 0.0, 5.0}, {0.0, 0.0, 1.0}, 9.0, Rgb(0.0)},
                          RectangleLight{{0.0, 0.0, 2.0}, {5.0, 0.0, 0.0}, {0.0, 5.0, 0.0}, Rgb(1.0)},
                          SphereLight{{0.0, 0.0, -5.0}, 3.0, Rgb(1000.0)}},
                         4096);
    scene.camera = Camera{};
    scene.camera.position = {0.0, 0.0, 12.0};
    scene.camera.fov = 5.0;
    scene.picture = {4, 4, 0.0, 0.0, 4.0, 4.0};
    scene.volumes.clear();
    scene.background = Rgb(0.0);
    const auto relative_variance = [](const Film& film, float truth) {
        double sum = 0.0, mean = 0.0;
        for (std::size_t i = 0; i < film.mean.size(); ++i) {
            sum += 4096.0 * film.variance[i].x / film.mean.size();
            mean += film.mean[i].x / double(film.mean.size());
        }
        CHECK(mean == Approx(truth).epsilon(0.01));
        return sum / (mean * mean);
    };
    CHECK(relative_variance(render_here(scene, 40).film, 1001.0f) == Approx(1.0 / 3.0).epsilon(0.05));
    Surface wall;
    wall.shape = RectangleSurface{{0.0, 0.0, 0.0}, {9.0, 0.0, 0.0}, {0.0, 9.0, 0.0}};
    wall.material.color = Rgb(0.0);
    scene.surfaces = {wall};
    CHECK(relative_variance(render_here(scene, 41).film, 1.0f) == Approx(3.0).epsilon(0.05));
}

// A hundred long, and lit close by its end: the variance of a look is 7 squared means there, and 2800 if the way to its
// middle says how large it is from here. A ray scatters once in 5.
TEST_CASE("light from the end of a long lamp has bounded noise", "[gpu][lights]") {
    Scene scene = lit_by(medium(Sphere{{49.5, 0.01, 0.0}, 0.004}, 30.0, 1.0, 0.0), 1.0,
                         {RectangleLight{{0.0, 0.0, 0.0}, {0.0, 0.0, 0.005}, {50.0, 0.0, 0.0}, Rgb(1.0)}}, 4096);
    scene.camera = Camera{};
    scene.camera.position = {49.5, 0.01, 1.0};
    scene.camera.projection = Projection::orthographic;
    scene.camera.view_height = 0.004;
    scene.picture = {2, 2, 0.0, 0.0, 2.0, 2.0};
    scene.background = Rgb(0.0);
    scene.settings.choices.scattering = SCATTERING_SINGLE;
    const Film film = render_here(scene, 41).film;
    for (std::size_t i = 0; i < film.mean.size(); ++i) {
        const double relative = 4096.0 * film.variance[i].x / (film.mean[i].x * film.mean[i].x);
        CAPTURE(i, film.mean[i].x, relative);
        CHECK(film.mean[i].x > 0.0f);
        CHECK(relative < 200.0);
    }
}

// llvmpipe ends all loops of an invocation after 65535 iterations. Four hundred lamps in one place shine as one.
TEST_CASE("no lamp of many is lost, however long a lane works", "[gpu][lights]") {
    const auto picture = [](int count) {
        const std::vector<Light> lamps(std::size_t(count), SphereLight{{0.0, 0.0, 0.0}, 3.0, Rgb(1.0 / count)});
        Scene scene = lit_by(medium(Sphere{{0, 0, 3}, 1.5}, 0.7, 0.0), 5.0, lamps, 64);
        scene.background = Rgb(0.0);
        return render_here(scene, 39).film;
    };
    const Film one = picture(1), many = picture(400);
    for (std::size_t i = 0; i < one.mean.size(); ++i) {
        CAPTURE(i, one.mean[i].x, many.mean[i].x);
        REQUIRE(std::abs(many.mean[i].x - one.mean[i].x) <= 1e-5f * one.mean[i].x);
    }
}

TEST_CASE("looks and flights find the same light", "[gpu][lights][agreement][long]") {
    const SunLight sun{glm::normalize(glm::dvec3(1.0, 2.0, 0.5)), {5.0, 4.0, 3.0}, 60.0, 0.8};
    for (const double g : {0.85, 0.0}) {
        if (!thorough() && g == 0.0)
            continue;
        std::vector<Estimate> estimates;
        std::uint32_t seed = 20;
        const int nee = g > 0.0 ? NEE_TENTATIVE : NEE_COLLISIONS;
        for (const int mis : {MIS_BALANCE, MIS_POWER, MIS_LIGHT, MIS_PHASE}) {
            const SphereLight ball{{5.5, 5.5, 2.0}, 2.5, Rgb(2.0)};
            Scene scene = lit_by(cloud(g), 11.0, {sun, sunset(), ball}, 512);
            scene.settings.integrator = "ratioTracking";
            scene.settings.choices.nee = nee;
            scene.settings.choices.mis = mis;
            estimates.push_back({fmt::format("nee {}, mis {}", nee, mis), render_here(scene, seed++).film});
        }
        // A pixel's 512 samples are too few for a normal limit where a single technique has to find what it rarely
        // draws.
        std::vector<Estimate> weighted;
        for (const Estimate& estimate : estimates)
            if (estimate.name.ends_with("mis 0") || estimate.name.ends_with("mis 1"))
                weighted.push_back(estimate);
        const PairwiseAgreement all = compare_all(estimates), shared = compare_all(weighted);
        CAPTURE(g, all.mean_pair, shared.pixel_pair);
        CHECK(all.mean_z < z_limit(1e-3, 3.0 * double(all.pairs)));
        CHECK(shared.pixel_z < z_limit(1e-3, double(shared.tests)));
    }
}
