// Look-ups of whether points are within a mesh, read as kernels read them, against solid angles.
#include <bit>
#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <random>

#include "error.h"
#include "inside_lattice.h"
#include "mesh.h"
#include "shared/constants.h"

using namespace vkvol;

namespace {

using Corners = std::vector<glm::vec3>;

// How many bodies a point is within (van Oosterom and Strackee 1983).
double bodies_by_angles(const Corners& corners, const glm::dvec3& p) {
    double angle = 0.0;
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        const glm::dvec3 a = glm::dvec3(corners[i]) - p, b = glm::dvec3(corners[i + 1]) - p,
                         c = glm::dvec3(corners[i + 2]) - p;
        const double u = glm::length(a), v = glm::length(b), w = glm::length(c);
        angle += 2.0 * std::atan2(glm::dot(a, glm::cross(b, c)),
                                  u * v * w + glm::dot(a, b) * w + glm::dot(b, c) * u + glm::dot(c, a) * v);
    }
    return angle / (4.0 * std::numbers::pi);
}

double volume_of(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
    return glm::dot(b - a, glm::cross(c - a, d - a));
}

// As inside.glsl has it, but for how a segment meets a triangle.
bool look_up(const InsideLattice& lattice, const glm::dvec3& p) {
    const auto number = [&](std::size_t i) { return double(std::bit_cast<float>(lattice.words[i])); };
    const auto place = [&](std::size_t i) { return glm::dvec3(number(i), number(i + 1), number(i + 2)); };
    const glm::ivec3 dims(lattice.words[INSIDE_DIMS], lattice.words[INSIDE_DIMS + 1], lattice.words[INSIDE_DIMS + 2]);
    const glm::ivec3 cell(glm::floor((p - place(0)) * number(INSIDE_PER_UNIT)));
    if (cell != glm::clamp(cell, glm::ivec3(0), dims - 1))
        return false;
    const std::size_t record = lattice.words[INSIDE_HEAD + (std::size_t(cell.x) * dims.y + cell.y) * dims.z + cell.z];
    if (record < 2)
        return record == 1;
    int bodies = static_cast<int>(lattice.words[record + 1]);
    const glm::dvec3 known = place(record + 2);
    for (std::uint32_t k = 0; k < lattice.words[record]; ++k) {
        const std::size_t at = lattice.words[INSIDE_CORNERS] + 9 * lattice.words[record + 5 + k];
        const glm::dvec3 a = place(at), b = place(at + 3), c = place(at + 6);
        const bool out = volume_of(a, b, c, p) > 0.0; // behind the face, where its normal does not point
        if (out == (volume_of(a, b, c, known) > 0.0))
            continue;
        const bool side = volume_of(p, known, a, b) > 0.0;
        if (side == (volume_of(p, known, b, c) > 0.0) && side == (volume_of(p, known, c, a) > 0.0))
            bodies += side ? 1 : -1;
    }
    return bodies > 0;
}

void add_box(Corners& corners, const glm::vec3& low, const glm::vec3& high, bool is_cavity) {
    const int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    const auto corner = [&](int i) {
        return glm::vec3(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
    };
    for (const auto& f : faces)
        for (const int i : is_cavity ? std::array{0, 2, 1, 0, 3, 2} : std::array{0, 1, 2, 0, 2, 3})
            corners.push_back(corner(f[i]));
}

// A star of many faces, about 2 across.
Corners star(int rings) {
    const auto point = [&](int ring, int segment) {
        const double theta = std::numbers::pi * ring / rings, phi = std::numbers::pi * (segment % (2 * rings)) / rings;
        const double radius =
            0.75 + 0.25 * std::sin(5.0 * phi) * std::pow(std::sin(theta), 5.0) + 0.1 * std::cos(7.0 * theta);
        return glm::vec3(radius * std::sin(theta) * std::cos(phi), radius * std::sin(theta) * std::sin(phi),
                         radius * std::cos(theta));
    };
    Corners corners;
    for (int ring = 0; ring < rings; ++ring)
        for (int segment = 0; segment < 2 * rings; ++segment) {
            const glm::vec3 a = point(ring, segment), b = point(ring + 1, segment), c = point(ring + 1, segment + 1),
                            d = point(ring, segment + 1);
            if (ring + 1 < rings)
                corners.insert(corners.end(), {a, b, c});
            if (ring > 0)
                corners.insert(corners.end(), {a, c, d});
        }
    return corners;
}

void check_points(const Corners& corners, int count, const std::string& name) {
    CAPTURE(name);
    const InsideLattice lattice = make_inside_lattice(corners);
    glm::dvec3 low(corners.front()), high = low;
    for (const glm::vec3& corner : corners) {
        low = glm::min(low, glm::dvec3(corner));
        high = glm::max(high, glm::dvec3(corner));
    }
    std::mt19937 engine(5);
    std::uniform_real_distribution<double> part(-0.1, 1.1);
    int within = 0, listed = 0;
    for (int n = 0; n < count; ++n) {
        const glm::dvec3 p = glm::mix(low, high, glm::dvec3(part(engine), part(engine), part(engine)));
        const double bodies = bodies_by_angles(corners, p);
        const bool found = look_up(lattice, p);
        CAPTURE(n, p.x, p.y, p.z, bodies);
        REQUIRE(found == (bodies > 0.5));
        within += found ? 1 : 0;
        const glm::ivec3 cell(glm::floor((p - lattice.low) / lattice.edge));
        const glm::ivec3 dims = lattice.cells.dims;
        if (cell == glm::clamp(cell, glm::ivec3(0), dims - 1)) {
            const std::size_t i = (std::size_t(cell.x) * dims.y + cell.y) * dims.z + cell.z;
            listed += lattice.words[INSIDE_HEAD + i] > 1 ? 1 : 0;
            CHECK(lattice.cells.bounds[i] >= (found ? 1.0f : 0.0f));
        } else {
            CHECK(!found);
        }
    }
    CHECK(within > count / 50);
    CHECK(listed > count / 50);
}

} // namespace

TEST_CASE("a point is within a mesh or without, by one look-up", "[cpu][mesh][several]") {
    check_points(star(40), 2000, "star");
    Corners bodies;
    add_box(bodies, {-1.0f, -1.0f, -1.0f}, {1.0f, 1.0f, 1.0f}, false);
    add_box(bodies, {-0.4f, -0.6f, -0.3f}, {0.5f, 0.7f, 0.6f}, true);
    add_box(bodies, {0.3f, 0.2f, 0.1f}, {2.0f, 1.5f, 0.4f}, false); // through the cavity's wall
    // What meets nothing, as files have it along a seam: a needle in the box's upright edge, and a point.
    bodies.insert(bodies.end(), {{-1.0f, -1.0f, -1.0f}, {-1.0f, -1.0f, 0.5f}, {-1.0f, -1.0f, 1.0f}});
    bodies.insert(bodies.end(), 3, {0.1f, 0.1f, 0.9f});
    check_points(bodies, 20000, "bodies");
    for (glm::vec3& corner : bodies)
        corner *= 1e-7f;
    check_points(bodies, 20000, "tiny bodies");
    Corners slab; // thinner than a cube of it
    add_box(slab, {-5.0f, -5.0f, 0.0f}, {5.0f, 5.0f, 0.01f}, false);
    check_points(slab, 5000, "slab");
}

TEST_CASE("models of which too many faces meet are refused beside others", "[cpu][mesh][several]") {
    Corners cone;
    constexpr int faces = 1500;
    const auto rim = [](int i) {
        const double phi = 2.0 * std::numbers::pi * (i % faces) / faces;
        return glm::vec3(std::cos(phi), std::sin(phi), 0.0);
    };
    for (int i = 0; i < faces; ++i)
        cone.insert(cone.end(), {rim(i), rim(i + 1), glm::vec3(0.0f, 0.0f, 1.0f), rim(i + 1), rim(i), glm::vec3(0.0f)});
    CHECK_THROWS_WITH(make_inside_lattice(cone), Catch::Contains("more than 1000 triangles of a model meet within") &&
                                                     Catch::Contains("decimate it there"));
}
