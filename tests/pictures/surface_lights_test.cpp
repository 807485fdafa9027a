// Lamps and skies upon surfaces: closed forms, what hides a light, and looks from along flights.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "preset.h"
#include "shared/constants.h"
#include "support/agreement.h"
#include "support/images.h"
#include "support/surface_scenes.h"
#include "support/thorough.h"

using namespace vkvol;
using std::numbers::pi;

TEST_CASE("what shines is seen where no scattering is left", "[gpu][surfaces]") {
    Scene scene = empty_scene();
    scene.volumes = {medium(Sphere{{0.0, 0.0, 0.0}, 1.2}, 0.5, 0.0)};
    scene.surfaces = {ball_surface(matte(0.5))};
    scene.surfaces.front().emission = Rgb(2.0);
    scene.settings.max_depth = 0;
    scene.settings.choices.scattering = SCATTERING_NONE;
    const Film none = render_here(scene, 1).film;
    CHECK(image_mean(none).value.x > 0.1);
    scene.settings.choices.scattering = SCATTERING_SINGLE;
    CHECK_AGREEMENT(agree(render_here(scene, 2).film, none, "single scattering, of depth 0"));
}

// llvmpipe ends all loops of an invocation after 65535 iterations, and one that works for a turn only comes to no end.
TEST_CASE("no lamp of two thousand above a floor is lost, however long a lane works", "[gpu][surfaces]") {
    Scene scene = empty_scene(24);
    for (int i = 0; i < 2000; ++i)
        scene.lights.push_back(
            SphereLight{{0.05 * (i % 50) - 1.2, 0.5 + 0.02 * (i % 7), 0.05 * (i / 50) - 1.0}, 0.02, Rgb(20.0)});
    scene.surfaces = {surface_of(floor_piece, MaterialKind::diffuse), ball_surface(white(MaterialKind::mirror))};
    scene.settings.spp = 32;
    RenderJob briefly;
    briefly.plan.budget = 1;
    CHECK(same_bits(render_here(scene, 1).film, render_here(scene, 1, briefly).film));
}

TEST_CASE("looks and flights share a map of the sky on surfaces as in matter", "[gpu][image][surfaces][long]") {
    Scene scene = empty_scene();
    scene.lights = {write_sky(make_map(8, 4, [](int, int) { return Rgb(1.0); }))};
    scene.surfaces = {ball_surface(white(MaterialKind::diffuse)),
                      ball_surface(white(MaterialKind::dielectric), {1.1, 0.8, 0.9}, 0.5)};
    scene.volumes = {box_of_fog(0.8, 1.0)};
    scene.settings.spp = 256;
    const Film film = render_here(scene, 1).film;
    CHECK_AGREEMENT(agree_with_means(film, std::vector<Rgb>(film.mean.size(), Rgb(1.0)), "sky on surfaces"));
}

TEST_CASE("mirrors and glass show lamps as the camera sees them", "[gpu][image][surfaces]") {
    // Rays straight down turn to +x at a mirror, and there they meet a lamp of radiance L: 0.8 L, sample by sample.
    Scene scene = from_above(0.1);
    Surface mirror;
    mirror.shape = RectangleSurface{{0.0, 0.0, 0.0}, {0.5, -0.5, 0.0}, {0.0, 0.0, -0.5}};
    mirror.material = {MaterialKind::mirror, Rgb(0.8)};
    scene.surfaces = {mirror};
    const Rgb radiance(2.0, 3.0, 4.0);
    const SphereLight ball{{4.0, 0.0, 0.0}, 1.0, radiance};
    for (const Light& lamp : {Light(ball), Light(DiskLight{{4.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}, 1.0, radiance}),
                              Light(RectangleLight{{4.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, {0.0, 1.0, 0.0}, radiance})}) {
        CAPTURE(lamp.index());
        scene.lights = {lamp};
        check_everywhere(scene, 0.8 * radiance, 1e-5);
    }
    // Through fog in between a part of it.
    scene.lights = {ball};
    scene.volumes = {medium(Box{{2.0, 0.0, 0.0}, {1.0, 1.0, 1.0}}, 0.7, 0.0)};
    check_everywhere(scene, 0.8 * std::exp(-0.7) * radiance, 1e-5);
    // Through the middle of a ball of glass, what is not thrown back at its faces: (1 - R) / (1 + R), R = 0.04.
    scene.volumes.clear();
    Surface glass;
    glass.shape = BallSurface{{0.0, 1.0, 0.0}, 0.8};
    glass.material = white(MaterialKind::dielectric);
    glass.material.ior = 1.5;
    scene.surfaces = {glass};
    scene.lights = {SphereLight{{0.0, -3.0, 0.0}, 1.0, radiance}};
    scene.settings.spp = 4096;
    const Film film = render_here(scene, 1).film;
    CHECK_AGREEMENT(agree_with_means(film, std::vector<Rgb>(film.mean.size(), 0.96 / 1.04 * radiance), "glass"));
}

TEST_CASE("a floor under a lamp has the form factor of a disk", "[gpu][image][surfaces]") {
    // On the axis of a disk of radius r at height h: E = pi L r^2 / (r^2 + h^2). Off it by x it changes by less than
    // 3 (x / h)^2 of itself: the picture is so small that this is 1e-6.
    const double r = 0.8, h = 1.3, albedo = 0.6;
    Scene scene = from_above(1e-3);
    Surface floor;
    floor.shape = PlaneSurface{};
    floor.material = matte(albedo);
    scene.surfaces = {floor};
    scene.camera.position.y = 1.0;
    scene.settings.max_depth = 1;
    scene.settings.spp = 4096;
    const double expected = albedo * r * r / (r * r + h * h);
    scene.lights = {DiskLight{{0.0, h, 0.0}, {0.0, -1.0, 0.0}, r, Rgb(1.0)}};
    const Film looked = render_here(scene, 1).film;
    CHECK_AGREEMENT(agree_with_means(looked, std::vector<Rgb>(looked.mean.size(), Rgb(expected)), "lamp"));
    // The same as a surface that glows, which is looked for as a lamp is, or met by chance.
    scene.lights.clear();
    Surface glowing;
    glowing.shape = DiskSurface{{0.0, h, 0.0}, {0.0, -1.0, 0.0}, r};
    glowing.material = matte(0.0);
    glowing.emission = Rgb(1.0);
    scene.surfaces.push_back(glowing);
    const auto check = [&](const char* name) {
        const Film film = render_here(scene, 2).film;
        CHECK_AGREEMENT(agree_with_means(film, std::vector<Rgb>(film.mean.size(), Rgb(expected)), name));
    };
    check("glowing surface");
    // A black disk in the way takes the middle of it off.
    const double b = 0.2;
    Surface blocker;
    blocker.shape = DiskSurface{{0.0, 0.5 * h, 0.0}, {0.0, -1.0, 0.0}, b};
    blocker.material = matte(0.0);
    scene.surfaces.push_back(blocker);
    scene.camera.position.y = 0.4 * h;
    const double left = expected - albedo * 4.0 * b * b / (4.0 * b * b + h * h);
    const Film shadowed = render_here(scene, 5).film;
    CHECK_AGREEMENT(agree_with_means(shadowed, std::vector<Rgb>(shadowed.mean.size(), Rgb(left)), "behind a disk"));
    scene.surfaces.pop_back();
    scene.camera.position.y = 1.0;
    scene.settings.choices.nee = NEE_NONE;
    check("glowing surface, met by chance");
    // What looks are for: by chance p = r^2 / (r^2 + h^2) of the paths find it, and the variance of one is albedo^2 p.
    const double small = 0.05, p = small * small / (small * small + h * h);
    std::get<DiskSurface>(scene.surfaces.back().shape).radius = small;
    scene.settings.choices.nee = NEE_COLLISIONS;
    const Film looked_for = render_here(scene, 3).film;
    CHECK_AGREEMENT(agree_with_means(looked_for, std::vector<Rgb>(looked_for.mean.size(), Rgb(albedo * p)), "small"));
    CHECK(looked_for.variance.front().x < 0.01 * albedo * albedo * p / scene.settings.spp);
}

TEST_CASE("fog darkens a sunlit floor by both ways through it", "[gpu][image][surfaces][long]") {
    // Absorbing fog of height 1 above a floor: albedo / pi E cos(sun) exp(-tau / cos(sun)) exp(-tau).
    const double tau = 0.7, albedo = 0.5;
    const glm::dvec3 sun = glm::normalize(glm::dvec3(0.5, 1.0, -0.3));
    Scene scene = from_above(0.5);
    Surface floor;
    floor.shape = PlaneSurface{};
    floor.material = matte(albedo);
    scene.surfaces = {floor};
    scene.volumes = {medium(Box{{0.0, 0.5, 0.0}, {100.0, 1.0, 100.0}}, tau, 0.0)};
    scene.lights = {DirectionalLight{sun, Rgb(2.0)}};
    // The camera's ray is followed by chance, the sun's is known.
    scene.settings.spp = 4096;
    const double seen = albedo / pi * 2.0 * sun.y * std::exp(-tau / sun.y);
    const Film film = render_here(scene, 1).film;
    CHECK_AGREEMENT(agree_with_escapes(film, std::vector<double>(film.mean.size(), std::exp(-tau)), Rgb(seen), Rgb(0.0),
                                       "floor in fog"));
}

TEST_CASE("no sun shines through a triangle, a disk or a ball, nor a point through what it touches",
          "[gpu][surfaces][long]") {
    Scene scene = from_above(0.1, 8);
    scene.settings.spp = 16;
    scene.settings.integrator = "ratioTracking";
    Surface floor;
    floor.shape = PlaneSurface{};
    floor.material = matte(0.5);
    TriangleSurface triangle;
    triangle.vertices = {{-30.0, 1.0, -30.0}, {0.0, 1.0, 30.0}, {30.0, 1.0, -30.0}};
    triangle.triangles = {{0, 1, 2}};
    const std::vector<decltype(Surface::shape)> shades = {triangle, DiskSurface{{0.0, 1.0, 0.0}, {0.0, 1.0, 0.0}, 20.0},
                                                          BallSurface{{0.0, 11.0, 0.0}, 10.0}};
    for (const auto& shade : shades)
        for (const Light& light :
             {Light(DirectionalLight{{0.0, 1.0, 0.0}, Rgb(1.0)}), Light(PointLight{{0.0, 21.0, 0.0}, Rgb(400.0)})}) {
            Surface hides = floor;
            hides.shape = shade;
            hides.material = matte(0.0);
            scene.lights = {light};
            scene.surfaces = {floor};
            scene.camera.position = {0.0, 0.5, 0.0};
            const Film lit = render_here(scene, 1).film;
            scene.surfaces = {floor, hides};
            const Film dark = render_here(scene, 1).film;
            CAPTURE(shade.index(), light.index());
            CHECK(lit.mean.front().x > 0.0f);
            for (const glm::vec3& pixel : dark.mean)
                CHECK(pixel.x == 0.0f);
        }
}

// What comes straight from it, exp(-sigma_t) in each channel; what the fog scatters is cut off.
TEST_CASE("surfaces shine through fog of different extinctions", "[gpu][image][surfaces]") {
    const Rgb sigma_t(0.4, 0.8, 1.0);
    Scene scene = from_above(0.1, 16);
    Surface plane;
    plane.shape = PlaneSurface{};
    plane.material = matte(0.0);
    plane.emission = {1.0, 2.0, 3.0};
    scene.surfaces = {plane};
    GridRecipe even;
    even.last = glm::ivec3(7);
    even.value = [](glm::ivec3) { return 1.0f; };
    const Volume box = medium(Box{{0.0, 1.0, 0.0}, {3.0, 1.6, 3.0}}, 1.0, 0.5);
    Volume grid = medium(write_grid(even), 1.0, 0.5);
    grid.transform = glm::translate(glm::dmat4(1.0), {-0.8, 0.2, -0.8}) * glm::scale(glm::dmat4(1.0), glm::dvec3(0.2));
    scene.settings.filter = Filter::nearest;
    scene.settings.max_depth = 0;
    scene.settings.spp = 256;
    const Rgb expected = plane.emission * glm::exp(-1.6 * sigma_t);
    for (const auto& [volume, flight] : {std::pair(box, FREE_FLIGHT_ANALYTIC), std::pair(grid, FREE_FLIGHT_REGULAR),
                                         std::pair(grid, FREE_FLIGHT_DELTA), std::pair(grid, FREE_FLIGHT_MARCH)}) {
        CAPTURE(flight);
        scene.volumes = {volume};
        scene.volumes.front().sigma_s = scene.volumes.front().sigma_a = 0.5 * sigma_t;
        scene.volumes.front().unit = CoefficientUnit::world;
        scene.settings.choices.free_flight = flight;
        const Film film = render_here(scene, 1).film;
        CHECK_AGREEMENT(
            agree_with_means(film, std::vector<Rgb>(film.mean.size(), expected), fmt::format("{}", flight)));
    }
}

// Nothing bounds what a lamp there is near to.
TEST_CASE("a bright lamp at the camera shines over planes alone", "[gpu][image][surfaces]") {
    Scene scene = from_above(0.1);
    scene.camera.position = {0.0, 2.0, 0.0};
    Surface floor;
    floor.shape = PlaneSurface{};
    floor.material = matte(0.5);
    scene.surfaces = {floor};
    scene.settings.max_depth = 1;
    scene.lights = {PointLight{{0.0, 2.0, 0.0}, Rgb(1e9)}, PointLight{{0.0, 1e3, 0.0}, Rgb(1e9)}};
    scene.settings.spp = 1024;
    const double sum = 0.5 / pi * 1e9 * (1.0 / 4.0 + 1e-6);
    const Film film = render_here(scene, 1).film; // straight below but for a fortieth, whose square counts
    // A hundredth of the looks goes to the other one: 5 standard deviations of 1024.
    for (const glm::vec3& pixel : film.mean)
        CHECK(pixel.x == Approx(sum).epsilon(0.016));
}

// Flights that end at surfaces, from them and in the midst; mirrors and glass show lamps before these looks, lamps with
// bodies are in their own way, and a spot lights a part of a flight.
TEST_CASE("looks from along flights find the same light beside surfaces", "[gpu][image][surfaces]") {
    Scene scene = rough_still_life();
    scene.surfaces[1] = still_life().surfaces[1];
    scene.surfaces[3] = still_life().surfaces[3];
    scene.lights.push_back(SpotLight{{-0.6, 1.8, 1.2}, glm::normalize(glm::dvec3(0.2, -1.0, -0.4)), Rgb(6.0), 30.0});
    scene.settings.choices.distance = DISTANCE_MIXED;
    Scene several = scene;
    several.volumes.push_back(box_of_fog(0.3, 0.8));
    Scene steps = several;
    steps.settings.choices.nee = NEE_TENTATIVE;
    // Thin, and without sun and sky: else what lamps bring to surfaces would hardly be seen.
    scene.volumes = {box_of_fog(0.25, 0.9)};
    scene.background = Rgb(0.0);
    std::erase_if(scene.lights, [](const Light& light) { return std::holds_alternative<DirectionalLight>(light); });
    const std::vector<std::pair<std::string, Scene>> scenes = {{"fog, from along flights", scene},
                                                               {"smoke in fog, from along flights", several},
                                                               {"from along flights and every step", steps}};
    for (const auto& [name, each] : in_turn(scenes, 0))
        check_by_both_schedules(each, name);
}

// Behind a wall that parts the fog there is all of the light, and before it none.
TEST_CASE("looks from along flights do not go through walls", "[gpu][image][surfaces][long]") {
    Scene scene;
    scene.volumes = {box_of_fog(0.5, 0.9)};
    scene.lights = {PointLight{{0.0, 0.0, -1.0}, Rgb(10.0)}};
    scene.background = Rgb(0.0);
    scene.camera = Camera{};
    scene.camera.position = {0.0, 0.0, 12.0};
    scene.camera.fov = 20.0;
    scene.picture = {8, 8, 0.0, 0.0, 8.0, 8.0};
    scene.settings.choices.distance = DISTANCE_MIXED;
    scene.settings.spp = 256;
    Surface wall;
    wall.shape = RectangleSurface{{0.0, 0.0, 0.0}, {99.0, 0.0, 0.0}, {0.0, 99.0, 0.0}};
    wall.material.color = Rgb(0.0);
    scene.surfaces = {wall};
    CHECK(image_mean(render_here(scene, 1).film).value == glm::dvec3(0.0));
    scene.surfaces.front().shape = RectangleSurface{{0.0, 0.0, -2.0}, {99.0, 0.0, 0.0}, {0.0, 99.0, 0.0}};
    CHECK(image_mean(render_here(scene, 2).film).value.x > 0.01);
}

// Rays that go to a lamp end at its body, by rounding before it or behind.
TEST_CASE("the reference's lamps with bodies give what lamps without give", "[cpu][surfaces]") {
    const DiskSurface disk{{0.3, 3.0, 0.2}, glm::normalize(glm::dvec3(-0.1, -1.0, -0.2)), 0.5};
    Surface surface;
    surface.shape = disk;
    surface.material = matte(0.2);
    surface.emission = {5.0, 4.0, 3.0};
    Scene scene = scene_of(medium(Sphere{{0.0, 0.0, 0.0}, 1.0}, 1.0, 0.9), 2.5, 8);
    scene.settings.integrator = "ratioTracking";
    scene.settings.choices.scattering = SCATTERING_SINGLE;
    scene.settings.spp = 256;
    Scene without = scene;
    scene.surfaces = {surface};
    without.lights = {DiskLight{disk.center, disk.normal, disk.radius, surface.emission}};
    CHECK_AGREEMENT(agree(render_reference(with_preset(scene), 1), render_reference(without, 2), "lamp with a body"));
}

TEST_CASE("surfaces that shine are lamps with bodies", "[gpu][image][surfaces]") {
    // All shapes, from both sides, before and behind each other, as mirrors and glass show them, one itself of rough
    // glass; against the reference, which meets them by chance.
    Scene scene = still_life();
    scene.lights = {sunlight({0.3, 0.25, 0.2})};
    scene.surfaces.pop_back();
    const auto add = [&](SurfaceShape shape, const Rgb& emission, bool both) {
        Surface& surface = scene.surfaces.emplace_back();
        surface.shape = std::move(shape);
        surface.material = matte(0.6);
        surface.emission = emission;
        surface.shines_both_ways = both;
    };
    add(BallSurface{{0.1, -0.55, 1.2}, 0.35}, {1.0, 0.6, 0.3}, false);
    scene.surfaces.back().material = frosted(MaterialKind::dielectric, 0.4);
    add(BallSurface{{1.9, 1.0, 0.5}, 0.3}, {0.5, 0.9, 0.4}, true);
    add(DiskSurface{{-1.7, 0.9, -0.4}, glm::normalize(glm::dvec3(-1.0, 0.6, -0.5)), 0.5}, {1.5, 1.0, 0.5}, true);
    add(RectangleSurface{{0.0, 1.3, -1.0}, {0.6, 0.0, 0.0}, {0.0, 0.3, 0.2}}, {0.4, 0.5, 1.2}, false);
    check_by_both_schedules(scene, "lamps with bodies");
    Scene chance = scene;
    chance.settings.choices.nee = NEE_NONE;
    chance.lights.clear();
    scene.lights.clear();
    // The whole picture is compared: there are pixels that meet a lamp by chance once in thousands of samples.
    const Film by_chance = render_here(chance, 3).film, looked = render_here(scene, 4).film;
    for (int channel = 0; channel < 3; ++channel) {
        double difference = 0.0, variance = 0.0;
        for (std::size_t i = 0; i < looked.mean.size(); ++i) {
            difference += double(looked.mean[i][channel]) - by_chance.mean[i][channel];
            variance += double(looked.variance[i][channel]) + by_chance.variance[i][channel];
        }
        CHECK(std::abs(difference) < 4.0 * std::sqrt(variance)); // one in 16,000
    }
}

TEST_CASE("lamps do not hide themselves, however flat they are seen", "[gpu][image][surfaces]") {
    // A wall of light that stands a thousandth aside of the floor that it shines on, from 1 to 3 above it: where rays
    // meet it single precision knows to some 1e-4 of a way that shadow rays leave out less than half of.
    Scene scene = from_above(1e-4);
    Surface floor;
    floor.shape = PlaneSurface{};
    floor.material = matte(0.6);
    scene.surfaces = {floor};
    scene.settings.max_depth = 1;
    scene.settings.spp = 1024;
    const glm::dvec3 middle{-1e-3, 2.0, 0.0}, edge_u{0.0, 1.0, 0.0}, edge_v{0.0, 0.0, 1.0};
    scene.lights = {RectangleLight{middle, edge_u, edge_v, Rgb(1.0)}};
    const Film without = render_here(scene, 1).film;
    REQUIRE(image_mean(without).value.x > 0.0);
    scene.lights.clear();
    Surface& lamp = scene.surfaces.emplace_back();
    lamp.shape = RectangleSurface{middle, edge_u, edge_v};
    lamp.material = matte(0.0);
    lamp.emission = Rgb(1.0);
    CHECK_AGREEMENT(agree(render_here(scene, 2).film, without, "a body"));
}

TEST_CASE("lamps in a face of rough glass do not shine through it", "[gpu][image][surfaces][long]") {
    Scene scene = empty_scene();
    scene.surfaces = {ball_surface(frosted(MaterialKind::dielectric, 0.4), {0.0, 0.0, 0.0}, 1.0)};
    scene.lights = {SphereLight{{0.0, 0.0, 0.0}, 1.0, Rgb(1.0)}};
    scene.settings.spp = 1024;
    CHECK_AGREEMENT(agree(render_here(by(scene, "ratioTracking"), 1).film,
                          render_here(by(scene, "lightTracing"), 2).film, "lamp in a face"));
}
