// Even balls and boxes that glow, as lights: looks find what flights meet, too.
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "integrators.h"
#include "method.h"
#include "preset.h"
#include "scene_facts.h"
#include "shared/constants.h"
#include "support/agreement.h"
#include "support/images.h"
#include "support/scene_text.h"
#include "support/scenes.h"
#include "support/surface_scenes.h"
#include "support/thorough.h"

using namespace vkvol;
using std::numbers::pi;

namespace {

Volume glowing(decltype(Volume::shape) shape, double sigma_t, double albedo, const Rgb& Le) {
    Volume volume = medium(std::move(shape), sigma_t, albedo);
    volume.Le = Le;
    return volume;
}

// Turned, and sheared.
Volume leaning_box(double sigma_t, const Rgb& Le) {
    Volume volume = glowing(Box{{0.0, 0.0, 0.0}, {0.6, 0.9, 0.4}}, sigma_t, 0.4, Le);
    glm::dmat4 shear(1.0);
    shear[1][0] = 0.5;
    volume.transform = glm::translate(glm::dmat4(1.0), glm::dvec3(-1.0, 0.7, 0.5)) *
                       glm::rotate(glm::dmat4(1.0), 0.7, glm::dvec3(0.3, 1.0, 0.2)) * shear;
    return volume;
}

// Two that glow, one of them thick and partly within a ball of fog, which has no light but theirs.
Scene lit_fog() {
    Scene scene =
        scene_of(medium(Sphere{{0.0, 0.0, 0.0}, 1.3}, 0.9, 0.8, 0.4), 3.4, 8, 8.0, glm::dvec3(0.0), {5.0, 20.0, 0.0});
    scene.volumes.push_back(glowing(Sphere{{0.9, 0.5, 0.4}, 0.35}, 20.0, 0.3, {3.0, 2.0, 1.0}));
    scene.volumes.push_back(leaning_box(1.5, {0.5, 1.0, 4.0}));
    scene.settings.spp = 1024;
    return scene;
}

// A ball that glows beside a wall, without other media.
Scene lit_floor() {
    Scene scene = empty_scene(8);
    scene.surfaces = {surface_of(floor_piece, MaterialKind::diffuse),
                      surface_of(left_ball, MaterialKind::conductor, 0.3),
                      surface_of(right_ball, MaterialKind::dielectric)};
    scene.volumes = {glowing(Sphere{{0.1, 0.3, 0.3}, 0.3}, 4.0, 0.2, {4.0, 5.0, 6.0})};
    scene.settings.spp = 1024;
    return scene;
}

Scene at_point(const glm::dvec3& point, const Volume& volume) {
    Scene scene;
    scene.camera.projection = Projection::fluence;
    scene.camera.position = point;
    scene.camera.points.assign(16, point);
    scene.picture = {16, 1, 0.0, 0.0, 16.0, 1.0};
    scene.volumes = {volume, medium(Box{{60.0, 0.0, 0.0}, Rgb(1.0)}, 0.1, 0.0)}; // so that something may be lit
    scene.settings.spp = 4096;
    return scene;
}

// Without scattering, of radiance S (1 - exp(-sigma * chord)) along each ray, at `distance` from the ball's middle.
double fluence_of_ball(double sigma, double radius, double distance, double S) {
    const bool within = distance < radius;
    const double rim = within ? -1.0 : std::sqrt(1.0 - std::pow(radius / distance, 2.0)); // of the cosine
    double sum = 0.0;
    const int n = 200000;
    for (int i = 0; i < n; ++i) {
        const double mu = rim + (1.0 - rim) * (i + 0.5) / n;
        const double half = std::sqrt(std::max(radius * radius - distance * distance * (1.0 - mu * mu), 0.0));
        const double chord = within ? distance * mu + half : 2.0 * half;
        sum += 1.0 - std::exp(-sigma * chord);
    }
    return 2.0 * pi * S * sum * (1.0 - rim) / n;
}

double variance_of(const Film& film) {
    double sum = 0.0;
    for (const glm::vec3& variance : film.variance)
        sum += double(variance.x) + variance.y + variance.z;
    return sum;
}

} // namespace

TEST_CASE("what even balls and boxes glow is the same however looks and flights share it", "[gpu][image][glow]") {
    Scene scene = GENERATE(0, 1) == 0 ? lit_fog() : lit_floor();
    const bool fog = scene.volumes.size() > 1;
    REQUIRE(with_preset(scene).lights.size() == (fog ? 2 : 1));
    std::vector<Estimate> estimates;
    const auto add = [&](const std::string& name) {
        estimates.push_back({name, render_here(scene, static_cast<std::uint32_t>(estimates.size() + 1)).film});
    };
    for (const int mis : {MIS_BALANCE, MIS_POWER, MIS_LIGHT, MIS_PHASE}) {
        scene.settings.choices.mis = mis;
        add(fmt::format("mis {}", mis));
    }
    scene.settings.choices = {};
    scene.settings.choices.emission = EMISSION_AT_STEPS;
    add("emission at steps");
    if (fog)
        scene.settings.choices.transmittance = TRANSMITTANCE_TELESCOPING;
    scene.settings.choices.distance = DISTANCE_MIXED;
    add("looks from along flights");
    scene.settings.choices = {};
    scene.settings.choices.nee = NEE_NONE;
    add("met by chance");
    const PairwiseAgreement all = compare_all(estimates);
    const std::string heading = fog ? "glow in fog" : "glow on surfaces";
    check_rows("even balls and boxes that glow", heading, {{heading, all, all}}, 1e-3);
}

TEST_CASE("the reference, whose paths meet glow by chance, agrees with looks toward it", "[gpu][image][glow][long]") {
    Scene scene = GENERATE(0, 1) == 0 ? lit_fog() : lit_floor();
    check_same_mean(render_here(scene, 1).film, render_reference(with_preset(scene), 2), "lights of glow");
}

TEST_CASE("points see balls that glow as closed forms have it", "[gpu][image][glow]") {
    const double sigma = GENERATE(0.3, 40.0), distance = GENERATE(0.0, 1.1, 9.0);
    Scene scene = at_point({1.0, 2.0 + distance, 3.0}, glowing(Sphere{{1.0, 2.0, 3.0}, 0.8}, sigma, 0.0, Rgb(2.0)));
    const double expected = fluence_of_ball(sigma, 0.8, distance, 2.0);
    for (const int mis : {MIS_BALANCE, MIS_LIGHT}) {
        if (mis == MIS_LIGHT && distance == 0.0) // within what glows looks alone have no bound
            continue;
        scene.settings.choices.mis = mis;
        check_means(scene, expected, fmt::format("sigma {}, {} away, mis {}", sigma, distance, mis));
    }
    RenderJob staged;
    staged.plan.schedule = Schedule::staged;
    scene.settings.spp = 64;
    CHECK(same_bits(render_here(scene, 1).film, render_here(scene, 1, staged).film));
}

TEST_CASE("what a sensor of flux finds of a glow by looks is in the layers of what it meets", "[gpu][image][glow]") {
    Scene scene = at_point({2.0, 0.0, 0.0}, glowing(Sphere{{0.0, 0.0, 0.0}, 0.8}, 0.7, 0.0, Rgb(2.0)));
    scene.volumes.push_back(medium(Box{{0.0, 3.0, 0.0}, Rgb(1.0)}, 0.5, 0.0));
    scene.volumes.front().name = "flame";
    scene.volumes.back().name = "air";
    scene.layers = layer_emission | layer_background | layer_media;
    scene.settings.choices.mis = MIS_LIGHT;
    const Film film = render_here(scene, 1).film;
    const double all = mean_of(film);
    CHECK(all > 0.0);
    CHECK(mean_of(as_film(film, "emission")) == Approx(all).epsilon(1e-5));
    CHECK(mean_of(as_film(film, "medium.flame")) == Approx(all).epsilon(1e-5));
    CHECK(mean_of(as_film(film, "background")) == 0.0);
}

TEST_CASE("what is too thick for looks is met by flights", "[gpu][image][glow]") {
    // So many free paths to where it begins that a look would end within the last digits of its distance.
    Scene scene = at_point({0.0, 0.0, 0.0}, glowing(Box{{0.0, 0.0, 12.0}, {20.0, 20.0, 4.0}}, 5e4, 0.0, Rgb(2.0)));
    scene.settings.choices.mis = MIS_LIGHT;
    // Of the square's radiance of 2: its solid angle, four times that over a quarter.
    const double a = 10.0, b = 10.0, d = 10.0;
    const double solid_angle = 4.0 * std::atan(a * b / (d * std::sqrt(a * a + b * b + d * d)));
    check_means(scene, 2.0 * solid_angle, "a thick wall");
}

TEST_CASE("thick things that glow starve no other light", "[gpu][image][glow]") {
    Scene scene = scene_of(medium(Sphere{{0.0, 0.0, 0.0}, 1.3}, 0.9, 0.8), 2.0, 8, 8.0);
    scene.lights = {PointLight{{0.0, 3.0, 0.0}, Rgb(10.0)}};
    scene.settings.spp = 256;
    const Film alone = render_here(scene, 1).film;
    scene.volumes.push_back(glowing(Sphere{{0.0, -2.2, 0.0}, 0.5}, 5000.0, 0.0, Rgb(0.01)));
    CHECK(variance_of(render_here(scene, 2).film) < 3.0 * variance_of(alone));
}

TEST_CASE("points see a leaning box that glows alike by looks and by flights", "[gpu][image][glow]") {
    Scene scene = at_point({-0.8, 1.3, 0.46}, leaning_box(1.5, {0.5, 1.0, 4.0}));
    scene.settings.choices.mis = MIS_PHASE;
    const Film met = render_here(scene, 1).film;
    for (const int mis : {MIS_LIGHT, MIS_BALANCE}) {
        scene.settings.choices.mis = mis;
        check_same_mean(render_here(scene, 2).film, met, fmt::format("mis {}", mis));
    }
}

TEST_CASE("small things that glow are found by looks", "[gpu][image][glow]") {
    Scene scene = scene_of(medium(Sphere{{0.0, 0.0, 0.0}, 1.3}, 0.9, 0.8), 2.0, 8, 8.0);
    scene.volumes.push_back(glowing(Box{{0.0, 1.6, 0.0}, Rgb(0.2)}, 3.0, 0.0, Rgb(20.0)));
    scene.settings.spp = 512;
    const Film looked = render_here(scene, 1).film;
    scene.settings.choices.nee = NEE_NONE;
    CHECK(variance_of(looked) < 0.1 * variance_of(render_here(scene, 2).film));
}

TEST_CASE("glow is looked for where it is even, has an end, and may light something else", "[glow]") {
    const auto lights = [](const Scene& scene) { return with_preset(scene).lights.size(); };
    const Scene fog = lit_fog();
    CHECK(choose_integrator(fog).name == std::string("ratioTracking"));
    CHECK(lights(fog) == 2);
    CHECK(lights(with_preset(fog)) == 2);
    CHECK(choose_method(with_preset(fog)).nee == NEE_COLLISIONS);
    CHECK(emits(with_preset(fog)));
    Scene other = fog;
    other.volumes.erase(other.volumes.begin()); // two that glow light each other
    CHECK(lights(other) == 2);
    other.volumes.pop_back();
    CHECK(lights(other) == 0);
    other.surfaces = lit_floor().surfaces;
    CHECK(lights(other) == 1);
    other = fog;
    other.volumes[1].noise = Noise{};
    other.volumes[2].shape = Everywhere{};
    CHECK(lights(other) == 0);
    other = fog;
    other.periodic = Periodic{{-2.0, 0.0, -2.0}, {2.0, 0.0, 2.0}};
    CHECK(lights(other) == 0);
    other = fog;
    other.settings.choices.scattering = SCATTERING_SINGLE;
    CHECK(lights(other) == 0);
    other.settings.choices.distance = DISTANCE_MIXED; // for which there is nothing then
    CHECK_FALSE(choose_method(with_preset(other)).warnings.empty());
    other = fog;
    other.settings.choices.transmittance = TRANSMITTANCE_MARCH; // which would be biased
    CHECK(lights(other) == 0);
    other.settings.choices.transmittance = TRANSMITTANCE_TELESCOPING;
    CHECK(lights(other) == 2);
    other.volumes[0].sigma_s = {1.0, 0.5, 0.2}; // and would be refused
    CHECK(lights(other) == 0);
    CHECK_NOTHROW(choose_method(with_preset(other)));
    other = fog;
    other.settings.integrator = "deltaTracking";
    CHECK(lights(other) == 0);
    other.settings.integrator = "lightTracing";
    CHECK(lights(other) == 0);
    // What is rendered by the cache of light is so before and after.
    other = fog;
    other.volumes[0].noise = Noise{};
    other.lights = {sunlight()};
    CHECK(choose_integrator(other).name == std::string("cachedRatioTracking"));
    CHECK(choose_integrator(with_preset(other)).name == std::string("cachedRatioTracking"));
}
