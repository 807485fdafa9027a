// Surfaces as devices search them by units of their own: the same hits as by the program's tree, so the same bits.
// Where no device offers ray queries there is nothing to see.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <memory>

#include "piece_boxes.h"
#include "support/images.h"
#include "support/surface_scenes.h"
#include "support/test_device.h"

using namespace vkvol;

namespace {

// Of the tests' kind, with ray queries; null if it offers none.
std::unique_ptr<Device> querying_device() {
    if (!test_device().info().ray_queries)
        return nullptr;
    const char* choice = std::getenv("VKVOL_TEST_DEVICE");
    return std::make_unique<Device>(DeviceOptions{choice ? choice : "auto", true, true, true});
}

RenderResult render_by(const Device& device, const Scene& scene, Hits hits, Schedule schedule) {
    RenderJob job;
    job.crop = {0, scene.picture.width, 0, scene.picture.height};
    job.disk_cache = false;
    job.plan.hits = hits;
    job.plan.schedule = schedule;
    return render(device, scene, job);
}

// Squares of many colours in one plane, over one another, seen from above: which of them is met is a matter of their
// order. Below them what a mesh of many faces hides of a floor without end, and a lamp in the plane of a wall, which
// does not hide it.
Scene ties() {
    Scene scene = from_above(2.0, 16);
    scene.settings.spp = 8;
    scene.surfaces = {surface_of(PlaneSurface{{0.0, -2.0, 0.0}, {0.0, 1.0, 0.0}}, MaterialKind::diffuse)};
    for (int i = 0; i < 12; ++i) {
        Material material = matte(0.5);
        material.color = {0.05 * (i + 1), 0.9 - 0.07 * i, 0.1 + 0.06 * ((5 * i) % 12)};
        scene.surfaces.push_back(ball_surface(material));
        const double turn = 2.4 * i, away = 0.05 * i;
        scene.surfaces.back().shape = RectangleSurface{{away * std::cos(turn), 0.3, away * std::sin(turn)},
                                                       {0.3 + 0.02 * ((7 * i) % 12), 0.0, 0.0},
                                                       {0.0, 0.0, -0.3 - 0.02 * i}};
    }
    scene.surfaces.push_back(ball_surface(matte(0.7)));
    scene.surfaces.back().shape = round_mesh(24, 0.8);
    scene.surfaces.push_back(ball_surface(matte(0.6)));
    scene.surfaces.back().shape = RectangleSurface{{1.4, -0.5, 0.0}, {0.0, 0.0, 1.5}, {0.0, 1.5, 0.0}};
    scene.lights = {PointLight{{1.4, 0.4, 0.2}, Rgb(3.0)}};
    scene.background = {0.3, 0.4, 0.5};
    return scene;
}

Scene by_particles() {
    Scene scene = before_smoke({ball_surface(white(MaterialKind::dielectric), left_ball.center, left_ball.radius)},
                               {PointLight{{0.5, 2.0, 1.5}, Rgb(8.0)}});
    scene.settings.integrator = "lightTracing";
    return scene;
}

// Of whose rays most come from a thousand times as far as the mesh is wide.
Scene in_wide_fog() {
    Scene scene = empty_scene(16);
    scene.settings.spp = 64;
    scene.volumes = {box_of_fog(0.002, 1.0)};
    std::get<Box>(scene.volumes[0].shape).size = glm::dvec3(2000.0);
    scene.surfaces = {ball_surface(matte(0.7))};
    scene.surfaces.back().shape = round_mesh(24, 1.0);
    scene.background = {0.3, 0.4, 0.5};
    scene.lights = {RectangleLight{{3.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}, Rgb(5.0)}};
    return scene;
}

Scene without_end() {
    Scene scene = still_life();
    scene.lights.clear(); // those that have places
    scene.periodic = Periodic{{-4.0, 0.0, -4.0}, {4.0, 0.0, 4.0}};
    return scene;
}

} // namespace

TEST_CASE("devices that search for surfaces by themselves find the same ones", "[gpu][image][surfaces][rayquery]") {
    const std::unique_ptr<Device> device = querying_device();
    if (!device) {
        WARN("no ray queries on " << test_device().info().name << ": not tested");
        return;
    }
    const std::pair<const char*, Scene> scenes[] = {
        {"still life", still_life()},     {"rough still life", rough_still_life()}, {"ties", ties()},
        {"by particles", by_particles()}, {"in wide fog", in_wide_fog()},           {"without end", without_end()}};
    for (const auto& [name, scene] : scenes)
        for (const Schedule schedule : {Schedule::fused, Schedule::staged}) {
            CAPTURE(name, name_of(schedule));
            const RenderResult tree = render_by(*device, scene, Hits::tree, schedule);
            const RenderResult query = render_by(*device, scene, Hits::query, schedule);
            CHECK(query.plan.hits == Hits::query);
            CHECK(query.counts.step_caps == 0);
            CHECK(query.counts.shadow_rays == tree.counts.shadow_rays);
            CHECK(same_bits(query.film, tree.film));
        }
    CHECK(device->validation_messages() == std::vector<std::string>{});
}

TEST_CASE("ray queries that a device does not offer, or that would search for nothing", "[gpu][surfaces][rayquery]") {
    Scene scene = still_life();
    CHECK_THROWS_WITH(render_by(test_device(), scene, Hits::query, Schedule::fused),
                      Catch::Contains("offers no ray queries") && Catch::Contains("leave hits=query out"));
    const std::unique_ptr<Device> device = querying_device();
    if (!device)
        return;
    scene.surfaces = {surface_of(PlaneSurface{{0.0, -2.0, 0.0}, {0.0, 1.0, 0.0}}, MaterialKind::diffuse)};
    const RenderResult asked = render_by(*device, scene, Hits::query, Schedule::fused);
    CHECK(asked.plan.hits == Hits::tree);
    CHECK(same_bits(asked.film, render_by(*device, scene, Hits::tree, Schedule::fused).film));
    scene.surfaces.clear();
    CHECK(render_by(*device, scene, Hits::query, Schedule::fused).plan.hits == Hits::tree);
}

// Half of SURFACE_SPARE, 2^-19, of what is furthest away is what a box has room for on each side, and as much again.
TEST_CASE("boxes of pieces have room for what hits err by", "[surfaces][rayquery]") {
    Scene scene = ties();
    scene.surfaces.push_back(ball_surface(matte(0.5), {5.0, 6.0, -7.0}, 2.0));
    const SurfaceTable table = make_surface_table(scene.surfaces, glm::dvec3(0.0));
    const std::vector<VkAabbPositionsKHR> boxes = piece_boxes(table, 100.0f);
    REQUIRE(table.planes == 1);
    REQUIRE(boxes.size() == table.met - table.planes);
    const float least = (9.0f + 100.0f) / float(1 << 18) * 0.999f;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const BvhBox exact = box_of(table.primitives[table.planes + i]);
        const VkAabbPositionsKHR& box = boxes[i];
        const glm::vec3 below = exact.low - glm::vec3(box.minX, box.minY, box.minZ);
        const glm::vec3 above = glm::vec3(box.maxX, box.maxY, box.maxZ) - exact.high;
        const float rounding = 9.0f / float(1 << 23);
        CHECK(std::min({below.x, below.y, below.z, above.x, above.y, above.z}) > least - rounding);
        CHECK(std::max({below.x, below.y, below.z, above.x, above.y, above.z}) < 1.01f * least + rounding);
    }
}
