#include "surface_scenes.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "support/agreement.h"
#include "support/images.h"

using std::numbers::pi;

namespace vkvol {

Surface ball_surface(const Material& material, glm::dvec3 center, double radius) {
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

Material matte(double albedo) {
    return {MaterialKind::diffuse, Rgb(albedo)};
}

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

Scene empty_scene(int pixels, double width) {
    Scene scene = scene_of(medium(Sphere{{0.0, 0.0, 0.0}, 1.0}, 0.0, 0.0), width, pixels, 8.0, glm::dvec3(0.0),
                           {14.0, 23.0, 5.0});
    scene.volumes.clear();
    scene.settings.spp = 64;
    return scene;
}

Scene from_above(double width, int pixels) {
    Scene scene = empty_scene(pixels);
    scene.camera = {};
    scene.camera.projection = Projection::orthographic;
    scene.camera.view_height = width;
    scene.camera.position = {0.0, 5.0, 0.0};
    scene.camera.pitch = -90.0;
    return scene;
}

Surface surface_of(SurfaceShape shape, MaterialKind kind, double roughness) {
    Surface surface;
    surface.shape = std::move(shape);
    surface.material.kind = kind;
    surface.material.color = {0.8, 0.7, 0.6};
    surface.material.roughness = roughness;
    if (kind == MaterialKind::conductor) {
        surface.material.eta = {0.143, 0.375, 1.442};
        surface.material.k = {3.983, 2.386, 1.603};
    }
    return surface;
}

Scene small_picture(const Volume& volume, double width, std::vector<Light> lights) {
    Scene scene = scene_of(volume, width, 8, 12.0, glm::dvec3(0.0), {10.0, 25.0, -5.0});
    scene.lights = std::move(lights);
    scene.background = {0.1, 0.15, 0.2};
    scene.settings.spp = 4096;
    return scene;
}

Scene before_smoke(std::vector<Surface> surfaces, std::vector<Light> lights) {
    Scene scene = small_picture(smoke(), 5.0, std::move(lights));
    scene.surfaces = std::move(surfaces);
    scene.surfaces.push_back(surface_of(floor_piece, MaterialKind::diffuse));
    return scene;
}

void check_everywhere(const Scene& scene, const Rgb& expected, double relative) {
    const Film film = render_here(scene, 1).film;
    for (const glm::vec3& mean : film.mean)
        for (int i = 0; i < 3; ++i)
            CHECK(mean[i] == Approx(expected[i]).epsilon(relative).margin(1e-7));
}

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
    Surface& lamp = add(DiskSurface{{-1.7, 0.9, -0.4}, glm::normalize(glm::dvec3(1.0, -0.6, 0.5)), 0.35}, matte(0.2));
    lamp.emission = {1.5, 1.0, 0.5};
    scene.background = {0.1, 0.15, 0.25};
    scene.lights = {sunlight({0.6, 0.5, 0.4}), PointLight{{0.3, 1.6, 1.4}, {0.8, 0.9, 1.0}},
                    RectangleLight{{0.0, 2.2, 0.0}, {0.5, 0.0, 0.0}, {0.0, 0.0, 0.5}, {1.0, 1.0, 1.2}}};
    scene.settings.spp = 128;
    return scene;
}

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

Material frosted(MaterialKind kind, double roughness) {
    Material material = white(kind);
    material.eta = Rgb(0.0);
    material.k = Rgb(1.0);
    material.roughness = roughness;
    return material;
}

} // namespace vkvol
