// Surfaces: furnaces, closed forms, pictures against the reference, and what nothing may leak through.
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "shared/constants.h"
#include "support/agreement.h"
#include "support/images.h"
#include "support/surface_scenes.h"
#include "support/test_device.h"
#include "support/thorough.h"

using namespace vkvol;
using std::numbers::pi;

TEST_CASE("whatever scatters all light vanishes in an even sky, in fog too", "[gpu][image][surfaces]") {
    const std::vector<Material> materials = {white(MaterialKind::dielectric),
                                             white(MaterialKind::diffuse),
                                             frosted(MaterialKind::conductor, least_roughness),
                                             white(MaterialKind::mirror),
                                             frosted(MaterialKind::dielectric, 1.0),
                                             frosted(MaterialKind::conductor, 1.0),
                                             frosted(MaterialKind::dielectric, least_roughness),
                                             frosted(MaterialKind::dielectric, 0.3),
                                             white(MaterialKind::thin_dielectric)};
    bool first_in_fog = false;
    for (const Material& material : in_turn(materials, 0, 2)) {
        first_in_fog = !first_in_fog;
        for (const bool in_fog : {false, true}) {
            if (in_fog != first_in_fog && !thorough())
                continue;
            CAPTURE(static_cast<int>(material.kind), material.roughness, in_fog);
            Scene scene = empty_scene();
            scene.background = {1.0, 2.0, 0.5};
            scene.settings.roulette_threshold = 0.0;
            scene.surfaces = {ball_surface(material, {0.5, 0.3, 0.2}, 0.4), ball_surface(material)};
            scene.surfaces.back().shape = round_mesh(5, 0.25);
            if (in_fog)
                scene.volumes = {box_of_fog(1.5, 1.0)};
            // Weights are 1 but for rounding, of which a path has some at each of some dozens of vertices.
            check_everywhere(scene, scene.background, 2e-5);
        }
    }
}

TEST_CASE("facets and coats lose no light, found by looks or by flights", "[gpu][image][surfaces]") {
    Scene scene = empty_scene(8);
    scene.lights = {write_sky(make_map(8, 4, [](int, int) { return Rgb(1.0); }))};
    scene.settings.integrator = "ratioTracking";
    scene.settings.spp = 2048;
    struct Usual {
        Material material;
        int mis;
        bool in_fog;
    };
    const Usual usual[] = {{frosted(MaterialKind::conductor, 0.3), MIS_LIGHT, true},
                           {frosted(MaterialKind::dielectric, 0.6), MIS_BALANCE, false},
                           {white(MaterialKind::coated), MIS_PHASE, false},
                           {white(MaterialKind::coated), MIS_BALANCE, true}};
    for (const auto& [material, usual_mis, usually_in_fog] : usual)
        for (const int mis : {MIS_BALANCE, MIS_LIGHT, MIS_PHASE})
            for (const bool in_fog : {false, true}) {
                if ((mis != usual_mis || in_fog != usually_in_fog) && !thorough())
                    continue;
                CAPTURE(static_cast<int>(material.kind), mis, in_fog);
                scene.surfaces = {ball_surface(material)};
                scene.volumes.clear();
                if (in_fog)
                    scene.volumes = {box_of_fog(1.5, 1.0)};
                scene.settings.choices.mis = mis;
                const Film film = render_here(scene, 1).film;
                CHECK_AGREEMENT(agree_with_means(film, std::vector<Rgb>(film.mean.size(), Rgb(1.0)), "furnace"));
            }
}

// A mesh whose corners have the ball's normals, of each material.
TEST_CASE("faces that stand for something round equal the reference", "[gpu][image][surfaces]") {
    Scene scene = still_life();
    scene.volumes.clear();
    TriangleSurface mesh = round_mesh(4, 0.55);
    for (const glm::uvec3& t : mesh.triangles) {
        const auto normal = [&](unsigned i) { return glm::vec3(glm::normalize(mesh.vertices[i])); };
        mesh.normals.emplace_back(normal(t.x), normal(t.y), normal(t.z));
    }
    const Scene rough = rough_still_life();
    scene.surfaces.erase(scene.surfaces.begin() + 1, scene.surfaces.end() - 1);
    const std::pair<glm::dvec3, Material> balls[] = {{{-1.2, -0.3, 0.6}, matte(0.7)},
                                                     {{0.2, -0.3, 0.9}, white(MaterialKind::dielectric)},
                                                     {{1.4, -0.2, 0.2}, rough.surfaces[2].material},
                                                     {{0.4, 0.9, -0.4}, rough.surfaces[1].material}};
    for (const auto& [place, material] : balls) {
        Surface& surface = scene.surfaces.emplace_back(ball_surface(material));
        surface.shape = mesh;
        for (glm::dvec3& vertex : std::get<TriangleSurface>(surface.shape).vertices)
            vertex += place;
    }
    // A face alone, aslant to what it stands for: what would go through it would come to the sky.
    TriangleSurface leaf;
    leaf.vertices = {{-1.0, 0.3, 1.3}, {0.6, 0.3, 1.3}, {-0.3, 1.5, 0.9}};
    leaf.triangles = {{0, 1, 2}};
    leaf.normals = {glm::mat3(glm::normalize(glm::vec3(0.9, 0.2, 0.5)), glm::normalize(glm::vec3(0.8, 0.6, 0.4)),
                              glm::normalize(glm::vec3(-0.9, 0.3, 0.5)))};
    scene.surfaces.emplace_back(ball_surface(matte(0.8))).shape = leaf;
    scene.background = {1.0, 1.5, 2.5};
    check_by_both_schedules(scene, "smooth faces");
}

// Products of edges are of the fourth power of a scene's size.
TEST_CASE("smooth faces are as smooth in scenes of any size", "[gpu][image][surfaces]") {
    const auto at_scale = [](double scale) {
        Scene scene = empty_scene();
        scene.camera.position *= scale;
        scene.camera.lens.focus *= scale;
        TriangleSurface mesh = round_mesh(4, scale);
        for (const auto& triangle : mesh.triangles) {
            glm::mat3 normals;
            for (int corner = 0; corner < 3; ++corner)
                normals[corner] = glm::normalize(mesh.vertices[triangle[corner]]);
            mesh.normals.push_back(normals);
        }
        scene.surfaces = {ball_surface(matte(0.8))};
        scene.surfaces.front().shape = mesh;
        scene.lights = {sunlight()};
        scene.background = Rgb(0.2);
        return scene;
    };
    const Film usual = render_here(at_scale(1.0), 1).film;
    for (const double scale : {1e-7, 1e6, 1e10})
        CHECK_AGREEMENT(agree(render_here(at_scale(scale), 2).film, usual, fmt::format("scale {}", scale)));
}

TEST_CASE("a pane of glass and a metal reflect what Fresnel says", "[gpu][image][surfaces]") {
    // Between its faces light goes to and fro: R = 2 F / (1 + F), T = (1 - F) / (1 + F).
    Scene scene = from_above(0.5);
    scene.settings.roulette_threshold = 0.0;
    Surface pane;
    TriangleSurface box;
    for (int corner = 0; corner < 8; ++corner)
        box.vertices.push_back(glm::dvec3(8.0, 0.3, 8.0) *
                               (glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2) - 0.5));
    box.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                     {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    pane.shape = box;
    pane.material = white(MaterialKind::dielectric);
    Surface below;
    below.shape = PlaneSurface{{0.0, -2.0, 0.0}, {0.0, 1.0, 0.0}};
    below.material = matte(0.0);
    below.emission = Rgb(1.0);
    scene.surfaces = {pane, below};
    scene.settings.spp = 8192;
    for (const double tilt : {0.0, 50.0}) {
        CAPTURE(tilt);
        scene.camera.pitch = -90.0 + tilt;
        scene.camera.position = {0.0, 3.0 * std::cos(tilt * pi / 180.0), 3.0 * std::sin(tilt * pi / 180.0)};
        const double c = std::cos(tilt * pi / 180.0), beyond = std::sqrt(1.0 - (1.0 - c * c) / 2.25);
        const double across = (c - 1.5 * beyond) / (c + 1.5 * beyond), along = (1.5 * c - beyond) / (1.5 * c + beyond);
        const double F = 0.5 * (across * across + along * along);
        Scene thin = scene;
        thin.surfaces.front().shape = PlaneSurface{};
        thin.surfaces.front().material = white(MaterialKind::thin_dielectric);
        for (const Scene& each : {scene, thin}) {
            const Film film = render_here(each, 1).film;
            CHECK_AGREEMENT(agree_with_escapes(film, std::vector<double>(film.mean.size(), (1.0 - F) / (1.0 + F)),
                                               Rgb(1.0), Rgb(0.0), "pane"));
        }
    }
    // Within the glass what shines is as bright as it says, and outside by 1 / n^2 of that.
    std::get<PlaneSurface>(scene.surfaces.back().shape).point.y = 0.0;
    scene.camera.pitch = -90.0;
    scene.camera.position = {0.0, 3.0, 0.0};
    const Film within = render_here(scene, 1).film;
    CHECK_AGREEMENT(agree_with_escapes(within, std::vector<double>(within.mean.size(), 0.96), Rgb(1.0 / 2.25), Rgb(0.0),
                                       "within glass"));
    // Straight on, F = ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2).
    Surface metal;
    metal.shape = PlaneSurface{};
    metal.material = white(MaterialKind::conductor);
    metal.material.eta = {0.143, 0.375, 1.442};
    metal.material.k = {3.983, 2.386, 1.603};
    Scene mirror = from_above(0.5);
    mirror.surfaces = {metal};
    mirror.background = Rgb(1.0);
    const Rgb n = metal.material.eta, k = metal.material.k;
    check_everywhere(mirror, ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k), 1e-5);
}

TEST_CASE("no ray leaves a closed mesh", "[gpu][image][surfaces]") {
    Scene scene = empty_scene(40);
    scene.camera = {};
    scene.camera.projection = Projection::equirectangular;
    scene.background = Rgb(1.0);
    Surface room;
    room.shape = round_mesh(40, 1.0);
    room.material = matte(0.0);
    scene.surfaces = {room};
    check_everywhere(scene, Rgb(0.0), 0.0);
    // Nor do paths that bounce about within it; from far away, where digits are few.
    scene.surfaces.front().material = white(MaterialKind::diffuse);
    scene.settings.max_depth = 30;
    scene.settings.spp = 8;
    for (const double scale : {1e-4, 1.0, 1e5}) {
        CAPTURE(scale);
        Scene scaled = scene;
        for (glm::dvec3& vertex : std::get<TriangleSurface>(scaled.surfaces.front().shape).vertices)
            vertex = scale * (vertex + glm::dvec3(30.0, -20.0, 10.0));
        scaled.camera.position = scale * glm::dvec3(30.0, -20.0, 10.0);
        check_everywhere(scaled, Rgb(0.0), 0.0);
    }
}

TEST_CASE("surfaces among media equal the reference, by both schedules", "[gpu][image][surfaces][long]") {
    const Scene scene = still_life();
    if (thorough())
        check_by_both_schedules(scene, "still life");
    check_by_both_schedules(rough_still_life(), "rough still life");
    Scene several = scene;
    several.volumes.push_back(medium(Box{{0.6, -0.4, 0.4}, {1.6, 0.9, 1.6}}, 1.0, 0.7, -0.2));
    several.volumes.back().sigma_s = {0.5, 0.6, 0.7};
    several.volumes.back().sigma_a = Rgb(0.8) - several.volumes.back().sigma_s;
    CHECK_AGREEMENT(agree(render_here(several, 1).film, render_reference(several, 2), "several media"));
    Scene bare = scene;
    bare.volumes.clear();
    CHECK_AGREEMENT(agree(render_here(bare, 1).film, render_reference(bare, 2), "no medium"));
}

TEST_CASE("a depth limit counts surfaces as the reference does", "[gpu][image][surfaces]") {
    for (const std::uint32_t depth : {1u, 2u, 3u}) {
        Scene scene = still_life();
        scene.settings.max_depth = depth;
        CHECK_AGREEMENT(agree(render_here(scene, 1).film, render_reference(scene, 2), fmt::format("depth {}", depth)));
    }
}

// By roulette that does not ask for throughput, which is 1 for ever.
TEST_CASE("light comes out of what it may be in for ever", "[gpu][image][surfaces]") {
    Scene stone = empty_scene();
    stone.background = Rgb(1.0);
    stone.surfaces = {ball_surface(white(MaterialKind::dielectric))};
    stone.surfaces.front().shape = round_mesh(3, 1.0);
    stone.surfaces.front().material.ior = 2.4;
    stone.settings.spp = 1024;
    const Film seen = render_here(stone, 1).film;
    CHECK_AGREEMENT(agree_with_means(seen, std::vector<Rgb>(seen.mean.size(), Rgb(1.0)), "a cut stone"));
    // Between white walls nothing but roulette ends a path.
    Scene room = empty_scene(8);
    room.camera = {};
    Surface walls;
    walls.shape = round_mesh(6, 1.0);
    walls.material = white(MaterialKind::diffuse);
    room.surfaces = {walls};
    room.settings.max_depth.reset();
    room.settings.spp = 4;
    check_everywhere(room, Rgb(0.0), 0.0);
}

// Between walls of albedo r that shine with radiance 1 - r themselves: 1, a fifth of it by what has met seventy walls
// or more.
TEST_CASE("roulette keeps the light between bright walls", "[gpu][image][surfaces]") {
    Scene room = empty_scene(8);
    room.camera = {};
    Surface walls;
    walls.shape = round_mesh(6, 1.0);
    walls.material = white(MaterialKind::diffuse);
    walls.material.color = Rgb(0.98);
    walls.emission = Rgb(0.02);
    walls.shines_both_ways = true;
    room.surfaces = {walls};
    room.settings.max_depth.reset();
    room.settings.spp = 256;
    for (const double threshold : {0.1, 0.9}) {
        room.settings.roulette_threshold = threshold;
        check_means(room, 1.0, "roulette below " + std::to_string(threshold));
    }
}

TEST_CASE("surfaces among media are the same for every estimator", "[gpu][image][surfaces][long]") {
    Scene scene = still_life();
    scene.settings.spp = 96;
    const Film expected = render_here(scene, 1).film;
    std::vector<Combination> one_axis;
    for (const Combination& combination : unbiased_combinations(scene)) {
        const AxisChoices& choices = combination.choices;
        const int unusual = (choices.free_flight != FREE_FLIGHT_DELTA) +
                            (choices.transmittance != TRANSMITTANCE_RATIO) + (choices.nee != NEE_COLLISIONS) +
                            (choices.emission.value_or(EMISSION_AT_COLLISIONS) != EMISSION_AT_COLLISIONS);
        if (unusual == 1)
            one_axis.push_back(combination);
    }
    for (const Combination& combination : in_turn(one_axis, 0)) {
        Scene other = scene;
        other.settings.choices = combination.choices;
        CHECK_AGREEMENT(agree(render_here(other, 2).film, expected, combination.name));
    }
}

TEST_CASE("coats mirror what majorants below the density leave, of either sign", "[gpu][image][surfaces]") {
    Scene scene = empty_scene(8, 0.1); // which the ball fills
    scene.background = Rgb(1.0);
    scene.volumes = {box_of_fog(2.0, 0.0)};
    scene.surfaces = {ball_surface(white(MaterialKind::coated))};
    scene.surfaces.front().material.color = Rgb(0.0); // the coat alone
    scene.settings.spp = 4096;
    scene.settings.integrator = "deltaTracking";
    const Film expected = render_here(scene, 1).film;
    scene.settings.majorant_scale = 0.5;
    RenderJob job;
    job.crop = {0, 8, 0, 8};
    for (const int flight : {FREE_FLIGHT_WEIGHTED, FREE_FLIGHT_SPECTRAL}) {
        scene.settings.choices.free_flight = flight;
        const RenderResult result = render(test_device(), scene, job);
        CHECK(result.counts.majorant_violations > 0);
        CHECK_AGREEMENT(agree(result.film, expected, fmt::format("flight {}", flight)));
    }
}
