// Models beside other volumes: that they are there, exactly, and that what they are beside does not change them.
#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "mesh.h"
#include "method.h"
#include "shared/constants.h"
#include "support/agreement.h"
#include "support/images.h"
#include "support/scenes.h"
#include "support/surface_scenes.h"

using namespace vkvol;

namespace {

Mesh box_mesh(const glm::dvec3& low, const glm::dvec3& high) {
    Mesh mesh;
    for (int i = 0; i < 8; ++i)
        mesh.vertices.push_back({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
    for (const glm::uvec4 f : {glm::uvec4(0, 4, 6, 2), glm::uvec4(1, 3, 7, 5), glm::uvec4(0, 1, 5, 4),
                               glm::uvec4(2, 6, 7, 3), glm::uvec4(0, 2, 3, 1), glm::uvec4(4, 5, 7, 6)}) {
        mesh.triangles.push_back({f.x, f.y, f.z});
        mesh.triangles.push_back({f.x, f.z, f.w});
    }
    return mesh;
}

// A ring about the y axis, as wide as it is thick at its thickest.
Mesh ring() {
    constexpr int around = 24, across = 12;
    Mesh mesh;
    for (int i = 0; i < around; ++i)
        for (int k = 0; k < across; ++k) {
            const double phi = 2.0 * glm::pi<double>() * i / around, theta = 2.0 * glm::pi<double>() * k / across;
            const double out = 1.2 + 0.5 * std::cos(theta);
            mesh.vertices.push_back({out * std::cos(phi), 0.5 * std::sin(theta), out * std::sin(phi)});
            const auto at = [&](int a, int b) {
                return static_cast<std::uint32_t>((i + a) % around * across + (k + b) % across);
            };
            mesh.triangles.push_back({at(0, 0), at(0, 1), at(1, 1)});
            mesh.triangles.push_back({at(0, 0), at(1, 1), at(1, 0)});
        }
    return mesh;
}

Scene lit(const Volume& volume) {
    Scene scene = scene_of(volume, 5.0, 16, 12.0, glm::dvec3(0.0), {10.0, 25.0, -5.0});
    scene.background = {0.1, 0.2, 0.4};
    scene.lights = {sunlight({1.0, 0.9, 0.8})};
    scene.settings.spp = 128;
    return scene;
}

// Beside what is there, and next to nothing.
Scene among_others(Scene scene) {
    scene.volumes.push_back(medium(Sphere{{0.0, 0.0, 0.0}, 3.0}, 1e-9, 0.5));
    return scene;
}

} // namespace

TEST_CASE("a model among other media is the model alone", "[gpu][image][several][mesh]") {
    Scene scene = lit(medium(write_mesh(ring()), 2.0, 0.0)); // whose shadows are closed forms, alone
    CHECK_AGREEMENT(agree(render_here(among_others(scene), 1).film, render_here(scene, 2).film, "a ring that absorbs"));
    scene = lit(medium(write_mesh(ring()), 2.0, 0.9, 0.4));
    CHECK_AGREEMENT(agree(render_here(among_others(scene), 1).film, render_here(scene, 2).film, "a ring"));
    scene.volumes.front().noise = Noise{1.3, 3, 1.0, 2.0}; // which is denser than 1 in places
    const RenderResult noise = render_here(among_others(scene), 1);
    CHECK(noise.counts.majorant_violations == 0);
    CHECK_AGREEMENT(agree(noise.film, render_here(scene, 2).film, "a ring of noise"));
    scene.volumes.front().noise.reset();
    scene.volumes.front().transform =
        glm::rotate(glm::translate(glm::dmat4(1.0), glm::dvec3(0.3, -0.4, 0.2)), 0.7, glm::dvec3(1.0, 0.0, 0.0)) *
        glm::scale(glm::dmat4(1.0), glm::dvec3(0.9, -1.3, 0.8));
    CHECK_AGREEMENT(agree(render_here(among_others(scene), 1).film, render_here(scene, 2).film, "a ring, mirrored"));
}

TEST_CASE("a model of a box among other media is that box", "[gpu][image][several][mesh]") {
    const glm::dvec3 low(-1.0, -0.8, -0.6), high(0.9, 0.7, 1.1);
    const Volume ball = medium(Sphere{{0.6, 0.2, 0.1}, 1.1}, 1.5, 0.9, -0.3);
    Scene box = lit(medium(Box{0.5 * (low + high), high - low}, 1.2, 0.8, 0.5));
    box.volumes.push_back(ball);
    Scene model = box;
    model.volumes.front().shape = write_mesh(box_mesh(low, high));
    CHECK_AGREEMENT(agree(render_here(model, 1).film, render_here(box, 2).film, "beside a ball"));
    for (Scene* scene : {&box, &model}) // seen from within both
        scene->camera.position = {0.3, 0.1, 0.2};
    CHECK_AGREEMENT(agree(render_here(model, 1).film, render_here(box, 2).film, "from within"));
}

TEST_CASE("plates much thinner than the cubes of their mesh are those plates", "[gpu][image][several][mesh]") {
    // Both in one layer of cubes, whose points lie between them, in the middle.
    const glm::dvec3 low(-1.5, -0.09, -1.4), high(1.4, -0.06, 1.5), upper_low(-1.5, 0.03, -1.4),
        upper_high(1.4, 0.09, 1.5);
    const Volume plate = medium(Box{0.5 * (low + high), high - low}, 12.0, 0.5);
    Scene boxes = lit(plate);
    boxes.volumes.push_back(plate);
    boxes.volumes.back().shape = Box{0.5 * (upper_low + upper_high), upper_high - upper_low};
    Mesh both = box_mesh(low, high);
    const Mesh upper = box_mesh(upper_low, upper_high);
    for (const glm::uvec3& triangle : upper.triangles)
        both.triangles.push_back(triangle + static_cast<std::uint32_t>(both.vertices.size()));
    both.vertices.insert(both.vertices.end(), upper.vertices.begin(), upper.vertices.end());
    Scene model = lit(plate);
    model.volumes.front().shape = write_mesh(both);
    CHECK_AGREEMENT(agree(render_here(among_others(model), 1).film, render_here(boxes, 2).film, "plates"));
}

TEST_CASE("a small model beside grids is that box", "[gpu][image][several][mesh]") {
    const glm::dvec3 low(-0.08, -0.05, -0.06), high(0.07, 0.09, 0.04);
    Volume cloud = medium(write_grids({cloud_grid()}), 2.0, 0.9, 0.2);
    cloud.transform = glm::scale(glm::dmat4(1.0), glm::dvec3(0.03));
    Scene box = lit(cloud);
    box.volumes.push_back(medium(Box{0.5 * (low + high), high - low}, 20.0, 0.8, 0.5));
    box.volumes.push_back(medium(write_grid({{-3, -4, -5}, {6, 7, 8}, [](glm::ivec3) { return 3.0f; }}), 1.0, 0.7));
    box.volumes.back().transform = glm::scale(glm::dmat4(1.0), glm::dvec3(0.01));
    box.camera.position = 0.05 * box.camera.position;
    Scene model = box;
    model.volumes[1].shape = write_mesh(box_mesh(low, high));
    CHECK_AGREEMENT(agree(render_here(model, 1).film, render_here(box, 2).film, "among grids"));
}

TEST_CASE("looks from along flights find a lamp in a model among other media", "[gpu][image][several][mesh]") {
    const glm::dvec3 low(-1.0, -0.8, -0.6), high(0.9, 0.7, 1.1);
    Scene box = among_others(lit(medium(Box{0.5 * (low + high), high - low}, 1.0, 0.9, 0.2)));
    box.background = Rgb(0.0);
    box.lights = {SphereLight{{0.0, 0.3, 0.4}, 0.15, {90.0, 70.0, 50.0}}};
    box.settings.integrator = "ratioTracking";
    box.settings.choices.distance = DISTANCE_MIXED;
    Scene model = box;
    model.volumes.front().shape = write_mesh(box_mesh(low, high));
    const Method method = choose_method(model);
    CHECK(method.warnings.empty());
    CHECK(method.distance == DISTANCE_MIXED);
    CHECK_AGREEMENT(agree(render_here(model, 1).film, render_here(box, 2).film, "a lamp in a box"));
}

TEST_CASE("models in one another equal the reference's race, by both schedules", "[gpu][image][several][mesh]") {
    Scene scene = lit(medium(write_mesh(ring()), 2.0, 0.9, 0.4));
    scene.volumes.push_back(medium(write_mesh(box_mesh({-0.5, -1.5, -0.4}, {1.5, 1.2, 0.9})), 0.8, 0.7, -0.2));
    scene.volumes.back().transform = glm::rotate(glm::dmat4(1.0), 0.5, glm::normalize(glm::dvec3(1.0, 2.0, -1.0)));
    scene.volumes.push_back(medium(Sphere{{-0.8, 0.4, 0.3}, 1.0}, 1.0, 0.95, 0.6));
    scene.volumes.back().noise = Noise{1.1, 2, 0.5, 2.0};
    scene.volumes[0].sigma_s = {0.6, 1.5, 1.9};
    scene.volumes[0].sigma_a = Rgb(2.0) - scene.volumes[0].sigma_s;
    check_by_both_schedules(scene, "models in one another");
}

TEST_CASE("a model whose faces meet in one point is there, however long a lane works", "[gpu][image][several][mesh]") {
    constexpr int faces = 480;
    Mesh cone; // so slender that each of its cubes has nearly all of its faces
    cone.vertices = {{0.0, -2.0, 0.0}, {0.0, 2.0, 0.0}};
    for (int i = 0; i < faces; ++i) {
        const double phi = 2.0 * glm::pi<double>() * i / faces;
        cone.vertices.push_back({0.15 * std::cos(phi), -2.0, -0.15 * std::sin(phi)});
        const auto a = static_cast<std::uint32_t>(2 + i), b = static_cast<std::uint32_t>(2 + (i + 1) % faces);
        cone.triangles.push_back({1, a, b});
        cone.triangles.push_back({0, b, a});
    }
    Scene scene = lit(medium(write_mesh(cone), 40.0, 0.9, 0.4));
    CHECK_AGREEMENT(agree(render_here(among_others(scene), 1).film, render_here(scene, 2).film, "a cone"));
}
