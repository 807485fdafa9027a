// Where rays are inside of closed meshes, against closed forms and brute force.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "bvh.h"
#include "kernels/test_items.h"
#include "mesh.spv.h"
#include "support/kernel_runner.h"
#include "support/mesh_chords.h"
#include "support/numbers.h"
#include "support/test_meshes.h"

using namespace vkvol;
using shared::MeshInput;
using shared::MeshOutput;
using test_numbers::u;

namespace {

Line to_line(const MeshInput& ray) {
    return {glm::dvec3(ray.origin), glm::dvec3(ray.direction)};
}

std::vector<MeshOutput> run_mesh(const Bvh& bvh, const std::vector<MeshInput>& inputs) {
    LoadedMedium volume;
    volume.bvh = bvh;
    KernelScene scene;
    scene.volume = &volume;
    scene.frame.media[0].bvh_nodes = static_cast<std::uint32_t>(bvh.nodes.size());
    return KernelRunner(mesh_spv, {}, scene).run<MeshOutput>(inputs);
}

// What the kernel sees is the surface with vertices displaced by at most 10 u R per axis across the ray, R the distance
// of the farthest vertex along an axis, and its distances along the ray by 10 u R sqrt(3): see mesh.glsl. So a chord is
// between those of bodies shrunk and grown by as much, but for the distances' own errors at the ends of the pieces.
void check_chords(const Mesh& mesh, const std::vector<Convex>& bodies, const std::vector<MeshInput>& inputs,
                  bool one_piece) {
    const Bvh bvh = build_bvh(mesh, glm::dvec3(0.0));
    const auto outputs = run_mesh(bvh, inputs);
    const double extent =
        glm::length(glm::max(glm::abs(glm::dvec3(bvh.nodes[0].low)), glm::abs(glm::dvec3(bvh.nodes[0].high))));
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const double reach = glm::length(glm::dvec3(inputs[i].origin)) + extent;
        const double margin = 10.0 * std::sqrt(2.0) * u * reach;
        const MeshOutput& o = outputs[i];
        const double ends = (o.count + 1.0) * 2.0 * 10.0 * std::sqrt(3.0) * u * reach + 8.0 * u * o.total;
        const double least = chord(bodies, to_line(inputs[i]), -margin) - ends,
                     most = chord(bodies, to_line(inputs[i]), margin) + ends;
        if (!(o.total >= least && o.total <= most) || o.count > MESH_INTERVALS) {
            const MeshInput& r = inputs[i];
            INFO("origin " << r.origin.x << ' ' << r.origin.y << ' ' << r.origin.z << " direction " << r.direction.x
                           << ' ' << r.direction.y << ' ' << r.direction.z << " count " << o.count);
            CHECK(o.total >= least);
            CHECK(o.total <= most);
            CHECK(o.count <= MESH_INTERVALS);
        }
        double before = 0.0;
        bool ordered = true;
        for (std::uint32_t k = 0; k < std::min(o.count, std::uint32_t{MESH_INTERVALS}); ++k) {
            ordered = ordered && o.t[k].x >= before && o.t[k].y > o.t[k].x;
            before = o.t[k].y;
        }
        CHECK(ordered);
        if (one_piece)
            CHECK(o.count <= 1u);
    }
}

std::vector<MeshInput> random_rays(int count, double distance, double size) {
    std::mt19937 engine(1);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const auto random = [&] { return glm::dvec3(uniform(engine), uniform(engine), uniform(engine)); };
    std::vector<MeshInput> inputs;
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 origin = distance * random(), target = size * random();
        inputs.push_back({origin, glm::normalize(target - origin)});
    }
    return inputs;
}

// From outside, through and from the middle, exactly to vertices and to points on edges.
std::vector<MeshInput> aimed_rays(const Mesh& mesh, glm::vec3 inside, std::size_t most) {
    std::mt19937 engine(2);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    std::vector<glm::vec3> targets;
    const std::size_t step = std::max<std::size_t>(mesh.triangles.size() / most, 1);
    for (std::size_t i = 0; i < mesh.triangles.size(); i += step) {
        const glm::vec3 a = mesh.vertices[mesh.triangles[i].x], b = mesh.vertices[mesh.triangles[i].y];
        targets.insert(targets.end(), {a, 0.5f * (a + b), 0.75f * a + 0.25f * b});
    }
    std::vector<MeshInput> inputs;
    for (const glm::vec3 target : targets) {
        const glm::vec3 far(4.0 * uniform(engine), 4.0 * uniform(engine), 3.0);
        for (const glm::vec3 from : {inside, far})
            if (target != from)
                inputs.push_back({from, glm::normalize(target - from)});
        for (int axis = 0; axis < 3; ++axis) // along an axis, both ways, through the target and from it
            for (const float sign : {1.0f, -1.0f})
                for (const float back : {4.0f, 0.0f}) {
                    glm::vec3 d(0.0f);
                    d[axis] = sign;
                    inputs.push_back({target - back * d, d});
                }
    }
    return inputs;
}

} // namespace

TEST_CASE("random rays are inside a box, a sphere, overlapping boxes and a letter L as long as they should",
          "[gpu][mesh]") {
    const double distance = GENERATE(0.4, 3.0, 1e3);
    CAPTURE(distance);
    const auto rays = random_rays(4000, distance, 1.3);
    const glm::dvec3 low(-1.0), high(1.0, 0.7, 1.1);
    check_chords(make_box(low, high, 5), {convex_box(low, high)}, rays, true);
    const Mesh sphere = make_icosphere(3);
    check_chords(sphere, {convex_hull(sphere)}, rays, true);
    const glm::dvec3 low2(-0.3, -0.9, 0.2), high2(1.4, 0.5, 1.3);
    check_chords(join(make_box(low, high, 3), make_box(low2, high2, 4)),
                 {convex_box(low, high), convex_box(low2, high2)}, rays, false);
    check_chords(make_letter_l(), {convex_box({0, 0, 0}, {2, 1, 1}), convex_box({0, 0, 0}, {1, 2, 1})}, rays, false);
}

TEST_CASE("a sphere of 20000 triangles", "[gpu][mesh]") {
    const Mesh sphere = make_icosphere(5);
    REQUIRE(sphere.triangles.size() == 20480);
    check_chords(sphere, {convex_hull(sphere)}, random_rays(1500, 2.0, 0.9), true);
    check_chords(sphere, {convex_hull(sphere)}, aimed_rays(sphere, glm::vec3(0.1f, -0.2f, 0.3f), 50), true);
}

TEST_CASE("rays through vertices and edges cross the surface once", "[gpu][mesh][hard]") {
    const glm::dvec3 low(-1.0), high(1.0);
    const Mesh box = make_box(low, high, 8);
    check_chords(box, {convex_box(low, high)}, aimed_rays(box, glm::vec3(0.25f, 0.125f, -0.5f), 2000), true);
    const Mesh sphere = make_icosphere(2);
    check_chords(sphere, {convex_hull(sphere)}, aimed_rays(sphere, glm::vec3(0.0f), 2000), true);
    const Mesh l = make_letter_l();
    check_chords(l, {convex_box({0, 0, 0}, {2, 1, 1}), convex_box({0, 0, 0}, {1, 2, 1})},
                 aimed_rays(l, glm::vec3(0.5f), 2000), false);
}

TEST_CASE("rays within the planes of a tilted box's faces, where triangles are seen edge-on", "[gpu][mesh][hard]") {
    Mesh mesh = make_box(glm::dvec3(-1.0), glm::dvec3(1.0), 12);
    const glm::dmat3 tilt(glm::rotate(glm::dmat4(1.0), 0.7, glm::dvec3(0.3, -1.0, 0.5)));
    for (glm::dvec3& v : mesh.vertices)
        v = tilt * v;
    Convex body = convex_box(glm::dvec3(-1.0), glm::dvec3(1.0));
    for (glm::dvec4& plane : body.planes)
        plane = glm::dvec4(tilt * glm::dvec3(plane), plane.w);
    std::mt19937 engine(3);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    std::vector<MeshInput> inputs;
    for (int i = 0; i < 20000; ++i) {
        glm::dvec3 from(3.0 * uniform(engine), 3.0 * uniform(engine), 3.0 * uniform(engine));
        glm::dvec3 to(uniform(engine), uniform(engine), uniform(engine));
        from[i % 3] = to[i % 3] = i / 3 % 2 != 0 ? 1.0 : -1.0;
        if (i % 2 != 0) // and along the grid's lines in that plane
            from[(i + 1) % 3] = to[(i + 1) % 3] = std::round(6.0 * to[(i + 1) % 3]) / 6.0;
        inputs.push_back({tilt * from, glm::normalize(tilt * (to - from))});
    }
    check_chords(mesh, {body}, inputs, false); // rounded vertices make no plane
}

TEST_CASE("rays along the grid lines of a box are inside for all of it, on its faces for all or nothing",
          "[gpu][mesh][hard]") {
    const float zero = GENERATE(0.0f, -0.0f, 1e-38f, -1e-35f);
    const Bvh bvh = build_bvh(make_box(glm::dvec3(-1.0), glm::dvec3(1.0), 8), glm::dvec3(0.0));
    std::vector<MeshInput> inputs;
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {1.0f, -1.0f})
            for (int i = -5; i <= 5; ++i)
                for (int j = -5; j <= 5; ++j)
                    for (const float start : {-4.0f, 0.0f, 0.25f}) {
                        glm::vec3 origin, direction(zero);
                        origin[axis] = start * sign;
                        origin[(axis + 1) % 3] = 0.25f * static_cast<float>(i);
                        origin[(axis + 2) % 3] = 0.25f * static_cast<float>(j);
                        direction[axis] = sign;
                        inputs.push_back({origin, direction});
                    }
    const auto outputs = run_mesh(bvh, inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const MeshInput& in = inputs[i];
        const MeshOutput& o = outputs[i];
        int axis = 0;
        while (std::abs(in.direction[axis]) != 1.0f)
            ++axis;
        const float across = std::max(std::abs(in.origin[(axis + 1) % 3]), std::abs(in.origin[(axis + 2) % 3]));
        const float start = in.origin[axis] * in.direction[axis];
        const glm::vec2 whole(std::max(-1.0f - start, 0.0f), 1.0f - start);
        INFO(axis << ": " << in.origin.x << ' ' << in.origin.y << ' ' << in.origin.z << " count " << o.count
                  << " total " << o.total);
        CHECK(o.count <= 1u);
        CHECK((across > 1.0f || o.count == 1u || across == 1.0f));
        CHECK((across <= 1.0f || o.count == 0u));
        if (o.count == 1u)
            CHECK((o.t[0] == whole));
    }
}

TEST_CASE("rays meet a torus where brute force says", "[gpu][mesh]") {
    const Bvh bvh = build_bvh(make_torus(1.0, 0.35, 48, 24), glm::dvec3(0.0));
    const double distance = GENERATE(1.0, 5.0);
    auto inputs = random_rays(3000, distance, 1.2);
    for (MeshInput& ray : inputs) { // flat, so that many cross the hole
        ray.origin.z *= 0.1f;
        ray.direction = glm::normalize(ray.direction * glm::vec3(1.0f, 1.0f, 0.1f));
    }
    const auto outputs = run_mesh(bvh, inputs);
    int sure = 0, twice = 0;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const double reach = glm::length(glm::dvec3(inputs[i].origin)) + 2.0;
        const double margin = 10.0 * std::sqrt(2.0) * u * reach;
        bool unsure = false;
        const auto crossings = find_crossings(bvh.triangles, to_line(inputs[i]), margin, unsure);
        if (unsure)
            continue;
        ++sure;
        // A surface at an angle whose sine is 0.01 at least moves by 100 times the margin.
        const double eps = static_cast<double>(crossings.size()) * (100.0 + 2.0) * margin;
        INFO(inputs[i].origin.x << ' ' << inputs[i].origin.y << ' ' << inputs[i].origin.z);
        CHECK(std::abs(outputs[i].total - inside_length(crossings)) <= eps);
        CHECK(outputs[i].count == (crossings.size() + 1) / 2);
        twice += outputs[i].count == 2u;
    }
    CHECK(sure > 2800);
    CHECK(twice > 200);
}
