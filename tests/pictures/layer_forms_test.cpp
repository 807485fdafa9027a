// Layers besides radiance whose values are known in closed form.
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>

#include "support/images.h"
#include "support/scenes.h"

using namespace vkvol;

namespace {

// All rays run along -z through one point, but for a millionth of their length.
Scene beam(const Volume& volume, double distance, std::uint32_t spp) {
    Scene scene = scene_of(volume, 1e-6, 16);
    scene.camera.position = {0.0, 0.0, distance};
    scene.settings.spp = spp;
    return scene;
}

std::vector<Rgb> everywhere(const Film& film, const Rgb& value) {
    return std::vector<Rgb>(film.pixel_count(), value);
}

} // namespace

TEST_CASE("alpha of a homogeneous slab is 1 - exp(-tau)", "[gpu][image][aovs][long]") {
    const double tau = GENERATE(0.1, 1.0, 5.0);
    Scene scene = beam(slab(tau, 0.7), 3.0, 512);
    scene.layers = layer_alpha | layer_transmittance | layer_depth;
    for (const char* const integrator : {"ratioTracking", "weightedTracking", "spectralTracking", "rayMarching"}) {
        scene.settings.integrator = integrator;
        const Film film = render_here(scene, 4).film;
        // A ray collides, or it does not: of some pixels none may come through.
        const std::vector<double> through(film.pixel_count(), std::exp(-tau));
        CHECK_AGREEMENT(agree_with_escapes(as_film(film, "alpha"), through, Rgb(0.0), Rgb(1.0),
                                           fmt::format("alpha of {}, {}", tau, integrator)));
        CHECK_AGREEMENT(agree_with_escapes(as_film(film, "transmittance"), through, Rgb(1.0), Rgb(0.0),
                                           fmt::format("transmittance of {}, {}", tau, integrator)));
        CHECK_AGREEMENT(agree_with_escapes(as_film(film, "coverage"), through, Rgb(0.0), Rgb(1.0),
                                           fmt::format("coverage of {}, {}", tau, integrator)));
    }
    // Goes through: every sample has the value, without scattering that of the absorption alone.
    scene.settings.integrator = "densitySampling";
    const double absorbed = 0.3 * tau;
    const Film film = render_here(scene, 4).film;
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        CHECK(layer_of(film, "alpha").mean[i].x == Approx(-std::expm1(-absorbed)).epsilon(1e-5));
        CHECK(layer_of(film, "coverage").mean[i].x == Approx(-std::expm1(-absorbed)).epsilon(1e-5));
    }
    scene.settings.integrator = "spectralTracking";
    scene.volumes.front().sigma_a *= Rgb(1.0, 0.5, 0.0);
    scene.volumes.front().sigma_s *= Rgb(1.0, 0.5, 0.2);
    const Rgb depth = scene.volumes.front().sigma_a + scene.volumes.front().sigma_s;
    const Film colored = render_here(scene, 4).film;
    CHECK_AGREEMENT(agree_with_means(as_film(colored, "transmittance"), everywhere(colored, glm::exp(-depth)),
                                     fmt::format("transmittance in colours, {}", tau)));
    const double mean = 1.0 - (std::exp(-depth.x) + std::exp(-depth.y) + std::exp(-depth.z)) / 3.0;
    CHECK_AGREEMENT(agree_with_means(as_film(colored, "alpha"), everywhere(colored, Rgb(mean)),
                                     fmt::format("grey alpha, {}", tau)));
}

TEST_CASE("the first collision in a slab is where its density has it", "[gpu][image][aovs]") {
    const double tau = GENERATE(0.5, 4.0), distance = GENERATE(3.0, 20000.0); // from afar rays begin before the medium
    const bool flat = GENERATE(false, true);
    Scene scene = beam(slab(tau, 0.7), distance, 1024);
    if (distance > 100.0) // of a slab that is not too wide for that
        scene.volumes.front() = medium(Box{{0.0, 0.0, -0.5}, {4.0, 4.0, 1.0}}, tau, 0.7);
    if (flat) {
        scene.camera.projection = Projection::orthographic;
        scene.camera.view_height = 1e-3;
    }
    scene.layers = layer_depth | layer_position | layer_albedo;
    const Film film = render_here(scene, 4).film;
    // Mean of an exponential that is cut at 1, of rate tau.
    const auto mean_below = [](double rate) { return 1.0 / rate - std::exp(-rate) / -std::expm1(-rate); };
    const double below = mean_below(tau);
    CHECK_AGREEMENT(agree_with_means(as_film(film, "depth"), everywhere(film, Rgb(distance + below)),
                                     fmt::format("depth {}, {}, {}", tau, distance, flat)));
    if (!flat) { // gone through at once, exactly, of the absorption alone
        scene.settings.integrator = "densitySampling";
        const Film through = render_here(scene, 4).film;
        for (const glm::vec3& pixel : layer_of(through, "depth").mean)
            CHECK(pixel.x == Approx(distance + mean_below(0.3 * tau)).epsilon(2e-7).margin(1e-5));
    }
    const FilmLayer &depth = layer_of(film, "depth"), &position = layer_of(film, "position"),
                    &coverage = layer_of(film, "coverage"), &albedo = layer_of(film, "albedo");
    CHECK(position.variance.empty());
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        CHECK(position.mean[i].z == Approx(distance - depth.mean[i].x).margin(2e-7 * distance + 1e-6));
        CHECK(albedo.mean[i].x == Approx(0.7 * coverage.mean[i].x).epsilon(1e-5));
    }
}

// By how much pixels that all see the same differ: that many times chi squared over its degrees of freedom, whose
// relative standard deviation is sqrt(2 / (n - 1)) for means of many samples.
TEST_CASE("the error of depths is known in any unit, near and far, of any weights", "[gpu][image][aovs]") {
    const auto [unit, distance, is_coloured] =
        GENERATE(std::tuple(1e-6, 3.0, false), std::tuple(1e8, 3.0, false), std::tuple(1.0, 5000.0, true));
    CAPTURE(unit, distance);
    Scene scene = beam(slab(1.0, 0.0), distance, 64);
    scene.volumes.front() = medium(Box{{0.0, 0.0, -0.5 * unit}, {4.0 * unit, 4.0 * unit, unit}}, 4.0 / unit, 0.0);
    if (is_coloured)
        scene.volumes.front().sigma_a = {4.0, 2.0, 1.0};
    scene.camera.position.z = distance * unit;
    scene.camera.projection = Projection::orthographic;
    scene.camera.view_height = 1e-3 * unit;
    scene.layers = layer_depth;
    const Film film = render_here(scene, 4).film;
    const FilmLayer& depth = layer_of(film, "depth");
    const double n = double(film.pixel_count());
    double sum = 0.0, squares = 0.0, told = 0.0;
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        const double from_front = depth.mean[i].x / unit - distance; // without which little is left of squares
        sum += from_front / n;
        squares += from_front * from_front / n;
        told += depth.variance[i].x / (unit * unit) / n;
    }
    CHECK(told == Approx(n / (n - 1.0) * (squares - sum * sum)).epsilon(5.0 * std::sqrt(2.0 / (n - 1.0))));
}

TEST_CASE("the first collision of what is gone through at once is where its density has it", "[gpu][image][aovs]") {
    const auto mean_below = [](double rate) { return 1.0 / rate - std::exp(-rate) / -std::expm1(-rate); };
    // Channel by channel, weighted by what each loses.
    const Rgb sigma_t = {10.0, 1.0, 0.5};
    Scene scene = beam(slab(1.0, 0.0), 3.0, 4);
    scene.volumes.front().sigma_a = sigma_t;
    scene.settings.integrator = "densitySampling";
    scene.layers = layer_depth;
    double depth = 0.0, lost = 0.0;
    for (int c = 0; c < 3; ++c) {
        depth += -std::expm1(-sigma_t[c]) * mean_below(sigma_t[c]);
        lost += -std::expm1(-sigma_t[c]);
    }
    const Film colours = render_here(scene, 4).film; // of which the film has to outlive its layer
    for (const glm::vec3& pixel : layer_of(colours, "depth").mean)
        CHECK(pixel.x == Approx(3.0 + depth / lost).epsilon(1e-5));
    // Down through an exponential atmosphere, whose mean is an integral: of exp(-tau) - exp(-tau(20)) over the way.
    scene.volumes.front() = medium(Everywhere{}, 1.5, 0.0);
    scene.volumes.front().layers = Layers{1, 0.0, 20.0, 1.0, 0.0};
    scene.camera.projection = Projection::orthographic;
    scene.camera.view_height = 1e-3;
    scene.camera.position = {0.0, 20.0, 0.0};
    scene.camera.pitch = -90.0;
    scene.settings.spp = 1024;
    const auto passed = [](double t) { return std::exp(-1.5 * (std::exp(t - 20.0) - std::exp(-20.0))); };
    constexpr int steps = 20000; // by midpoints: off by (20 / steps)^2 / 24 of the second derivative, 1e-7
    double mean = 0.0;
    for (int i = 0; i < steps; ++i)
        mean += 20.0 / steps * (passed(20.0 * (i + 0.5) / steps) - passed(20.0)) / (1.0 - passed(20.0));
    const Film air = render_here(scene, 4).film;
    CHECK_AGREEMENT(agree_with_means(as_film(air, "depth"), everywhere(air, Rgb(mean)), "atmosphere"));
}

TEST_CASE("a surface's normal is seen through what is before it", "[gpu][image][aovs]") {
    const double tau = 0.7;
    Scene scene = beam(slab(tau, 0.7), 3.0, 1024);
    scene.surfaces.emplace_back().shape = BallSurface{{-0.6, 0.0, -3.0}, 1.0};
    scene.layers = layer_normal;
    const Film film = render_here(scene, 4).film;
    Film normals = as_film(film, "normal");
    for (std::size_t i = 0; i < film.pixel_count(); ++i) { // y is next to nothing, and has as little variance
        CHECK(std::abs(normals.mean[i].y) < 1e-5);
        normals.mean[i].y = normals.mean[i].x;
        normals.variance[i].y = normals.variance[i].x;
    }
    CHECK_AGREEMENT(agree_with_means(normals, everywhere(film, std::exp(-tau) * Rgb(0.6, 0.6, 0.8)), "normal"));
    // From within.
    scene.volumes.clear();
    scene.camera.position = {0.0, 0.0, -3.0};
    std::get<BallSurface>(scene.surfaces.front().shape).center = {0.6, 0.0, -3.0};
    const Film within = render_here(scene, 5).film;
    for (const glm::vec3& normal : layer_of(within, "normal").mean)
        CHECK(glm::distance(glm::dvec3(normal), glm::dvec3(0.6, 0.0, 0.8)) < 1e-3);
    // What else there is of the first that is met.
    scene.surfaces.front().material.color = {0.2, 0.4, 0.8};
    scene.layers = layer_depth | layer_position | layer_albedo;
    const Film met = render_here(scene, 6).film;
    for (std::size_t i = 0; i < met.pixel_count(); ++i) {
        CHECK(layer_of(met, "depth").mean[i].x == Approx(0.8).epsilon(1e-4));
        CHECK(glm::distance(layer_of(met, "position").mean[i], glm::vec3(0.0f, 0.0f, -3.8f)) < 1e-3f);
        CHECK(glm::distance(layer_of(met, "albedo").mean[i], glm::vec3(0.2f, 0.4f, 0.8f)) < 1e-5f);
    }
}
