// Each light alone, against integrals that know nothing of looks, weights or random numbers.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <numbers>

#include "phase_params.h"
#include "phase_table.h"
#include "shared/constants.h"
#include "support/agreement.h"
#include "support/images.h"
#include "support/scenes.h"
#include "support/test_sky.h"
#include "support/thorough.h"
#include "tests/reference/phase.h"
#include "tests/reference/reference.h"
#include "tests/reference/reference_lights.h"

using namespace vkvol;
using std::numbers::pi;

namespace {

const glm::dvec3 half_edges(1.0, 1.0, 0.5);

// From within the box about the origin, or along all of it.
double way_out(const glm::dvec3& from, const glm::dvec3& direction) {
    double end = 1e30;
    for (int axis = 0; axis < 3; ++axis)
        if (direction[axis] != 0.0)
            end = std::min(end, (std::copysign(half_edges[axis], direction[axis]) - from[axis]) / direction[axis]);
    return end;
}

// A sky that grows brighter towards one side, of no axis in particular.
constexpr double slope = 0.8;
double along(const glm::dvec3& direction) {
    return glm::dot(direction, glm::dvec3(2.0, 6.0, -3.0) / 7.0);
}
double gradient(const glm::dvec3& direction) {
    return 1.0 + slope * along(direction);
}

// Interpolation errs by less than 2e-4 in maps by longitude and latitude; in those of equal areas by 5e-3 at most,
// where they are folded, by 2e-4 as a root of the mean square, and by 1e-5 in the mean.
SkyLight gradient_sky(SkyMapping mapping) {
    const bool by_latitude = mapping == SkyMapping::equirectangular;
    const int size = by_latitude ? 128 : 256;
    return write_sky(make_map(size, size,
                              [&](int column, int row) {
                                  const double u = (column + 0.5) / size, v = (row + 0.5) / size;
                                  const double longitude = 2.0 * pi * (u - 0.5), across = std::sin(pi * v);
                                  const glm::dvec3 m = reference::equal_area_direction({u, v});
                                  return Rgb(gradient(by_latitude
                                                          ? glm::dvec3(across * std::sin(longitude), std::cos(pi * v),
                                                                       -across * std::cos(longitude))
                                                          : glm::dvec3(m.x, m.z, m.y)));
                              }),
                     mapping);
}

// What comes to a point of the box from one direction of many, of equal weight.
struct From {
    glm::dvec3 direction;
    Rgb light;
};
using Around = std::function<std::vector<From>(const glm::dvec3&)>;

// From midpoints of parts of the light, or of all directions.
Around around(const Light& light) {
    constexpr int parts = 12, rows = 48;
    if (std::holds_alternative<SkyLight>(light)) {
        std::vector<From> sky;
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < 2 * rows; ++column) {
                const double y = 1.0 - (2.0 * row + 1.0) / rows, turn = pi * (column + 0.5) / rows;
                const double across = std::sqrt(1.0 - y * y);
                const glm::dvec3 direction(across * std::cos(turn), y, across * std::sin(turn));
                sky.push_back({direction, Rgb(4.0 * pi * gradient(direction))});
            }
        return [sky](const glm::dvec3&) { return sky; };
    }
    return [light](const glm::dvec3& p) {
        std::vector<From> from;
        for (int k = 0; k < parts * parts; ++k) {
            const auto found =
                reference::towards(light, p, (k % parts + 0.5) / parts, (k / parts + 0.5) / parts); // NOLINT
            from.push_back(found ? From{found->ray.direction, found->light} : From{{0.0, 1.0, 0.0}, Rgb(0.0)});
        }
        return from;
    };
}

// Along a ray through the box: the integral of sigma_s p T T' L, by five Gauss points in each of eight parts.
Rgb scattered_once(const reference::Medium& medium, const Around& around, const reference::Ray& ray) {
    constexpr std::array<double, 5> nodes{-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                                          0.9061798459386640};
    constexpr std::array<double, 5> weights{0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                            0.4786286704993665, 0.2369268850561891};
    constexpr int cuts = 8;
    const double begin = -way_out(ray.origin, -ray.direction), length = way_out(ray.origin, ray.direction) - begin;
    Rgb sum(0.0);
    for (int i = 0; i < 5 * cuts; ++i) {
        const double t = length * (i / 5 + 0.5 + 0.5 * nodes[std::size_t(i % 5)]) / cuts;
        const glm::dvec3 p = ray.at(begin + t);
        Rgb found(0.0);
        const std::vector<From> all = around(p);
        for (const From& from : all)
            found += glm::exp(-medium.sigma_t * way_out(p, from.direction)) *
                     reference::phase_eval(medium, glm::dot(from.direction, ray.direction)) * from.light;
        sum += 0.5 * length / cuts * weights[std::size_t(i % 5)] * medium.sigma_t * glm::exp(-medium.sigma_t * t) *
               found / double(all.size());
    }
    return medium.albedo * sum;
}

struct NamedLight {
    const char* name;
    Light light;
};

std::vector<NamedLight> lone_lights() {
    const glm::dvec3 up = glm::normalize(glm::dvec3(1.0, 2.0, 0.5));
    const glm::dvec3 aside = glm::normalize(glm::dvec3(3.0, -2.0, -1.0));
    return {{"directional", DirectionalLight{up, {3.0, 2.0, 1.0}}},
            {"sun", SunLight{up, {3.0, 2.5, 2.0}, 8.0}},
            {"wide sun of a dark limb", SunLight{up, {3.0, 2.5, 2.0}, 100.0, 1.0}},
            {"point", PointLight{{3.0, 2.5, 1.0}, {20.0, 10.0, 5.0}}},
            {"spot", SpotLight{{0.0, 4.0, 2.0}, glm::normalize(glm::dvec3(0.0, -2.0, -1.0)), Rgb(60.0), 60.0, 1.0}},
            {"ball", SphereLight{{2.5, 2.5, 1.0}, 1.0, {4.0, 3.0, 2.0}}},
            {"disk", DiskLight{{-3.0, 2.0, 1.0}, aside, 1.0, {4.0, 5.0, 6.0}}},
            {"rectangle", RectangleLight{{0.0, -2.5, 1.0}, {0.0, 0.0, 0.8}, {1.5, 0.0, 0.0}, {5.0, 4.0, 6.0}}},
            {"sky", gradient_sky(SkyMapping::equirectangular)},
            {"square sky", gradient_sky(SkyMapping::equal_area)}};
}

} // namespace

TEST_CASE("light that each light scatters once equals the quadrature, in thin and in thick fog",
          "[gpu][lights][closed_form]") {
    for (const NamedLight& lone : in_turn(lone_lights(), 0, 2))
        for (const double sigma_t : {0.1, 3.0}) {
            Scene scene = scene_of(medium(Box{{0, 0, 0}, 2.0 * half_edges}, sigma_t, 0.9, 0.4), 1.2, 8, 20.0,
                                   glm::dvec3(0.0), {10.0, -20.0, 0.0});
            scene.lights = {lone.light};
            scene.holds_out = true;
            scene.settings.max_depth = 1;
            scene.settings.spp = 2048;
            const reference::Medium fog = reference::load(scene.volumes.front(), Filter::trilinear);
            const Around light = around(lone.light);
            std::vector<Rgb> expected;
            for (int pixel = 0; pixel < 64; ++pixel) {
                Rgb sum(0.0);
                for (int k = 0; k < 4; ++k)
                    sum += 0.25 * scattered_once(fog, light,
                                                 reference::camera_ray(scene.camera, scene.picture,
                                                                       pixel % 8 + 0.25 + 0.5 * (k % 2),
                                                                       pixel / 8 + 0.25 + 0.5 * (k / 2))); // NOLINT
                expected.push_back(sum);
            }
            CHECK_AGREEMENT(agree_with_means(render_here(scene, 21).film, expected,
                                             fmt::format("{}, {} per unit", lone.name, sigma_t)));
        }
}

// Of a sky L = 1 + a (n . w) any phase function of mean cosine g scatters 1 + a g (n . d) toward where a ray along d
// comes from.
TEST_CASE("a furnace of a gradient, of every phase function", "[gpu][lights][furnace][phase]") {
    // So thin that what is scattered twice, and lost on the way, is below 1e-3 of it.
    constexpr double sigma_t = 5e-5;
    const std::array<SkyLight, 2> skies{gradient_sky(SkyMapping::equirectangular),
                                        gradient_sky(SkyMapping::equal_area)};
    std::size_t turn = 0;
    for (const NamedPhase& phase : in_turn(all_phases(), 2, 3)) {
        Scene scene =
            scene_of(phase.of(medium(cloud_file(), sigma_t, 1.0)), 2.5, 8, 25.0, glm::dvec3(0.0), {60.0, 25.0, 0.0});
        scene.camera.projection = Projection::orthographic;
        scene.camera.view_height = 2.5;
        scene.lights = {skies[++turn % 2]};
        scene.holds_out = true;
        scene.settings.spp = 32768;
        scene.settings.integrator = "ratioTracking";
        scene.settings.choices.first_flight = FIRST_FLIGHT_SPLIT;
        scene.settings.choices.nee = NEE_COLLISIONS;
        const auto nodes = phase.kind == PhaseFunction::table ? load_phase_table(phase.details.file).nodes
                                                              : std::vector<shared::PhaseNode>{};
        const double g = mean_cosine(phase.of(Volume{}), nodes);
        const reference::Medium fog = reference::load(scene.volumes.front(), scene.settings.filter);
        constexpr int across = 6;
        std::vector<Rgb> expected;
        for (int pixel = 0; pixel < 64; ++pixel) {
            double sum = 0.0;
            for (int k = 0; k < across * across; ++k) {
                const reference::Ray ray =
                    reference::camera_ray(scene.camera, scene.picture, pixel % 8 + (k % across + 0.5) / across,
                                          pixel / 8 + (k / across + 0.5) / across); // NOLINT
                sum += reference::optical_depth(fog, ray, 0.0, 1e9) * (1.0 + slope * g * along(ray.direction));
            }
            expected.push_back(Rgb(sum / (across * across)));
        }
        CHECK_AGREEMENT(agree_with_means(render_here(scene, 16).film, expected, phase.name));
    }
}
