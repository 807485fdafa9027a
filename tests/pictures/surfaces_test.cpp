// Surfaces: furnaces, closed forms, pictures against the reference, and what nothing may leak through.
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "error.h"
#include "preset.h"
#include "scene_hash.h"
#include "support/agreement.h"
#include "support/images.h"
#include "support/scene_text.h"
#include "support/scenes.h"
#include "support/thorough.h"

using namespace vkvol;
using Catch::Contains;
using std::numbers::pi;

namespace {

Surface ball(const Material& material, glm::dvec3 center = glm::dvec3(0.0), double radius = 1.0) {
    Surface surface;
    surface.shape = BallSurface{center, radius};
    surface.material = material;
    return surface;
}

Material white(MaterialKind kind) {
    Material material;
    material.kind = kind;
    material.color = Rgb(1.0);
    return material;
}

Material grey(double albedo) {
    return {MaterialKind::diffuse, Rgb(albedo)};
}

// A closed mesh of a ball, of `n` bands of latitude.
TriangleSurface round_mesh(int n, double radius) {
    TriangleSurface mesh;
    const int columns = 2 * n;
    for (int row = 0; row <= n; ++row)
        for (int column = 0; column < columns; ++column) {
            const double latitude = pi * row / n, longitude = 2.0 * pi * column / columns;
            mesh.vertices.push_back(radius * glm::dvec3(std::sin(latitude) * std::cos(longitude), std::cos(latitude),
                                                        -std::sin(latitude) * std::sin(longitude)));
        }
    for (unsigned row = 0; row < unsigned(n); ++row)
        for (unsigned column = 0; column < unsigned(columns); ++column) {
            const unsigned next = (column + 1) % unsigned(columns), c = unsigned(columns);
            const unsigned a = row * c + column, b = row * c + next;
            mesh.triangles.push_back({a, a + c, b + c});
            mesh.triangles.push_back({a, b + c, b});
        }
    return mesh;
}

Scene empty_scene(int pixels = 12, double width = 2.6) {
    Scene scene = scene_of(medium(Sphere{{0.0, 0.0, 0.0}, 1.0}, 0.0, 0.0), width, pixels, 8.0, glm::dvec3(0.0),
                           {14.0, 23.0, 5.0});
    scene.volumes.clear();
    scene.settings.spp = 64;
    return scene;
}

// Rays side by side, straight down onto a square of this width about the origin.
Scene from_above(double width, int pixels = 4) {
    Scene scene = empty_scene(pixels);
    scene.camera = {};
    scene.camera.projection = Projection::orthographic;
    scene.camera.view_height = width;
    scene.camera.position = {0.0, 5.0, 0.0};
    scene.camera.pitch = -90.0;
    return scene;
}

void check_everywhere(const Scene& scene, const Rgb& expected, double relative) {
    const Film film = render_here(scene, 1).film;
    for (const glm::vec3& mean : film.mean)
        for (int i = 0; i < 3; ++i)
            CHECK(mean[i] == Approx(expected[i]).epsilon(relative).margin(1e-7));
}

// Against the reference, and the other schedule's bits.
void check_by_both_schedules(const Scene& scene, const std::string& name) {
    const Film film = render_here(scene, 1).film;
    CHECK_AGREEMENT(agree(film, render_reference(scene, 2), name));
    RenderJob staged;
    staged.plan.schedule = Schedule::staged;
    CHECK(same_bits(film, render_here(scene, 1, staged).film));
}

Volume box_of_fog(double sigma_t, double albedo) {
    return medium(Box{{0.0, 0.0, 0.0}, {3.0, 3.0, 3.0}}, sigma_t, albedo, 0.4);
}

// A ball of noise above a floor, with glass, metal, a mirror and something that glows, under lights of all kinds.
Scene still_life() {
    Volume smoke = medium(Sphere{{-0.4, 0.3, 0.1}, 0.8}, 4.0, 0.9, 0.3);
    smoke.noise = Noise{1.3, 3, 0.5, 2.0};
    Scene scene = scene_of(smoke, 4.5, 20, 9.0, {0.0, 0.0, 0.0}, {-18.0, 20.0, 0.0});
    const auto add = [&](SurfaceShape shape, Material material) -> Surface& {
        Surface& surface = scene.surfaces.emplace_back();
        surface.shape = std::move(shape);
        surface.material = material;
        return surface;
    };
    add(PlaneSurface{{0.0, -0.9, 0.0}, {0.0, 1.0, 0.0}}, {MaterialKind::diffuse, {0.7, 0.5, 0.3}});
    add(BallSurface{{0.9, -0.3, 0.9}, 0.6}, white(MaterialKind::dielectric));
    Material gold = white(MaterialKind::conductor);
    gold.eta = {0.143, 0.375, 1.442};
    gold.k = {3.983, 2.386, 1.603};
    add(BallSurface{{-1.4, -0.5, 0.9}, 0.4}, gold);
    TriangleSurface wall = round_mesh(4, 0.5);
    for (glm::dvec3& vertex : wall.vertices)
        vertex += glm::dvec3(1.3, 0.4, -0.8);
    add(wall, {MaterialKind::mirror, {0.9, 0.8, 0.7}});
    Surface& lamp = add(DiskSurface{{-1.7, 0.9, -0.4}, glm::normalize(glm::dvec3(1.0, -0.6, 0.5)), 0.35}, grey(0.2));
    lamp.emission = {1.5, 1.0, 0.5};
    scene.background = {0.1, 0.15, 0.25};
    scene.lights = {sunlight({0.6, 0.5, 0.4}), PointLight{{0.3, 1.6, 1.4}, {0.8, 0.9, 1.0}},
                    RectangleLight{{0.0, 2.2, 0.0}, {0.5, 0.0, 0.0}, {0.0, 0.0, 0.5}, {1.0, 1.0, 1.2}}};
    scene.settings.spp = 128;
    return scene;
}

// The same with facets, varnish, and a tinted pane.
Scene rough_still_life() {
    Scene scene = still_life();
    scene.surfaces[0].material.kind = MaterialKind::coated;
    scene.surfaces[1].material.roughness = 0.25;
    scene.surfaces[2].material.roughness = 0.5;
    scene.surfaces[3].material = scene.surfaces[2].material;
    scene.surfaces[3].material.roughness = 0.1;
    Surface pane;
    pane.shape = DiskSurface{{0.2, 0.1, 1.6}, glm::normalize(glm::dvec3(0.5, 0.2, 1.0)), 0.6};
    pane.material = {MaterialKind::thin_dielectric, {0.9, 0.8, 0.7}};
    scene.surfaces.push_back(pane);
    return scene;
}

// Facets of a metal that keeps no light.
Material frosted(MaterialKind kind, double roughness) {
    Material material = white(kind);
    material.eta = Rgb(0.0);
    material.k = Rgb(1.0);
    material.roughness = roughness;
    return material;
}

} // namespace

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
            scene.surfaces = {ball(material, {0.5, 0.3, 0.2}, 0.4), ball(material)};
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
    const std::pair<Material, int> usual[] = {{frosted(MaterialKind::conductor, 0.3), MIS_LIGHT},
                                              {frosted(MaterialKind::dielectric, 0.6), MIS_BALANCE},
                                              {white(MaterialKind::coated), MIS_PHASE}};
    for (const auto& [material, usual_mis] : usual)
        for (const int mis : {MIS_BALANCE, MIS_LIGHT, MIS_PHASE}) {
            if (mis != usual_mis && !thorough())
                continue;
            CAPTURE(static_cast<int>(material.kind), mis);
            scene.surfaces = {ball(material)};
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
    const std::pair<glm::dvec3, Material> balls[] = {{{-1.2, -0.3, 0.6}, grey(0.7)},
                                                     {{0.2, -0.3, 0.9}, white(MaterialKind::dielectric)},
                                                     {{1.4, -0.2, 0.2}, rough.surfaces[2].material},
                                                     {{0.4, 0.9, -0.4}, rough.surfaces[1].material}};
    for (const auto& [place, material] : balls) {
        Surface& surface = scene.surfaces.emplace_back(ball(material));
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
    scene.surfaces.emplace_back(ball(grey(0.8))).shape = leaf;
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
        scene.surfaces = {ball(grey(0.8))};
        scene.surfaces.front().shape = mesh;
        scene.lights = {sunlight()};
        scene.background = Rgb(0.2);
        return scene;
    };
    const Film usual = render_here(at_scale(1.0), 1).film;
    for (const double scale : {1e-7, 1e6, 1e10})
        CHECK_AGREEMENT(agree(render_here(at_scale(scale), 2).film, usual, fmt::format("scale {}", scale)));
}

TEST_CASE("what shines is seen where no scattering is left", "[gpu][surfaces]") {
    Scene scene = empty_scene();
    scene.volumes = {medium(Sphere{{0.0, 0.0, 0.0}, 1.2}, 0.5, 0.0)};
    scene.surfaces = {ball(grey(0.5))};
    scene.surfaces.front().emission = Rgb(2.0);
    scene.settings.max_depth = 0;
    scene.settings.choices.scattering = SCATTERING_NONE;
    const Film none = render_here(scene, 1).film;
    CHECK(image_mean(none).value.x > 0.1);
    scene.settings.choices.scattering = SCATTERING_SINGLE;
    CHECK_AGREEMENT(agree(render_here(scene, 2).film, none, "single scattering, of depth 0"));
}

TEST_CASE("looks and flights share a map of the sky on surfaces as in matter", "[gpu][image][surfaces]") {
    Scene scene = empty_scene();
    scene.lights = {write_sky(make_map(8, 4, [](int, int) { return Rgb(1.0); }))};
    scene.surfaces = {ball(white(MaterialKind::diffuse)), ball(white(MaterialKind::dielectric), {1.1, 0.8, 0.9}, 0.5)};
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
    floor.material = grey(albedo);
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
    glowing.material = grey(0.0);
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
    blocker.material = grey(0.0);
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

TEST_CASE("fog darkens a sunlit floor by both ways through it", "[gpu][image][surfaces]") {
    // Absorbing fog of height 1 above a floor: albedo / pi E cos(sun) exp(-tau / cos(sun)) exp(-tau).
    const double tau = 0.7, albedo = 0.5;
    const glm::dvec3 sun = glm::normalize(glm::dvec3(0.5, 1.0, -0.3));
    Scene scene = from_above(0.5);
    Surface floor;
    floor.shape = PlaneSurface{};
    floor.material = grey(albedo);
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
    below.material = grey(0.0);
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
    room.material = grey(0.0);
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

TEST_CASE("surfaces among media equal the reference, by both schedules", "[gpu][image][surfaces]") {
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

TEST_CASE("single scattering says what it misses at surfaces", "[cpu][surfaces]") {
    Scene scene = still_life();
    scene.settings.integrator = "ratioTracking";
    scene.settings.choices.scattering = SCATTERING_SINGLE;
    CHECK_THAT(choose_method(with_preset(scene)).biased, Contains("ends at the first surface"));
    std::erase_if(scene.surfaces,
                  [](const Surface& surface) { return surface.material.kind != MaterialKind::diffuse; });
    REQUIRE_FALSE(scene.surfaces.empty());
    CHECK(choose_method(with_preset(scene)).biased.empty());
}

TEST_CASE("no sun shines through a triangle, a disk or a ball, nor a point through what it touches",
          "[gpu][surfaces]") {
    Scene scene = from_above(0.1, 8);
    scene.settings.spp = 16;
    scene.settings.integrator = "ratioTracking";
    Surface floor;
    floor.shape = PlaneSurface{};
    floor.material = grey(0.5);
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
            hides.material = grey(0.0);
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
    plane.material = grey(0.0);
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
    floor.material = grey(0.5);
    scene.surfaces = {floor};
    scene.settings.max_depth = 1;
    scene.lights = {PointLight{{0.0, 2.0, 0.0}, Rgb(1e9)}, PointLight{{0.0, 1e3, 0.0}, Rgb(1e9)}};
    scene.settings.spp = 1024;
    const double sum = 0.5 / pi * 1e9 * (1.0 / 4.0 + 1e-6);
    const Film film = render_here(scene, 1).film; // straight below but for a fortieth, whose square counts
    for (const glm::vec3& pixel : film.mean)
        CHECK(pixel.x == Approx(sum).epsilon(0.01));
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
    stone.surfaces = {ball(white(MaterialKind::dielectric))};
    stone.surfaces.front().shape = round_mesh(3, 1.0);
    stone.surfaces.front().material.ior = 2.4;
    stone.settings.spp = 1024;
    const Film seen = render_here(stone, 1).film;
    CHECK_AGREEMENT(agree_with_means(seen, std::vector<Rgb>(seen.mean.size(), Rgb(1.0)), "a cut stone"));
    // Between white walls, with a glow of radiance L (1 - r) everywhere: L, and nothing but roulette ends a path.
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
TEST_CASE("looks from along flights do not go through walls", "[gpu][image][surfaces]") {
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

TEST_CASE("surfaces that shine are lamps with bodies", "[gpu][image][surfaces]") {
    // All shapes, from both sides, before and behind each other, as mirrors and glass show them, one itself of rough
    // glass; against the reference, which meets them by chance.
    Scene scene = still_life();
    scene.lights = {sunlight({0.3, 0.25, 0.2})};
    scene.surfaces.pop_back();
    const auto add = [&](SurfaceShape shape, const Rgb& emission, bool both) {
        Surface& surface = scene.surfaces.emplace_back();
        surface.shape = std::move(shape);
        surface.material = grey(0.6);
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

TEST_CASE("lamps in a face of rough glass do not shine through it", "[gpu][image][surfaces]") {
    Scene scene = empty_scene();
    scene.surfaces = {ball(frosted(MaterialKind::dielectric, 0.4), {0.0, 0.0, 0.0}, 1.0)};
    scene.lights = {SphereLight{{0.0, 0.0, 0.0}, 1.0, Rgb(1.0)}};
    scene.settings.spp = 1024;
    CHECK_AGREEMENT(agree(render_here(by(scene, "ratioTracking"), 1).film,
                          render_here(by(scene, "lightTracing"), 2).film, "lamp in a face"));
}

TEST_CASE("surfaces among media are the same for every estimator", "[gpu][image][surfaces]") {
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

TEST_CASE("surfaces are read, moved and refused by name", "[xml][surfaces]") {
    const Scene scene = parse(R"(<surfaces>
  <sphere x="1" radius="2" material="dielectric" ior="1.33"/>
  <plane y="-1" r="0.1" g="0.2" b="0.3"/>
  <rectangle lookAt="0 1 0" width="2" height="4"><emission r="1" g="1" b="1" multiplier="3" sides="2"/></rectangle>
  <box width="2"><transform><scale value="2"/><translate y="5"/></transform></box>
  <disk lookAt="0 0 1" material="conductor" metal="gold"/>
  <sphere material="coated" r=".1" g=".2" b="1"/>
  <sphere material="conductor" roughness=".3"/>
  <plane material="thinDielectric" ior="1.4"/>
</surfaces>)");
    REQUIRE(scene.surfaces.size() == 8);
    CHECK(scene.surfaces[0].material.ior == 1.33);
    CHECK(scene.surfaces[1].material.color == Rgb(0.1, 0.2, 0.3));
    CHECK(scene.surfaces[2].emission == Rgb(3.0));
    CHECK(scene.surfaces[2].shines_both_ways);
    const auto& box = std::get<TriangleSurface>(scene.surfaces[3].shape);
    CHECK(box.vertices.front() == glm::dvec3(-2.0, 4.0, -1.0));
    CHECK(box.vertices.back() == glm::dvec3(2.0, 6.0, 1.0));
    CHECK(scene.surfaces[4].material.k.x == 3.983);
    CHECK(scene.surfaces[5].material.kind == MaterialKind::coated);
    CHECK(scene.surfaces[6].material.roughness == 0.3);
    CHECK(scene.surfaces[7].material.kind == MaterialKind::thin_dielectric);
    CHECK(scene.surfaces[7].material.ior == 1.4);

    const std::string glass = "<surfaces><box material=\"dielectric\"/></surfaces>";
    const auto shadowed = [](const std::string& text, const char* integrator) {
        Scene scene = parse(text);
        scene.settings.integrator = integrator;
        const std::vector<std::string> warnings = choose_method(with_preset(scene)).warnings;
        return std::any_of(warnings.begin(), warnings.end(), [](const std::string& warning) {
            return warning.find("no path from") != std::string::npos;
        });
    };
    CHECK(shadowed(glass + "<lights><point/><sphere/></lights>", "ratioTracking"));
    CHECK_FALSE(shadowed(glass + "<lights><point/><sphere/></lights>", "bidirectional"));
    CHECK_FALSE(shadowed(glass + "<lights><sun y=\"1\"/><sphere/></lights>", "ratioTracking"));
    const std::string frosted_glass = "<surfaces><box material=\"dielectric\" roughness=\".1\"/></surfaces>";
    CHECK_FALSE(shadowed(frosted_glass + "<lights><point/></lights>", "ratioTracking"));

    const auto refused = [](const std::string& surface) { return error_of("<surfaces>" + surface + "</surfaces>"); };
    CHECK_THAT(refused("<sphere material=\"gold\"/>"), Contains("2:19") && Contains("'gold' is unknown"));
    CHECK_THAT(refused("<sphere ior=\"2\"/>"),
               Contains("has a meaning with material=\"dielectric\", \"coated\" or \"thinDielectric\" only"));
    CHECK_THAT(refused("<sphere roughness=\".2\"/>"), Contains("\"conductor\" or \"dielectric\" only"));
    CHECK_THAT(refused("<sphere material=\"conductor\" roughness=\"1e-4\"/>"), Contains("0.001 at least"));
    CHECK_THAT(refused("<sphere material=\"dielectric\" ior=\"1\" roughness=\".1\"/>"), Contains("shows nothing"));
    CHECK_THAT(refused("<sphere material=\"coated\" ior=\".9\"/>"), Contains("denser than what is around"));
    CHECK_THAT(refused("<sphere r=\"2\"/>"), Contains("more than it gets"));
    CHECK_THAT(refused("<sphere><transform><scale x=\"2\"/></transform></sphere>"), Contains("use a mesh"));
    CHECK_THAT(refused("<mesh/>"), Contains("names no file"));
    CHECK_THAT(refused("<disk material=\"conductor\" metal=\"tin\"/>"), Contains("lookAt"));
    CHECK_THAT(refused("<plane material=\"conductor\" metal=\"tin\"/>"), Contains("'tin' is unknown"));
    CHECK_THAT(refused("<cone/>"), Contains("cone"));
}

TEST_CASE("what a surface is and is made of is in the scene hash", "[method][surfaces]") {
    const Scene scene = still_life();
    const std::string hash = scene_hash(scene);
    const auto differs = [&](const auto& change) {
        Scene other = scene;
        change(other.surfaces);
        return scene_hash(other) != hash;
    };
    CHECK(scene_hash(still_life()) == hash);
    CHECK(differs([](auto& s) { std::get<PlaneSurface>(s[0].shape).point.y = -1.0; }));
    CHECK(differs([](auto& s) { std::get<BallSurface>(s[1].shape).radius = 0.61; }));
    CHECK(differs([](auto& s) { s[1].material.ior = 1.4; }));
    CHECK(differs([](auto& s) { s[2].material.k.x = 4.0; }));
    CHECK(differs([](auto& s) { s[2].material.roughness = 0.1; }));
    CHECK(differs([](auto& s) { std::get<TriangleSurface>(s[3].shape).vertices[0].x += 0.1; }));
    CHECK(differs([](auto& s) { s[4].emission.x = 1.6; }));
    CHECK(differs([](auto& s) { s[4].shines_both_ways = true; }));
    CHECK(differs([](auto& s) { s[0].material.kind = MaterialKind::mirror; }));
    CHECK(differs([](auto& s) { s.pop_back(); }));
}
