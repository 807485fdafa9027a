#include "pbrt_triangles.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace vkvol {

namespace {

constexpr double tolerance = 1e-5; // of edges: points of scene files have six digits or so

void add_indices(const PbrtThing& shape, PbrtTriangles& mesh) {
    const PbrtParameters& p = *shape.parameters;
    std::vector<std::size_t> i = p.indices("indices", mesh.points.size());
    const std::size_t corners = shape.type == "bilinearmesh" ? 4 : 3;
    if (i.empty() && mesh.points.size() == corners)
        for (std::size_t k = 0; k < corners; ++k)
            i.push_back(k);
    if (i.size() > corners)
        i.resize(i.size() - i.size() % corners);
    if (i.empty() || i.size() % corners != 0)
        fail_at(shape.place,
                fmt::format("{} has {} indices; expected {} for each piece", shape.type, i.size(), corners));
    for (std::size_t k = 0; k < i.size(); k += corners) {
        mesh.triangles.emplace_back(i[k], i[k + 1], i[corners == 4 ? k + 3 : k + 2]);
        if (corners == 4) // its corners go (0, 0), (1, 0), (0, 1), (1, 1)
            mesh.triangles.emplace_back(i[k], i[k + 3], i[k + 2]);
    }
}

bool is_small(const glm::dvec3& v, double size) {
    return glm::length(v) <= tolerance * size;
}

} // namespace

double PbrtTriangles::area_of(std::size_t begin, std::size_t end) const {
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
        const glm::uvec3& t = triangles[i];
        sum += 0.5 * glm::length(glm::cross(points[t.y] - points[t.x], points[t.z] - points[t.x]));
    }
    return sum;
}

double PbrtTriangles::area() const {
    return area_of(0, triangles.size());
}

bool PbrtTriangles::is_even(int each) const {
    const auto step = static_cast<std::size_t>(each);
    for (std::size_t i = step; i + step <= triangles.size(); i += step)
        if (std::abs(area_of(i, i + step) - area_of(0, step)) > tolerance * area_of(0, step))
            return false;
    return true;
}

PbrtTriangles read_triangles(const PbrtThing& shape) {
    const PbrtParameters& p = *shape.parameters;
    PbrtTriangles mesh;
    mesh.points = p.points("P");
    if (mesh.points.empty())
        fail_at(shape.place, fmt::format("{} lacks its points, \"point3 P\"", shape.type));
    mesh.normals = p.points("N");
    mesh.places = p.pairs("uv");
    if (mesh.normals.size() != mesh.points.size()) // as pbrt does
        mesh.normals.clear();
    if (mesh.places.size() != mesh.points.size())
        mesh.places.clear();
    add_indices(shape, mesh);
    return mesh;
}

PbrtTriangles with_usual_places(const PbrtTriangles& mesh, bool is_patches) {
    constexpr glm::dvec2 first[] = {{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}},
                         second[] = {{0.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}};
    PbrtTriangles apart;
    for (const glm::uvec3& t : mesh.triangles) {
        const bool is_second = is_patches && apart.triangles.size() % 2 == 1;
        const auto corner = static_cast<unsigned>(apart.points.size());
        for (int k = 0; k < 3; ++k) {
            apart.points.push_back(mesh.points[t[k]]);
            if (!mesh.normals.empty())
                apart.normals.push_back(mesh.normals[t[k]]);
            apart.places.push_back(is_second ? second[k] : first[k]);
        }
        apart.triangles.emplace_back(corner, corner + 1, corner + 2);
    }
    return apart;
}

PbrtTriangles moved(const glm::dmat4& map, PbrtTriangles mesh, bool is_reversed) {
    for (glm::dvec3& point : mesh.points)
        point = glm::dvec3(map * glm::dvec4(point, 1.0));
    if (std::all_of(mesh.normals.begin(), mesh.normals.end(), [](const auto& n) { return n == glm::dvec3(0.0); }))
        mesh.normals.clear(); // an exporter's, that had none
    const bool mirrors = glm::determinant(glm::dmat3(map)) < 0.0;
    const glm::dmat3 of_normals = glm::transpose(glm::inverse(glm::dmat3(map))) * (is_reversed ? -1.0 : 1.0);
    for (glm::dvec3& normal : mesh.normals)
        normal = of_normals * normal;
    for (glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 face = glm::cross(mesh.points[t.y] - mesh.points[t.x], mesh.points[t.z] - mesh.points[t.x]);
        const glm::dvec3 normal =
            mesh.normals.empty() ? glm::dvec3(0.0) : mesh.normals[t.x] + mesh.normals[t.y] + mesh.normals[t.z];
        if (normal == glm::dvec3(0.0) ? mirrors != is_reversed : glm::dot(face, normal) < 0.0)
            std::swap(t.y, t.z);
    }
    return mesh;
}

bool has_normals_of_faces(const PbrtTriangles& mesh) {
    if (mesh.normals.empty())
        return false;
    return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const glm::uvec3& t) {
        const glm::dvec3 face = glm::cross(mesh.points[t.y] - mesh.points[t.x], mesh.points[t.z] - mesh.points[t.x]);
        for (int k = 0; k < 3; ++k)
            if (const glm::dvec3& normal = mesh.normals[t[k]];
                !(glm::dot(face, normal) > 0.0 &&
                  glm::length(glm::cross(face, normal)) <= tolerance * glm::length(face) * glm::length(normal)))
                return false;
        return true;
    });
}

std::optional<PbrtRectangle> as_rectangle(const PbrtTriangles& mesh) {
    if (mesh.triangles.size() != 2 || !mesh.normals.empty())
        return std::nullopt;
    const glm::uvec3 first = mesh.triangles[0], second = mesh.triangles[1];
    const auto at = [&](unsigned i) { return mesh.points[i]; };
    for (int corner = 0; corner < 3; ++corner) {
        // From the right angle of the first: the other triangle has the far corner, and goes round the same way.
        const unsigned o = first[corner], a = first[(corner + 1) % 3], b = first[(corner + 2) % 3];
        const glm::dvec3 u = at(a) - at(o), v = at(b) - at(o);
        const double size = glm::length(u) + glm::length(v);
        if (!(glm::length(u) * glm::length(v) > 0.0) ||
            std::abs(glm::dot(u, v)) > tolerance * glm::length(u) * glm::length(v))
            continue;
        for (int other = 0; other < 3; ++other) {
            const glm::dvec3 far = at(second[other]);
            const glm::dvec3 after = at(second[(other + 1) % 3]), before = at(second[(other + 2) % 3]);
            if (is_small(far - (at(o) + u + v), size) && is_small(after - at(b), size) &&
                is_small(before - at(a), size))
                return PbrtRectangle{at(o) + 0.5 * (u + v), u, v};
        }
    }
    return std::nullopt;
}

std::optional<glm::dmat4> as_box(const PbrtTriangles& mesh) {
    if (mesh.triangles.size() != 12)
        return std::nullopt;
    std::vector<glm::dvec3> corners;
    double size = 0.0;
    for (const glm::uvec3& t : mesh.triangles)
        for (int k = 0; k < 3; ++k)
            size = std::max(size, glm::length(mesh.points[t[k]] - mesh.points[mesh.triangles[0].x]));
    for (const glm::uvec3& t : mesh.triangles)
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3& p = mesh.points[t[k]];
            if (std::none_of(corners.begin(), corners.end(), [&](const auto& c) { return is_small(c - p, size); }))
                corners.push_back(p);
        }
    if (corners.size() != 8)
        return std::nullopt;
    glm::dvec3 center(0.0);
    for (const glm::dvec3& corner : corners)
        center += corner / 8.0;
    const auto is_corner = [&](const glm::dvec3& p) {
        return std::any_of(corners.begin(), corners.end(), [&](const auto& c) { return is_small(c - p, size); });
    };
    // Three edges from the first corner make all others.
    const glm::dvec3 o = corners[0];
    for (std::size_t i = 1; i < 8; ++i)
        for (std::size_t j = i + 1; j < 8; ++j)
            for (std::size_t k = j + 1; k < 8; ++k) {
                const glm::dvec3 u = corners[i] - o, v = corners[j] - o, w = corners[k] - o;
                const double volume = glm::dot(glm::cross(u, v), w);
                if (std::abs(volume) <= tolerance * size * size * size * tolerance || !is_corner(o + u + v) ||
                    !is_corner(o + v + w) || !is_corner(o + u + w) || !is_corner(o + u + v + w))
                    continue;
                return glm::dmat4(glm::dvec4(u, 0.0), glm::dvec4(volume > 0.0 ? v : w, 0.0),
                                  glm::dvec4(volume > 0.0 ? w : v, 0.0), glm::dvec4(center, 1.0));
            }
    return std::nullopt;
}

} // namespace vkvol
