// Surfaces of any shape that shine: flights meet them, and looks find them.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>

#include "camera_view.h"
#include "shared/constants.h"
#include "shared/estimators.h"
#include "support/agreement.h"
#include "support/images.h"
#include "support/surface_scenes.h"
#include "support/thorough.h"

using namespace vkvol;

namespace {

// In n x n squares.
TriangleSurface mesh_of(const RectangleSurface& r, unsigned n) {
    TriangleSurface mesh;
    for (unsigned v = 0; v <= n; ++v)
        for (unsigned u = 0; u <= n; ++u)
            mesh.vertices.push_back(r.center + (2.0 * u / n - 1.0) * r.edge_u + (2.0 * v / n - 1.0) * r.edge_v);
    for (unsigned v = 0; v < n; ++v)
        for (unsigned u = 0; u < n; ++u) {
            const unsigned a = v * (n + 1) + u, b = a + 1, c = b + n + 1, d = a + n + 1;
            mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {a, c, d}});
        }
    return mesh;
}

Surface shining(SurfaceShape shape, const Rgb& emission, double albedo = 0.0, bool both = false) {
    Surface surface;
    surface.shape = std::move(shape);
    surface.material = matte(albedo);
    surface.emission = emission;
    surface.shines_both_ways = both;
    return surface;
}

// Seen from above, in a room without walls: on its floor what is matt, and what has facets.
Scene under(std::vector<Surface> lights, double sigma_t) {
    Scene scene = empty_scene(8);
    scene.surfaces = std::move(lights);
    scene.surfaces.push_back(surface_of(floor_piece, MaterialKind::diffuse));
    scene.surfaces.push_back(surface_of(left_ball, MaterialKind::conductor, 0.2));
    scene.surfaces.push_back(surface_of(right_ball, MaterialKind::coated));
    if (sigma_t > 0.0)
        scene.volumes = {box_of_fog(sigma_t, 0.8)};
    scene.settings.spp = 512;
    return scene;
}

// Of the pixels that do not see what shines, in whose mean it is.
double variance_beside(const Film& film, const Film& picture) {
    double sum = 0.0;
    for (std::size_t i = 0; i < film.variance.size(); ++i)
        if (picture.mean[i].x < 0.3f)
            sum += double(film.variance[i].x) + film.variance[i].y + film.variance[i].z;
    return sum;
}

const RectangleSurface pane{{-0.2, 0.9, 0.1}, {0.5, 0.1, 0.0}, {0.0, 0.0, 0.4}}; // facing down

} // namespace

TEST_CASE("a mesh shines as the lamp of its shape does, however looks and flights share it",
          "[gpu][image][surfaces][shining]") {
    const double sigma_t = GENERATE(0.0, 0.6);
    const Film lamp = render_here(under({shining(pane, {4.0, 3.0, 2.0})}, sigma_t), 1).film;
    Scene mesh = under({shining(mesh_of(pane, 3), {4.0, 3.0, 2.0})}, sigma_t);
    for (const int mis : {MIS_BALANCE, MIS_POWER, MIS_LIGHT, MIS_PHASE}) {
        if (sigma_t == 0.0 && mis != MIS_BALANCE && !thorough())
            continue;
        mesh.settings.choices.mis = mis;
        const Film film = render_here(mesh, 2).film;
        if (mis != MIS_PHASE) // by which most pixels meet it once in thousands of samples
            CHECK_AGREEMENT(agree(film, lamp, fmt::format("extinction {}, mis {}", sigma_t, mis)));
        check_same_mean(film, lamp, fmt::format("extinction {}, mis {}", sigma_t, mis));
    }
    mesh.settings.choices.mis.reset();
    mesh.settings.choices.nee = NEE_NONE;
    check_same_mean(render_here(mesh, 3).film, lamp, "met by chance");
}

TEST_CASE("a mesh that shines on both sides is the same turned about", "[gpu][image][surfaces][shining]") {
    TriangleSurface mesh = mesh_of(pane, 2);
    const Film film = render_here(under({shining(mesh, {4.0, 3.0, 2.0}, 0.0, true)}, 0.4), 1).film;
    mesh.turn_about();
    const Film turned = render_here(under({shining(mesh, {4.0, 3.0, 2.0}, 0.0, true)}, 0.4), 2).film;
    CHECK_AGREEMENT(agree(turned, film, "turned about"));
    check_same_mean(turned, film, "turned about");
}

TEST_CASE("a small mesh that shines in fog is found by looks", "[gpu][image][surfaces][shining][long]") {
    const RectangleSurface small{{0.0, 0.9, 0.0}, {0.12, 0.0, 0.0}, {0.0, 0.0, 0.12}};
    Scene scene = under({shining(mesh_of(small, 2), Rgb(30.0))}, 0.6);
    const Film looked = render_here(scene, 1).film;
    scene.settings.choices.mis = MIS_PHASE;
    const Film met = render_here(scene, 2).film;
    // By chance a path finds it once in hundreds; a look brings what it does each time, but near it.
    CHECK(variance_beside(looked, looked) < 0.25 * variance_beside(met, looked));
}

TEST_CASE("meshes that shine are not lit through themselves", "[gpu][image][surfaces][shining]") {
    // A roof of two leaves, and a box about a ball: what shines within, and both ways, is hidden by what else shines.
    TriangleSurface roof = mesh_of({{-0.4, 0.6, 0.0}, {0.4, 0.4, 0.0}, {0.0, 0.0, 0.6}}, 1);
    const TriangleSurface other = mesh_of({{0.4, 0.6, 0.0}, {0.4, -0.4, 0.0}, {0.0, 0.0, 0.6}}, 1);
    for (const glm::uvec3& t : other.triangles)
        roof.triangles.push_back(t + glm::uvec3(static_cast<unsigned>(roof.vertices.size())));
    roof.vertices.insert(roof.vertices.end(), other.vertices.begin(), other.vertices.end());
    Scene scene = under({shining(roof, {1.0, 0.7, 0.4}, 0.7, GENERATE(false, true))}, 0.4);
    const Film looked = render_here(scene, 1).film;
    scene.settings.choices.nee = NEE_NONE;
    check_same_mean(looked, render_here(scene, 2).film, "roof");
}

TEST_CASE("any number of balls, disks and rectangles that shine are found by looks",
          "[gpu][image][surfaces][shining][long]") {
    std::vector<Surface> many;
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 at(0.08 * (i % 20) - 0.8, 0.6 + 0.07 * (i % 4), 0.1 * (i / 20) - 0.7);
        const double r = 0.02;
        if (i % 3 == 0)
            many.push_back(shining(BallSurface{at, r}, {20.0, 14.0, 8.0}));
        else if (i % 3 == 1)
            many.push_back(shining(DiskSurface{at, {0.0, -1.0, 0.0}, r}, {20.0, 14.0, 8.0}, 0.0, i % 2 == 1));
        else
            many.push_back(shining(RectangleSurface{at, {r, 0.0, 0.0}, {0.0, 0.0, r}}, {20.0, 14.0, 8.0}));
    }
    Scene scene = under(many, 0.4);
    const Film looked = render_here(scene, 1).film;
    scene.settings.choices.nee = NEE_NONE;
    const Film met = render_here(scene, 2).film;
    check_same_mean(looked, met, "300 surfaces");
    CHECK(variance_beside(looked, looked) < 0.5 * variance_beside(met, looked));
}

TEST_CASE("shining meshes light as the reference says, with both schedules", "[gpu][image][surfaces][shining][long]") {
    Scene scene = under(
        {shining(mesh_of(pane, 2), {4.0, 3.0, 2.0}, 0.3, true), shining(round_mesh(6, 0.25), {0.6, 1.2, 2.4}, 0.5)},
        0.5);
    scene.lights = {sunlight({0.3, 0.25, 0.2}), PointLight{{0.0, 2.0, 2.0}, Rgb(0.6)}};
    check_by_both_schedules(scene, "shining meshes");
}

TEST_CASE("every way to look finds the light of shining meshes", "[gpu][image][surfaces][shining][long]") {
    Scene scene =
        under({shining(mesh_of(pane, 2), {4.0, 3.0, 2.0}, 0.3), shining(round_mesh(5, 0.2), {0.6, 1.2, 2.4})}, 0.5);
    scene.volumes.front().noise = Noise{1.3, 2, 0.5, 2.0};
    const Film usual = render_here(scene, 1).film;
    scene.settings.choices.nee = NEE_TENTATIVE;
    check_same_mean(render_here(scene, 2).film, usual, "at null collisions");
    scene.settings.choices.nee.reset();
    scene.settings.choices.distance = DISTANCE_MIXED;
    check_same_mean(render_here(scene, 3).film, usual, "from along flights");
    scene.settings.choices = {};
    scene.settings.integrator = "decompositionTracking";
    check_same_mean(render_here(scene, 4).film, usual, "decomposition");
}

TEST_CASE("particles and paths find the light of shining meshes alike", "[gpu][image][surfaces][shining][long]") {
    Scene scene = before_smoke({shining(mesh_of(pane, 2), {4.0, 3.0, 2.0}, 0.4)}, {});
    scene.lights = {PointLight{{0.5, 0.8, 1.2}, Rgb(0.7)}};
    scene.settings.spp = 2048;
    const Film paths = render_here(scene, 1).film;
    for (const char* integrator : {"lightTracing", "bidirectional"}) {
        scene.settings.integrator = integrator;
        check_same_mean(render_here(scene, 2).film, paths, integrator);
    }
}

TEST_CASE("a sensor of flux reads a mesh as the lamp of its shape", "[gpu][image][flux][surfaces][shining]") {
    Scene scene;
    scene.camera.projection = Projection::irradiance;
    scene.camera.position = {0.0, -0.6, 0.0};
    look_along(scene.camera, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0});
    scene.camera.size = {0.5, 0.5};
    scene.picture = {2, 2, 0.0, 0.0, 2.0, 2.0};
    scene.settings.spp = 1 << 14;
    scene.volumes = {box_of_fog(0.4, 0.8)};
    for (const int scattering : {SCATTERING_MULTIPLE, SCATTERING_SINGLE, SCATTERING_NONE}) {
        scene.settings.choices.scattering = scattering;
        scene.surfaces = {shining(pane, {4.0, 3.0, 2.0})};
        const Film lamp = render_here(scene, 1).film;
        CHECK(lamp.mean.front().x > 0.1f);
        scene.surfaces = {shining(mesh_of(pane, 2), {4.0, 3.0, 2.0})};
        CHECK_AGREEMENT(agree(render_here(scene, 2).film, lamp, fmt::format("scattering {}", scattering)));
    }
}

TEST_CASE("a mesh of no triangle that has area shines on nothing", "[gpu][surfaces][shining][long]") {
    const TriangleSurface line{{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {2.0, 0.0, 0.0}}, {{0, 1, 2}}};
    const TriangleSurface dot{{{0.0, 0.0, 0.0}, {1e-18, 0.0, 0.0}, {0.0, 1e-18, 0.0}}, {{0, 1, 2}}};
    for (const TriangleSurface& mesh : {line, dot}) {
        const Film film = render_here(under({shining(mesh, Rgb(1.0), 0.0, true)}, 0.5), 1).film;
        CHECK(image_mean(film).value.x == 0.0);
        CHECK(*std::min_element(film.samples.begin(), film.samples.end()) == 512);
    }
}
