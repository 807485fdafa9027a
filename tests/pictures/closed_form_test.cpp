// Pictures with closed forms. Significance: that of support/images.h for pictures, 1e-4 for each mean of a single
// number.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numbers>

#include "scene_xml.h"
#include "shared/constants.h"
#include "support/images.h"
#include "support/numbers.h"
#include "support/scenes.h"
#include "support/statistics.h"
#include "tests/reference/reference.h"

using namespace vkvol;
using test_numbers::infinity;

namespace {

constexpr Rgb sky{0.25, 0.5, 2.0};

// The mean of `value` over each pixel, by the midpoint rule on grid x grid points.
template <class Function> auto pixel_means(const Scene& scene, int grid, const Function& value) {
    std::vector<decltype(value(reference::Ray{}))> means;
    for (int y = 0; y < scene.picture.height; ++y)
        for (int x = 0; x < scene.picture.width; ++x) {
            decltype(value(reference::Ray{})) sum(0.0);
            for (int k = 0; k < grid * grid; ++k)
                sum += value(reference::camera_ray(scene.camera, scene.picture, x + (k % grid + 0.5) / grid,
                                                   y + (k / grid + 0.5) / grid));
            means.push_back(sum / double(grid * grid));
        }
    return means;
}

std::vector<double> escapes(const Scene& scene, int grid) {
    const reference::Medium medium = reference::load(scene.volumes.front(), scene.settings.filter);
    return pixel_means(scene, grid, [&](const reference::Ray& ray) {
        return reference::transmittance_quadrature(medium, ray, 0.0, infinity);
    });
}

// All rays run along -z through one point, but for a millionth of their length; 8192 samples.
Scene beam(const Volume& volume, glm::dvec3 position) {
    Scene scene = scene_of(volume, 1e-6, 32);
    scene.camera.position = position;
    scene.background = sky;
    scene.settings.spp = 8;
    return scene;
}

std::vector<double> everywhere(const Scene& scene, double p) {
    return std::vector<double>(std::size_t(scene.picture.width) * scene.picture.height, p);
}

} // namespace

// 64 x 64 points per pixel are at most 0.15 standard errors off, at the silhouette of the densest sphere, and 0.01 in
// the mean.
TEST_CASE("absorbing shapes transmit exp(-tau) and emit Le (1 - exp(-tau))", "[gpu][hard][closed_form][long]") {
    const double tau = GENERATE(0.1, 1.0, 10.0);
    const bool emits = GENERATE(false, true);
    for (const auto& shape :
         std::vector<decltype(Volume::shape)>{Sphere{{0.1, 0.2, -0.1}, 1.0}, Box{{0.1, -0.2, 0.0}, {1.0, 1.5, 2.0}}}) {
        Volume volume = medium(shape, 0.5 * tau, 0.0);
        volume.Le = emits ? Rgb(4.0, 2.0, 1.0) : Rgb(0.0);
        Scene scene = scene_of(volume, 2.6, 24, 6.0, glm::dvec3(0.0), {-20.0, 40.0, 15.0});
        scene.background = sky;
        scene.settings.spp = 1024;
        CHECK_AGREEMENT(agree_with_escapes(render_here(scene, 6).film, escapes(scene, 64), sky, volume.Le,
                                           fmt::format("absorbing shape {}, tau {}", shape.index(), tau)));
    }
}

TEST_CASE("the camera may be inside an absorber", "[gpu][hard][closed_form]") {
    Scene scene = scene_of(medium(Sphere{{5.0, 6.0, 7.0}, 2.0}, 0.6, 0.0), 1.0, 24);
    scene.background = sky;
    scene.settings.spp = 256;
    scene.camera.fov = 150.0;
    scene.camera.position = {5.0, 6.0, 7.0}; // exp(-sigma r) in every direction
    CHECK_AGREEMENT(agree_with_escapes(render_here(scene, 7).film, everywhere(scene, std::exp(-1.2)), sky, Rgb(0.0),
                                       "camera in the centre"));
    scene.camera.position = {5.0, 8.0, 7.0}; // on the boundary
    CHECK_AGREEMENT(
        agree_with_escapes(render_here(scene, 8).film, escapes(scene, 32), sky, Rgb(0.0), "camera on the boundary"));
    scene.volumes.front() = medium(write_grid(cloud_grid()), 0.6, 0.0);
    scene.camera.position = {0.3, 0.1, -0.2};
    CHECK_AGREEMENT(
        agree_with_escapes(render_here(scene, 9).film, escapes(scene, 12), sky, Rgb(0.0), "camera in a grid"));
}

// Where nothing is sampled every sample has the value, and no depth is too deep: the error of the distance, (4 - 3)
// within 2^-22, of sigma, and of exp in single precision are (0.84 tau + 0.36) 1e-6 of T together (scenes/hard/01).
// What is below the least normal number a device may take for 0.
TEST_CASE("what only absorbs has its closed form at every depth, exactly", "[gpu][hard][closed_form]") {
    const double tau = GENERATE(0.5, 5.0, 7.5, 8.0, 11.0, 17.0, 30.0, 87.0);
    const std::string integrator = GENERATE("densitySampling", "ratioTracking", "regularTracking");
    const bool chromatic = GENERATE(false, true);
    Scene scene = beam(slab(tau, 0.0), {0.0, 0.0, 3.0});
    if (chromatic)
        scene.volumes.front().sigma_a *= Rgb(1.0, 0.75, 0.5);
    scene.volumes.front().Le = Rgb(0.5, 0.0, 3.0);
    scene.settings.integrator = integrator;
    scene.settings.choices.scattering = SCATTERING_NONE;
    const Film film = render_here(scene, 17).film;
    const Rgb depths = scene.volumes.front().sigma_a;
    const Rgb Le = scene.volumes.front().Le;
    for (int channel = 0; channel < 3; ++channel) {
        const double depth = depths[channel], T = std::exp(-depth);
        const double expected = sky[channel] * T - Le[channel] * std::expm1(-depth);
        const double allowed = (0.84 * depth + 0.36) * 1e-6 * (sky[channel] + Le[channel]) * T + 2e-7 * expected +
                               std::numeric_limits<float>::min();
        for (const glm::vec3& pixel : film.mean) {
            CAPTURE(integrator, tau, chromatic, channel, pixel[channel], expected);
            REQUIRE(std::abs(pixel[channel] - expected) <= allowed);
        }
    }
}

// In a homogeneous slab a march has no bias of its steps, so that only roulette is left to err, and rounding: for the
// closed form's (above) each step brings that of an exp of its own, 3 units of 1.2e-7, and half of one for the product.
TEST_CASE("roulette of a march through the medium changes no mean", "[gpu][hard][closed_form]") {
    const double tau = GENERATE(5.0, 8.0, 11.0);
    const auto [integrator, chromatic] = GENERATE(
        table<std::string, bool>({{"rayMarching", false}, {"rayMarching", true}, {"adaptiveRayMarching", false}}));
    Scene scene = beam(medium(Box{{0.0, 0.0, -0.5}, {2.0, 2.0, 1.0}}, tau, 0.0), {0.0, 0.0, 3.0});
    scene.background = Rgb(1.0);
    if (chromatic)
        scene.volumes.front().sigma_a *= Rgb(1.0, 1.2, 1.1);
    scene.settings.integrator = integrator;
    scene.settings.choices.scattering = SCATTERING_NONE;
    scene.settings.spp = 64;
    scene.settings.march.step = 0.2;
    scene.settings.march.optical_step = 0.1;
    const double steps = 1.0 + (integrator == "rayMarching" ? 1.0 / 0.2 : tau / 0.1);
    const Film film = render_here(scene, 18).film;
    for (int channel = 0; channel < 3; ++channel) {
        RunningMean mean;
        for (const glm::vec3& pixel : film.mean)
            mean.add(pixel[channel]);
        const double T = std::exp(-scene.volumes.front().sigma_a[channel]);
        CAPTURE(integrator, tau, channel, mean.mean(), mean.standard_error(), T);
        CHECK(t_test_p(mean, T, (0.84 * tau + 0.42 * steps) * 1e-6 * T) > 1e-4);
    }
}

// Free flights are at most 38.82 optical depths long: nothing comes through more, and nothing is NaN.
TEST_CASE("opaque slabs are black", "[gpu][hard][closed_form]") {
    const double tau = GENERATE(80.0, 87.0, 88.0, 104.0, 1e4);
    const Film film = render_here(beam(slab(tau, 0.0), {0.0, 0.0, 3.0}), 10).film;
    const auto black = [](glm::vec3 value) { return value == glm::vec3(0.0f); };
    CHECK(std::all_of(film.mean.begin(), film.mean.end(), black));
    CHECK(std::all_of(film.variance.begin(), film.variance.end(), black));
}

TEST_CASE("a thin slab scatters what the closed form says", "[gpu][hard][closed_form]") {
    constexpr double tau = 1e-3;
    Scene scene = scene_of(slab(tau, 0.8), 1e-6, 32);
    scene.settings.spp = 2048;
    scene.settings.max_depth = 1;
    scene.lights = {sunlight()};
    const double mu0 = sunlight().direction.z;
    const double L = 3.0 * reference::slab_single_reflection(0.8, reference::hg_eval(0.0, 0.0), tau, mu0, 1.0);
    RunningMean mean;
    for (const glm::vec3& pixel : render_here(scene, 11).film.mean)
        mean.add(pixel.x);
    CAPTURE(mean.mean(), mean.standard_error(), L);
    CHECK(t_test_p(mean, L) > 1e-4);
}

// Collisions in a slab of tau 1e-6 are Poisson, 1.05 expected: P(more than 8) = 2e-6. That their share is exact, for
// thinner slabs too, is shown of the random numbers themselves (rng_test.cpp).
TEST_CASE("a slab of optical depth 1e-6 is met by a millionth of the paths", "[gpu][hard][closed_form]") {
    Scene scene = scene_of(slab(1e-6, 0.8), 1e-6, 32);
    scene.settings.spp = 1024;
    scene.lights = {sunlight(Rgb(1.0))};
    scene.settings.choices.first_flight = FIRST_FLIGHT_DRAWN;
    const RenderResult result = render_here(scene, 12);
    const auto lit = std::count_if(result.film.mean.begin(), result.film.mean.end(), [](auto m) { return m.x > 0.0f; });
    CAPTURE(lit);
    CHECK(lit <= 8);
    CHECK(result.counts.paths == 32u * 32u * 1024u);
}

// A beam along the normal, seen back along the beam; and, by reciprocity, the plane albedo as the radiance of a medium
// in a uniform sky. The slab is 60 mean free paths thick: less than 1e-3 of the largest albedo's light comes that far.
TEST_CASE("a semi-infinite medium reflects as Chandrasekhar says", "[gpu][hard][closed_form]") {
    const double albedo = GENERATE(0.5, 0.9);
    Scene scene = scene_of(slab(60.0, albedo), 1e-6, 16);
    scene.settings.spp = 1024;
    const auto check = [&](double expected) {
        RunningMean mean;
        for (const glm::vec3& pixel : render_here(scene, 13).film.mean)
            mean.add(pixel.x);
        CAPTURE(albedo, mean.mean(), mean.standard_error(), expected);
        CHECK(t_test_p(mean, expected) > 1e-4);
    };
    scene.background = Rgb(1.0);
    check(reference::plane_albedo(albedo));
    scene.background = Rgb(0.0);
    scene.lights = {DirectionalLight{{0.0, 0.0, 1.0}, Rgb(1.0)}};
    check(reference::normal_reflection(albedo));
}

// Every pixel meets the medium in a good part of its samples, so that the normal limit holds. The integrand varies
// over voxels, of which a pixel sees less than one: 2 x 2 points are exact to some 1e-3.
TEST_CASE("single scattering equals the quadrature", "[gpu][hard][closed_form][long]") {
    const auto check = [](const Volume& volume, double width, const std::vector<Filter>& filters) {
        Scene scene = scene_of(volume, width, 20, 20.0, glm::dvec3(0.0), {10.0, -20.0, 0.0});
        scene.settings.spp = 512;
        scene.settings.max_depth = 1;
        scene.lights = {sunlight()};
        const reference::Medium medium = reference::load(volume, filters.front());
        const auto means = pixel_means(scene, 2, [&](const reference::Ray& ray) {
            return reference::single_scattering_quadrature(medium, scene.lights.front(), ray);
        });
        for (const Filter filter : filters) {
            scene.settings.filter = filter;
            CHECK_AGREEMENT(agree_with_means(render_here(scene, 14).film, means,
                                             fmt::format("single scattering, shape {}, filter {}, g {}",
                                                         volume.shape.index(), int(filter), volume.g)));
        }
    };
    for (const double g : {0.5, -0.6}) {
        check(medium(Sphere{}, 1.0, 0.9, g), 1.2, {Filter::trilinear});
        check(medium(Box{{0, 0, 0}, {2.0, 2.0, 1.0}}, 1.0, 0.9, g), 1.2, {Filter::trilinear});
    }
    const GridFile file = write_grid(cloud_grid());
    check(medium(file, 0.5, 0.9, 0.5), 4.0, {Filter::trilinear, Filter::stochastic});
    check(medium(file, 0.5, 0.9, -0.6), 4.0, {Filter::nearest});
}

// A lone voxel v is a hat of area v h under trilinear lookup along an axis, and a step of the same area under nearest.
TEST_CASE("a lone voxel absorbs as its hat", "[gpu][hard][closed_form][long]") {
    const Filter filter = GENERATE(Filter::nearest, Filter::trilinear, Filter::stochastic);
    constexpr double value = 3.0, h = 0.5, sigma = 0.8;
    GridRecipe spike{{-9, -9, -9}, {9, 9, 9}, [](glm::ivec3 i) { return i == glm::ivec3(0) ? float(value) : 0.0f; }};
    spike.background = 1.0f; // so that the zeros are active
    spike.linear = glm::dmat3(h);
    const GridFile file = write_grid(spike);
    const double tau = sigma * value * h;
    for (const int cell : {1, 4, 16, 64})
        for (const double scale : {1.0, 4.0, 100.0}) {
            Scene scene = beam(medium(file, sigma, 0.0), {0.0, 0.0, 10.0});
            scene.settings.filter = filter;
            scene.settings.majorant_cell = cell;
            scene.settings.majorant_scale = scale;
            CHECK_AGREEMENT(agree_with_escapes(
                render_here(scene, 15).film, everywhere(scene, std::exp(-tau)), sky, Rgb(0.0),
                fmt::format("spike, filter {}, cell {}, majorant scale {}", int(filter), cell, scale)));
        }
}

// Half of the light's depth, in half a million tentative collisions of one millionth each. Squares of what is left at
// each add up to a relative variance of 5e-7. A ratio of 1 - 1e-6 in single precision would be 1.3 % too far from 1 at
// each of them, and the result 0.6 % off; rounded as it is it errs by less than 0.1 %.
TEST_CASE("what is seen through a box is so under a majorant a million times its density", "[gpu][hard][closed_form]") {
    const Scene scene = parse_scene(
        R"(<options><box width="1" height="1" depth="1"/><sigma_a>1</sigma_a><sigma_s>0</sigma_s>
        <integrator transmittance="ratio">ratioTracking</integrator><majorant scale="1e6"/>
        <lights><directional z="1" r="1" g="1" b="1"/></lights><fluence>0 0 0</fluence>
        <rayPerPixelCount>32</rayPerPixelCount></options>)",
        "s.xml");
    const double seen = image_mean(render_here(scene, 1).film).value.x;
    CHECK(seen == Approx(std::exp(-0.5)).epsilon(5.0 * std::sqrt(5e-7 / 32.0) + 1e-3));
}

// tau = sigma v N h along an axis, wherever between the outermost voxel centres: on centres, faces and edges alike.
TEST_CASE("a constant grid has the optical depth of its voxels", "[gpu][hard][closed_form][long]") {
    const Filter filter = GENERATE(Filter::nearest, Filter::trilinear, Filter::stochastic);
    GridRecipe grid{{-3, 2, 5}, {6, 11, 14}, [](glm::ivec3) { return 2.0f; }};
    grid.linear = glm::dmat3(0.25);
    const GridFile file = write_grid(grid);
    const double tau = 0.3 * 2.0 * 10 * 0.25;
    for (const glm::dvec2 at : {glm::dvec2(0, 5), glm::dvec2(0.5, 5.5), glm::dvec2(-1, 2), glm::dvec2(4, 9.99),
                                glm::dvec2(-2.5, 10.5), glm::dvec2(1.37, 7.81)}) {
        Scene scene = beam(medium(file, 0.3, 0.0), {0.25 * at.x, 0.25 * at.y, 20.0});
        scene.settings.filter = filter;
        CHECK_AGREEMENT(agree_with_escapes(render_here(scene, 16).film, everywhere(scene, std::exp(-tau)), sky,
                                           Rgb(0.0), fmt::format("constant grid at {}, {}", at.x, at.y)));
    }
}

// A shadow ray along a row of thin bodies passes them all. Both the flight across the first one and that ray are known
// in closed form: each sample is a collision's, beyond which light has 1.495 of the row's optical depth to cross, or
// none.
TEST_CASE("light shines through a row of a hundred and fifty bodies", "[gpu][hard][closed_form]") {
    Mesh row;
    for (int k = 0; k < 150; ++k)
        row = join(row, make_box({-3.0, -3.0, 0.02 * k}, {3.0, 3.0, 0.02 * k + 0.01}, 1));
    Scene scene = beam(medium(write_mesh(row), 1.0, 0.9), {10.0, 0.0, 0.005});
    scene.camera.yaw = 90.0;
    scene.background = Rgb(0.0);
    scene.lights = {DirectionalLight{{0.0, 0.0, 1.0}, Rgb(3.0, 2.0, 1.0)}};
    scene.settings.integrator = "ratioTracking";
    scene.settings.choices = {SCATTERING_SINGLE, FREE_FLIGHT_ANALYTIC, TRANSMITTANCE_ANALYTIC, NEE_COLLISIONS, {}};
    const double escapes = std::exp(-6.0), depth = 0.005 + 149 * 0.01;
    const Rgb seen = std::get<DirectionalLight>(scene.lights.front()).irradiance *
                     (0.9 / (4.0 * std::numbers::pi) * std::exp(-depth));
    CHECK_AGREEMENT(
        agree_with_escapes(render_here(scene, 21).film, everywhere(scene, escapes), Rgb(0.0), seen, "a row of bodies"));
}

// Shadow rays from null collisions are sent amid a flight, which then goes on to the bodies behind.
TEST_CASE("flights go on to the next body after a shadow ray", "[gpu][mesh][image]") {
    const Mesh bodies =
        join(make_box({-1.0, -1.0, -0.5}, {1.0, 1.0, 0.0}, 1), make_box({-1.0, -1.0, -2.0}, {1.0, 1.0, -1.0}, 1));
    Scene scene = scene_of(medium(write_mesh(bodies), 1.0, 0.8), 1.6, 16);
    scene.lights = {DirectionalLight{{0.0, 1.0, 0.0}, Rgb(3.0)}};
    scene.background = sky;
    scene.settings.spp = 256;
    scene.settings.integrator = "ratioTracking";
    scene.settings.majorant_scale = 2.0;
    scene.settings.choices = {SCATTERING_MULTIPLE, FREE_FLIGHT_DELTA, TRANSMITTANCE_RATIO, NEE_TENTATIVE, {}};
    const RenderResult tentative = render_here(scene, 5);
    CHECK(tentative.counts.shadow_rays > tentative.counts.real_collisions);
    scene.settings.choices.nee = NEE_COLLISIONS;
    CHECK_AGREEMENT(agree(tentative.film, render_here(scene, 6).film, "two bodies"));
}
