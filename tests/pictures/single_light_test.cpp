// Each light alone, against integrals that know nothing of looks, weights or random numbers.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <numbers>

#include "daylight.h"
#include "phase_params.h"
#include "phase_table.h"
#include "shared/constants.h"
#include "support/agreement.h"
#include "support/images.h"
#include "support/scenes.h"
#include "support/surface_scenes.h"
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

// From midpoints of all directions.
Around around(const std::function<Rgb(const glm::dvec3&)>& sky, int rows) {
    std::vector<From> all;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < 2 * rows; ++column) {
            const double y = 1.0 - (2.0 * row + 1.0) / rows, turn = pi * (column + 0.5) / rows;
            const double across = std::sqrt(1.0 - y * y);
            const glm::dvec3 direction(across * std::cos(turn), y, across * std::sin(turn));
            all.push_back({direction, 4.0 * pi * sky(direction)});
        }
    return [all](const glm::dvec3&) { return all; };
}

// From midpoints of parts of a light.
Around around(const Light& light, int parts) {
    return [light, parts](const glm::dvec3& p) {
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

struct LoneLight {
    const char* name;
    std::vector<Light> lights;
    Around around;
    std::vector<Surface> surfaces = {};
    Rgb background{0.0};
};

LoneLight lone(const char* name, const Light& light, int parts) {
    return {name, {light}, around(light, parts)};
}

// Cut into parts x parts, a sky into rows of twice as many.
std::vector<LoneLight> lone_lights(int parts, int rows) {
    const glm::dvec3 up = glm::normalize(glm::dvec3(1.0, 2.0, 0.5));
    const glm::dvec3 aside = glm::normalize(glm::dvec3(3.0, -2.0, -1.0));
    const RectangleLight below{{0.0, -2.5, 1.0}, {0.0, 0.0, 0.8}, {1.5, 0.0, 0.0}, {5.0, 4.0, 6.0}};
    Surface pane;
    pane.shape = RectangleSurface{below.center, below.edge_u, below.edge_v};
    pane.material = matte(0.0);
    pane.emission = below.radiance;
    SkyLight day;
    day.daylight = Daylight{up, 4.0, 0.3};
    const auto of_day = reference::load_sky({write_sky(make_daylight(*day.daylight))});
    const auto day_sky = [of_day](const glm::dvec3& direction) { return of_day->radiance(direction); };
    const auto sky = [](const glm::dvec3& direction) { return Rgb(gradient(direction)); };
    return {lone("directional", DirectionalLight{up, {3.0, 2.0, 1.0}}, parts),
            lone("sun", SunLight{up, {3.0, 2.5, 2.0}, 8.0}, parts),
            lone("wide sun of a dark limb", SunLight{up, {3.0, 2.5, 2.0}, 100.0, 1.0}, parts),
            lone("point", PointLight{{3.0, 2.5, 1.0}, {20.0, 10.0, 5.0}}, parts),
            lone("spot", SpotLight{{0.0, 4.0, 2.0}, glm::normalize(glm::dvec3(0.0, -2.0, -1.0)), Rgb(60.0), 60.0, 1.0},
                 parts),
            lone("ball", SphereLight{{2.5, 2.5, 1.0}, 1.0, {4.0, 3.0, 2.0}}, parts),
            lone("disk", DiskLight{{-3.0, 2.0, 1.0}, aside, 1.0, {4.0, 5.0, 6.0}}, parts),
            lone("rectangle", below, parts),
            {"pane that shines", {}, around(below, parts), {pane}},
            {"sky", {gradient_sky(SkyMapping::equirectangular)}, around(sky, rows)},
            {"square sky", {gradient_sky(SkyMapping::equal_area)}, around(sky, rows)},
            {"daylight", {day}, around(day_sky, rows)},
            {"even sky", {}, around([](const glm::dvec3&) { return Rgb(2.0, 1.0, 3.0); }, rows), {}, {2.0, 1.0, 3.0}}};
}

// Maps by looks and flights, though they are so even that flights alone are the default.
void light_by(const LoneLight& lone, Scene& scene) {
    if (std::string(lone.name).ends_with("sky") && !lone.lights.empty())
        scene.settings.choices.mis = MIS_BALANCE;
    scene.lights = lone.lights;
    scene.surfaces = lone.surfaces;
    scene.background = lone.background;
}

RenderJob job_by(Schedule schedule) {
    RenderJob job;
    job.plan.schedule = schedule;
    return job;
}

// The reference's map of a day is one that is read from a file.
Scene for_the_reference(Scene scene) {
    for (Light& light : scene.lights)
        if (auto* sky = std::get_if<SkyLight>(&light); sky && sky->daylight)
            *sky = write_sky(make_daylight(*sky->daylight));
    return scene;
}

// Each by one schedule, here and by the reference, whose rays find light by chance; all by both if thorough.
void check_means_of(Scene scene, const std::vector<Rgb>& means, std::size_t turn, const std::string& name) {
    for (const Schedule schedule : in_turn<Schedule>({Schedule::fused, Schedule::staged}, turn, 2))
        CHECK_AGREEMENT(agree_with_means(render_here(scene, 21, job_by(schedule)).film, means, name));
    if (reads_flux(scene.camera))
        scene.settings.spp *= 8;
    else if (!scene.surfaces.empty()) // which its paths seldom meet
        return;
    CHECK_AGREEMENT(agree_with_means(render_reference(for_the_reference(scene), 22), means, name + ", the reference"));
}

} // namespace

TEST_CASE("light that each light scatters once equals the quadrature, in thin and in thick fog",
          "[gpu][lights][closed_form]") {
    std::size_t turn = 0;
    for (const LoneLight& lone : lone_lights(24, 30)) {
        ++turn;
        for (const double sigma_t : in_turn<double>({0.1, 3.0}, turn, 2)) {
            Scene scene = scene_of(medium(Box{{0, 0, 0}, 2.0 * half_edges}, sigma_t, 0.9, 0.4), 1.2, 8, 20.0,
                                   glm::dvec3(0.0), {10.0, -20.0, 0.0});
            light_by(lone, scene);
            scene.holds_out = true;
            scene.settings.max_depth = 1;
            scene.settings.spp = 2048;
            const reference::Medium fog = reference::load(scene.volumes.front(), Filter::trilinear);
            std::vector<Rgb> expected;
            for (int pixel = 0; pixel < 64; ++pixel) {
                Rgb sum(0.0);
                for (int k = 0; k < 4; ++k)
                    sum += 0.25 * scattered_once(fog, lone.around,
                                                 reference::camera_ray(scene.camera, scene.picture,
                                                                       pixel % 8 + 0.25 + 0.5 * (k % 2),
                                                                       pixel / 8 + 0.25 + 0.5 * (k / 2))); // NOLINT
                expected.push_back(sum);
            }
            check_means_of(scene, expected, turn / 2, fmt::format("{}, {} per unit", lone.name, sigma_t));
        }
    }
}

// What is left of it at points in a box that absorbs: the mean over directions of its light, times exp of the way out.
TEST_CASE("each light's shadow in a slab that absorbs is its closed form", "[gpu][lights][flux][closed_form][long]") {
    std::size_t turn = 0;
    for (const LoneLight& lone : lone_lights(48, 192)) {
        Scene scene;
        scene.camera.projection = Projection::fluence;
        scene.camera.points = {{0.0, 0.0, -0.4}, {0.7, -0.9, 0.1}, {-0.8, 0.5, 0.3}, {0.2, 0.95, -0.1}};
        scene.camera.position = scene.camera.points.front();
        scene.picture = {4, 1, 0.0, 0.0, 4.0, 1.0};
        scene.volumes = {medium(Box{{0, 0, 0}, 2.0 * half_edges}, 1.2, 0.0)};
        light_by(lone, scene);
        scene.settings.spp = thorough() ? 1 << 14 : 1 << 12;
        std::vector<Rgb> expected;
        for (const glm::dvec3& point : scene.camera.points) {
            Rgb sum(0.0);
            const std::vector<From> all = lone.around(point);
            for (const From& from : all)
                sum += std::exp(-1.2 * way_out(point, from.direction)) * from.light;
            expected.push_back(sum / double(all.size()));
        }
        check_means_of(scene, expected, ++turn, fmt::format("shadow, {}", lone.name));
    }
}

// Of a sky L = 1 + a (n . w) any phase function of mean cosine g scatters 1 + a g (n . d) toward where a ray along d
// comes from.
TEST_CASE("a furnace of a gradient, of every phase function", "[gpu][lights][furnace][phase][long]") {
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
        const double g = mean_cosine(phase.of(Volume{}), phase_table(phase.of(Volume{})).nodes);
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
