#include "mesh.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

#include "error.h"
#include "polygons.h"

namespace vkvol {

namespace {

// Vertices at the same position become one. Triangles that lose a corner by that go: of their edges one is left, which
// they run through both ways, so that their neighbours on either side fit each other. Triangles whose three corners lie
// on a line stay, since they fill a gap between unlike edges; no ray meets them.
void weld(Polygons& obj) {
    const std::vector<std::uint32_t> welded = welded_vertices(obj.vertices);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < obj.triangles.size(); ++i) {
        const glm::uvec3 old = obj.triangles[i], t = {welded[old.x], welded[old.y], welded[old.z]};
        if (t.x == t.y || t.y == t.z || t.z == t.x)
            continue;
        obj.triangles[kept] = t;
        if (!obj.normals.empty())
            obj.normals[kept] = obj.normals[i];
        ++kept;
    }
    obj.triangles.resize(kept);
    obj.normals.resize(obj.normals.empty() ? 0 : kept);
}

struct Edge {
    std::uint32_t low, high; // vertices, low < high
    std::uint32_t triangle;
    bool forward; // run through from low to high
    auto ends() const { return std::pair(low, high); }
};

std::vector<Edge> sorted_edges(const std::vector<glm::uvec3>& triangles) {
    std::vector<Edge> edges;
    edges.reserve(3 * triangles.size());
    for (std::uint32_t i = 0; i < triangles.size(); ++i)
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t a = triangles[i][corner], b = triangles[i][(corner + 1) % 3];
            edges.push_back({std::min(a, b), std::max(a, b), i, a < b});
        }
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.ends() < b.ends(); });
    return edges;
}

// Calls use(first, last) for every run of edges between the same two vertices.
template <class Use> void for_each_edge(const std::vector<Edge>& edges, Use&& use) {
    for (auto first = edges.begin(); first != edges.end();) {
        const auto last = std::find_if(first, edges.end(), [&](const Edge& e) { return e.ends() != first->ends(); });
        use(first, last);
        first = last;
    }
}

// Two triangles meet in an edge and run through it in opposite directions; where bodies touch it may be more, as many
// one way as the other.
void check_closed(const Polygons& obj, const std::vector<Edge>& edges, const std::string& file) {
    std::size_t open = 0, turned = 0;
    const Edge* example = nullptr;
    for_each_edge(edges, [&](auto first, auto last) {
        const auto count = last - first;
        const auto forward = std::count_if(first, last, [](const Edge& e) { return e.forward; });
        if (2 * forward == count)
            return;
        const bool odd = count % 2 != 0;
        if (!example || (odd && open == 0)) // rather an open edge than one between triangles that disagree
            example = &*first;
        ++(odd ? open : turned);
    });
    if (!example)
        return;
    const glm::dvec3 a = obj.vertices[example->low], b = obj.vertices[example->high];
    const std::string place =
        fmt::format("from ({:g}, {:g}, {:g}) to ({:g}, {:g}, {:g})", a.x, a.y, a.z, b.x, b.y, b.z);
    if (open > 0)
        throw InputError(
            fmt::format("{}: the surface is not closed: {} edges, one {}, do not join two faces; close the "
                        "holes, e.g. in Blender by Select > All by Trait > Non Manifold, then Face > Fill",
                        file, open, place));
    throw InputError(fmt::format("{}: faces disagree about which side is outside along {} edges, one {}; make them "
                                 "consistent, e.g. in Blender by Mesh > Normals > Recalculate Outside",
                                 file, turned, place));
}

// Which body a triangle belongs to: a triangle of it. Triangles that share an edge are of one body.
std::vector<std::uint32_t> find_bodies(std::size_t triangles, const std::vector<Edge>& edges) {
    std::vector<std::uint32_t> parent(triangles);
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](std::uint32_t i) {
        while (parent[i] != i)
            i = parent[i] = parent[parent[i]];
        return i;
    };
    for_each_edge(edges, [&](auto first, auto last) {
        for (auto other = first + 1; other != last; ++other)
            parent[root(other->triangle)] = root(first->triangle);
    });
    for (std::uint32_t i = 0; i < triangles; ++i)
        parent[i] = root(i);
    return parent;
}

// A body's triangles, what they enclose by the divergence theorem, and the box about it. The volume is the sum of
// tetrahedra from a vertex of its own, so that nothing large cancels far from the origin.
struct Body {
    std::vector<std::uint32_t> triangles;
    double volume = 0.0; // times 6; < 0: faces point inwards
    double area = 0.0;   // times 2
    glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
    bool is_cavity = false;
};

std::vector<Body> bodies_of(const Polygons& obj, const std::vector<std::uint32_t>& numbers) {
    std::map<std::uint32_t, Body> bodies;
    for (std::uint32_t i = 0; i < obj.triangles.size(); ++i) {
        Body& body = bodies[numbers[i]];
        const glm::uvec3 t = obj.triangles[i];
        const glm::dvec3 apex = obj.vertices[obj.triangles[numbers[i]].x];
        const glm::dvec3 a = obj.vertices[t.x] - apex, b = obj.vertices[t.y] - apex, c = obj.vertices[t.z] - apex;
        body.volume += glm::dot(a, glm::cross(b, c));
        body.area += glm::length(glm::cross(b - a, c - a));
        body.triangles.push_back(i);
        for (int corner = 0; corner < 3; ++corner) {
            body.low = glm::min(body.low, obj.vertices[t[corner]]);
            body.high = glm::max(body.high, obj.vertices[t[corner]]);
        }
    }
    std::vector<Body> all;
    for (auto& [number, body] : bodies)
        all.push_back(std::move(body));
    return all;
}

// By how many faces a ray of no special direction crosses.
bool is_within(const Polygons& obj, const Body& body, const glm::dvec3& point) {
    const glm::dvec3 direction = glm::normalize(glm::dvec3(0.3718, 0.7391, 0.5623));
    bool within = false;
    for (const std::uint32_t i : body.triangles) {
        const glm::uvec3 t = obj.triangles[i];
        const glm::dvec3 a = obj.vertices[t.x] - point, b = obj.vertices[t.y] - point, c = obj.vertices[t.z] - point;
        const double u = glm::dot(direction, glm::cross(b, c)), v = glm::dot(direction, glm::cross(c, a)),
                     w = glm::dot(direction, glm::cross(a, b));
        const bool crosses = (u > 0.0 && v > 0.0 && w > 0.0) || (u < 0.0 && v < 0.0 && w < 0.0);
        within ^= crosses && glm::dot(a, glm::cross(b, c)) * (u + v + w) > 0.0;
    }
    return within;
}

// Faces that are there twice, once each way, are closed and have nothing within them.
void check_fills(const std::vector<Body>& bodies, const std::string& file) {
    for (const Body& body : bodies)
        if (!(std::abs(body.volume) > 1e-9 * std::pow(body.area, 1.5)))
            throw InputError(fmt::format("{}: a body of {} triangles from ({:g}, {:g}, {:g}) to ({:g}, {:g}, {:g}) "
                                         "encloses nothing; remove faces that are there twice, or give it a "
                                         "thickness, e.g. in Blender by the modifier Solidify",
                                         file, body.triangles.size(), body.low.x, body.low.y, body.low.z, body.high.x,
                                         body.high.y, body.high.z));
}

// Turns every body's faces outward, but for cavities, whose faces point the other way than those of the smallest body
// about them.
void turn_outward(Polygons& obj, std::vector<Body> bodies) {
    std::sort(bodies.begin(), bodies.end(),
              [](const Body& a, const Body& b) { return std::abs(a.volume) > std::abs(b.volume); });
    const auto is_inward = [](const Body& body) { return body.volume < 0.0; };
    const bool are_alike =
        std::all_of(bodies.begin(), bodies.end(), is_inward) || std::none_of(bodies.begin(), bodies.end(), is_inward);
    std::array<std::vector<std::size_t>, 2> before; // bodies whose faces point outward, and inward
    for (std::size_t i = 0; i < bodies.size() && !are_alike; ++i) {
        Body& body = bodies[i];
        before[is_inward(body)].push_back(i);
        const auto is_other_way = [&](const Body& about) { return is_inward(about) != is_inward(body); };
        const auto has_in_box = [&](const Body& about) {
            return glm::all(glm::lessThan(about.low, body.low)) && glm::all(glm::greaterThan(about.high, body.high));
        };
        // A drop of spray need not be looked for among the faces of a sea that is the same way round.
        const std::vector<std::size_t>& others = before[!is_inward(body)];
        if (std::none_of(others.begin(), others.end(), [&](std::size_t k) { return has_in_box(bodies[k]); }))
            continue;
        for (std::size_t k = i; k-- > 0;) {
            const Body& about = bodies[k];
            if (!has_in_box(about) || !is_within(obj, about, obj.vertices[obj.triangles[body.triangles.front()].x]))
                continue;
            body.is_cavity = is_other_way(about) && !about.is_cavity;
            break;
        }
    }
    for (const Body& body : bodies)
        if ((body.volume < 0.0) != body.is_cavity)
            for (const std::uint32_t i : body.triangles) {
                std::swap(obj.triangles[i].y, obj.triangles[i].z);
                if (!obj.normals.empty())
                    std::swap(obj.normals[i][1], obj.normals[i][2]);
            }
}

void append(Mesh& mesh, Polygons& obj) {
    if (mesh.normals.size() == mesh.triangles.size())
        mesh.normals.insert(mesh.normals.end(), obj.normals.begin(), obj.normals.end());
    drop_loose_vertices(obj.vertices, obj.triangles);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), obj.vertices.begin(), obj.vertices.end());
    for (const glm::uvec3& t : obj.triangles)
        mesh.triangles.push_back(t + first);
}

} // namespace

std::vector<std::uint32_t> welded_vertices(const std::vector<glm::dvec3>& vertices) {
    std::vector<std::uint32_t> order(vertices.size()), welded(vertices.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](std::uint32_t i) { return std::tuple(vertices[i].x, vertices[i].y, vertices[i].z); };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    for (std::size_t i = 0; i < order.size(); ++i)
        welded[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? welded[order[i - 1]] : order[i];
    return welded;
}

void drop_loose_vertices(std::vector<glm::dvec3>& vertices, std::vector<glm::uvec3>& triangles) {
    constexpr std::uint32_t loose = ~0u;
    std::vector<std::uint32_t> place(vertices.size(), loose);
    for (const glm::uvec3& t : triangles)
        place[t.x] = place[t.y] = place[t.z] = 0;
    std::uint32_t kept = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i)
        if (place[i] != loose) {
            vertices[kept] = vertices[i];
            place[i] = kept++;
        }
    vertices.resize(kept);
    for (glm::uvec3& t : triangles)
        t = {place[t.x], place[t.y], place[t.z]};
}

void close_polygons(Polygons& polygons, const std::string& name) {
    weld(polygons);
    if (polygons.triangles.empty())
        throw InputError(fmt::format("{}: all faces are degenerate; export the mesh again, at a scale at which its "
                                     "vertices differ",
                                     name));
    const std::vector<Edge> edges = sorted_edges(polygons.triangles);
    check_closed(polygons, edges, name);
    std::vector<Body> bodies = bodies_of(polygons, find_bodies(polygons.triangles.size(), edges));
    check_fills(bodies, name);
    turn_outward(polygons, std::move(bodies));
}

std::vector<glm::vec3> corners_about(const Mesh& mesh, const glm::dvec3& origin) {
    std::vector<glm::vec3> corners;
    corners.reserve(3 * mesh.triangles.size());
    for (const glm::uvec3& triangle : mesh.triangles)
        for (int corner = 0; corner < 3; ++corner)
            corners.push_back(mesh.vertices[triangle[corner]] - origin);
    return corners;
}

Mesh load_mesh(const MeshFiles& files, const glm::dmat4& transform) {
    if (files.paths.empty())
        throw InputError("a mesh needs at least one .obj or .ply file; name it in the scene");
    Mesh mesh;
    bool first = true;
    for (const std::filesystem::path& path : files.paths) {
        Polygons obj = read_polygons(path);
        if (transform != glm::dmat4(1.0))
            for (glm::dvec3& vertex : obj.vertices)
                vertex = glm::dvec3(transform * glm::dvec4(vertex, 1.0));
        const std::string file = path.string();
        close_polygons(obj, file);
        append(mesh, obj);
        mesh.warnings.insert(mesh.warnings.end(), obj.warnings.begin(), obj.warnings.end());
        mesh.normal_warnings.insert(mesh.normal_warnings.end(), obj.normal_warnings.begin(), obj.normal_warnings.end());
        if (first)
            mesh.diffuse = obj.diffuse;
        if (obj.several_diffuse || obj.diffuse != mesh.diffuse)
            mesh.warnings.push_back(fmt::format("{}: materials differ in Kd, but a medium has one albedo: that of the "
                                                "first face is taken",
                                                file));
        first = false;
    }
    if (mesh.normals.size() != mesh.triangles.size())
        mesh.normals.clear();
    return mesh;
}

} // namespace vkvol
