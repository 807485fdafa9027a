#include "test_meshes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <map>

namespace vkvol {

Mesh make_box(glm::dvec3 low, glm::dvec3 high, int n) {
    Mesh mesh;
    for (int axis = 0; axis < 3; ++axis)
        for (const int side : {0, 1}) {
            const auto at = [&](int i, int j) {
                glm::dvec3 f;
                f[axis] = side;
                f[(axis + 1) % 3] = double(i) / n;
                f[(axis + 2) % 3] = double(j) / n;
                mesh.vertices.push_back(low + f * (high - low));
                return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
            };
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j) {
                    const auto a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
                    if (side == 1) {
                        mesh.triangles.emplace_back(a, b, c);
                        mesh.triangles.emplace_back(a, c, d);
                    } else {
                        mesh.triangles.emplace_back(a, c, b);
                        mesh.triangles.emplace_back(a, d, c);
                    }
                }
        }
    return mesh;
}

Mesh make_icosphere(int level) {
    const double g = (1.0 + std::sqrt(5.0)) / 2.0;
    Mesh mesh;
    mesh.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                     {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                      {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                      {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    for (glm::dvec3& v : mesh.vertices)
        v = glm::normalize(v);
    for (int k = 0; k < level; ++k) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [at, added] = middles.try_emplace(std::minmax(a, b), std::uint32_t(mesh.vertices.size()));
            if (added)
                mesh.vertices.push_back(glm::normalize(mesh.vertices[a] + mesh.vertices[b]));
            return at->second;
        };
        std::vector<glm::uvec3> finer;
        for (const glm::uvec3 t : mesh.triangles) {
            const auto a = middle(t.x, t.y), b = middle(t.y, t.z), c = middle(t.z, t.x);
            finer.insert(finer.end(), {{t.x, a, c}, {a, t.y, b}, {c, b, t.z}, {a, b, c}});
        }
        mesh.triangles = finer;
    }
    return mesh;
}

Mesh make_torus(double major, double minor, int n, int m) {
    Mesh mesh;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < m; ++j) {
            const double a = 2.0 * M_PI * i / n, b = 2.0 * M_PI * j / m;
            mesh.vertices.emplace_back((major + minor * std::cos(b)) * std::cos(a),
                                       (major + minor * std::cos(b)) * std::sin(a), minor * std::sin(b));
        }
    const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i % n * m + j % m); };
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < m; ++j) {
            mesh.triangles.emplace_back(at(i, j), at(i + 1, j), at(i + 1, j + 1));
            mesh.triangles.emplace_back(at(i, j), at(i + 1, j + 1), at(i, j + 1));
        }
    return mesh;
}

Mesh make_letter_l() {
    const std::vector<glm::dvec2> outline{{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}, {0, 1}};
    const std::vector<glm::uvec3> cap{{0, 1, 4}, {0, 4, 7}, {1, 2, 3}, {1, 3, 4}, {7, 4, 5}, {7, 5, 6}};
    Mesh mesh;
    for (const double z : {0.0, 1.0})
        for (const glm::dvec2 p : outline)
            mesh.vertices.emplace_back(p, z);
    for (const glm::uvec3 t : cap) {
        mesh.triangles.emplace_back(t.x, t.z, t.y);
        mesh.triangles.push_back(t + 8u);
    }
    for (std::uint32_t i = 0; i < 8; ++i) {
        const std::uint32_t j = (i + 1) % 8;
        mesh.triangles.emplace_back(i, j, j + 8);
        mesh.triangles.emplace_back(i, j + 8, i + 8);
    }
    return mesh;
}

Mesh join(Mesh a, const Mesh& b) {
    for (const glm::uvec3 t : b.triangles)
        a.triangles.push_back(t + static_cast<std::uint32_t>(a.vertices.size()));
    a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
    return a;
}

std::string as_obj(const Mesh& mesh) {
    std::string text;
    for (const glm::dvec3 v : mesh.vertices)
        text += "v " + std::to_string(v.x) + ' ' + std::to_string(v.y) + ' ' + std::to_string(v.z) + '\n';
    for (const glm::uvec3 t : mesh.triangles)
        text += "f " + std::to_string(t.x + 1) + ' ' + std::to_string(t.y + 1) + ' ' + std::to_string(t.z + 1) + '\n';
    return text;
}

std::string as_ply(const Mesh& mesh, PlyFormat format) {
    std::string text = fmt::format("ply\nformat {} 1.0\nelement vertex {}\nproperty double x\nproperty double y\n"
                                   "property double z\nelement face {}\nproperty list uchar int vertex_indices\n"
                                   "end_header\n",
                                   format == PlyFormat::ascii           ? "ascii"
                                   : format == PlyFormat::little_endian ? "binary_little_endian"
                                                                        : "binary_big_endian",
                                   mesh.vertices.size(), mesh.triangles.size());
    const auto add = [&](auto number) {
        if (format == PlyFormat::ascii) {
            text += fmt::format("{} ", static_cast<double>(number));
            return;
        }
        char bytes[sizeof number]; // this machine's are little-endian
        std::memcpy(bytes, &number, sizeof number);
        if (format == PlyFormat::big_endian)
            std::reverse(bytes, bytes + sizeof number);
        text.append(bytes, sizeof number);
    };
    for (const glm::dvec3& vertex : mesh.vertices)
        for (int axis = 0; axis < 3; ++axis)
            add(vertex[axis]);
    for (const glm::uvec3& triangle : mesh.triangles) {
        add(std::uint8_t{3});
        for (int corner = 0; corner < 3; ++corner)
            add(static_cast<std::int32_t>(triangle[corner]));
    }
    return text;
}

} // namespace vkvol
