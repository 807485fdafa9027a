#include "surface_mesh.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <numeric>

#include "error.h"
#include "mesh.h"
#include "polygons.h"
#include "radiance_map.h"

namespace vkvol {

namespace {

// What files of meshes hold: those that several surfaces have are read once, but for what is to be closed.
class MeshFileReader {
public:
    explicit MeshFileReader(const std::vector<Surface>& surfaces) {
        for (const Surface& surface : surfaces)
            if (const MeshSurface* mesh = std::get_if<MeshSurface>(&surface.shape); mesh && !is_closed(surface))
                ++left_[mesh->file];
    }

    static bool is_closed(const Surface& surface) { return surface.material.kind == MaterialKind::dielectric; }

    // For the next of its surfaces.
    Polygons of(const std::filesystem::path& file) {
        const bool is_last = --left_[file] == 0;
        const auto found = read_.find(file);
        if (found == read_.end()) {
            Polygons polygons = read_polygons(file);
            if (!is_last)
                read_.emplace(file, polygons);
            return polygons;
        }
        if (!is_last)
            return found->second;
        Polygons polygons = std::move(found->second);
        read_.erase(found);
        return polygons;
    }

private:
    std::map<std::filesystem::path, std::size_t> left_;
    std::map<std::filesystem::path, Polygons> read_;
};

// Of a file, to who needs what it is about.
struct MeshWarnings {
    std::vector<std::string> of_places, of_normals;
};

TriangleSurface load(const MeshSurface& mesh, const glm::dmat4& transform, bool closed, MeshFileReader& files,
                     MeshWarnings& warnings) {
    if (closed) {
        Mesh loaded = load_mesh({{mesh.file}}, transform);
        warnings.of_normals = std::move(loaded.normal_warnings);
        return {std::move(loaded.vertices), std::move(loaded.triangles), std::move(loaded.normals), {}, true};
    }
    Polygons read = files.of(mesh.file);
    warnings = {std::move(read.place_warnings), std::move(read.normal_warnings)};
    drop_loose_vertices(read.vertices, read.triangles);
    for (glm::dvec3& vertex : read.vertices)
        vertex = glm::dvec3(transform * glm::dvec4(vertex, 1.0));
    TriangleSurface shape{std::move(read.vertices), std::move(read.triangles), std::move(read.normals),
                          std::move(read.places), true};
    if (glm::determinant(glm::dmat3(transform)) < 0.0)
        shape.turn_about();
    return shape;
}

// Normal of triangle `i`, twice its area long. It points to where the corners are seen counterclockwise.
glm::dvec3 across(const TriangleSurface& mesh, std::size_t i) {
    const glm::uvec3 t = mesh.triangles[i];
    return glm::cross(mesh.vertices[t.y] - mesh.vertices[t.x], mesh.vertices[t.z] - mesh.vertices[t.x]);
}

// At each vertex the mean of the faces about it, by their areas. Files have several vertices at one place where texture
// coordinates differ, or three of its own for each face; those of sheets with two sides look to either.
std::vector<glm::mat3> means_of_faces(const TriangleSurface& mesh) {
    std::vector<glm::dvec3> sums(mesh.vertices.size(), glm::dvec3(0.0));
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (int corner = 0; corner < 3; ++corner)
            sums[mesh.triangles[i][corner]] += across(mesh, i);
    const std::vector<std::uint32_t> welded = welded_vertices(mesh.vertices);
    std::vector<std::uint32_t> order(mesh.vertices.size()); // those at one place in a row
    std::iota(order.begin(), order.end(), 0u);
    const auto before = [&](std::uint32_t a, std::uint32_t b) { return welded[a] < welded[b]; };
    std::sort(order.begin(), order.end(), before);
    constexpr std::ptrdiff_t many = 1000; // at one place, of which each then has its own faces alone
    std::vector<glm::dvec3> means(mesh.vertices.size());
    for (const std::uint32_t vertex : order) {
        const auto [first, last] = std::equal_range(order.begin(), order.end(), vertex, before);
        const glm::dvec3 own = sums[vertex];
        glm::dvec3 sum = last - first > many ? own : glm::dvec3(0.0);
        for (auto other = first; last - first <= many && other != last; ++other)
            sum += glm::dot(sums[*other], own) > 0.0 ? sums[*other] : glm::dvec3(0.0);
        const double length = glm::length(sum);
        means[vertex] = length > 0.0 ? sum / length : glm::dvec3(0.0);
    }
    std::vector<glm::mat3> normals;
    for (const glm::uvec3& t : mesh.triangles)
        normals.emplace_back(means[t.x], means[t.y], means[t.z]);
    return normals;
}

// Unit, and on the side of the face: which way files count differs. Where there is none, the face's own.
void complete(TriangleSurface& mesh) {
    for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
        const glm::dvec3 face = across(mesh, i);
        const bool is_flat = glm::dot(face, face) == 0.0; // no ray meets it
        for (int corner = 0; corner < 3; ++corner) {
            glm::dvec3 normal = mesh.normals[i][corner];
            const double length = glm::length(normal);
            normal = length > 0.0 && length < std::numeric_limits<double>::infinity() ? normal / length : face;
            normal *= glm::dot(normal, face) < 0.0 ? -1.0 : 1.0;
            mesh.normals[i][corner] = is_flat ? glm::dvec3(0.0, 1.0, 0.0) : glm::normalize(normal);
        }
    }
}

void set_normals(TriangleSurface& mesh, MeshNormals which, const glm::dmat4& transform) {
    if (which == MeshNormals::flat)
        mesh.normals.clear();
    if (which == MeshNormals::smooth)
        mesh.normals = means_of_faces(mesh);
    if (which == MeshNormals::of_file) {
        const glm::dmat3 turned = glm::transpose(glm::inverse(glm::dmat3(transform)));
        for (glm::mat3& normals : mesh.normals)
            normals = turned * glm::dmat3(normals);
    }
    complete(mesh);
}

void load(const MeshSurface& mesh, Surface& surface, MeshFileReader& files, std::vector<std::string>& warnings) {
    MeshWarnings found;
    TriangleSurface loaded = load(mesh, surface.transform, MeshFileReader::is_closed(surface), files, found);
    set_normals(loaded, mesh.normals, surface.transform);
    if (is_textured(surface.material))
        warnings.insert(warnings.end(), found.of_places.begin(), found.of_places.end());
    if (mesh.normals == MeshNormals::of_file)
        warnings.insert(warnings.end(), found.of_normals.begin(), found.of_normals.end());
    if (is_textured(surface.material) && loaded.places.empty())
        throw InputError(fmt::format("{}: does not say where on a texture its corners are; export it with texture "
                                     "coordinates (UVs), of a .ply those of vertices, s and t",
                                     mesh.file.string()));
    surface.shape = std::move(loaded);
}

// One that the scene holds itself.
void finish(TriangleSurface& mesh, const Surface& surface) {
    if (surface.material.kind == MaterialKind::dielectric) {
        Polygons polygons;
        polygons.vertices = std::move(mesh.vertices);
        polygons.triangles = std::move(mesh.triangles);
        polygons.normals = std::move(mesh.normals);
        close_polygons(polygons, "<mesh>");
        mesh = {std::move(polygons.vertices), std::move(polygons.triangles), std::move(polygons.normals), {}, true};
    }
    if (is_textured(surface.material) && mesh.places.empty())
        throw InputError("<mesh> does not say where on a texture its corners are; add <places>");
    drop_loose_vertices(mesh.vertices, mesh.triangles);
    complete(mesh);
}

std::shared_ptr<const Texture> load_texture(const std::filesystem::path& file, std::vector<std::string>& warnings) {
    RadianceMap map = read_radiance_map(file);
    warnings.insert(warnings.end(), map.warnings.begin(), map.warnings.end());
    std::size_t brightest = 0, bright = 0;
    const auto most_of = [&](std::size_t i) { return std::max({map.texels[i].x, map.texels[i].y, map.texels[i].z}); };
    for (std::size_t i = 0; i < map.texels.size(); ++i) {
        bright += most_of(i) > 1.0f ? 1 : 0;
        brightest = most_of(i) > most_of(brightest) ? i : brightest;
    }
    if (bright > 0)
        warnings.push_back(fmt::format("{}: {} of its texels would scatter more light than they get, up to {:g} in one "
                                       "colour at column {}, row {}; they count as 1; scale the texture to 1 at most",
                                       file.string(), bright, most_of(brightest), brightest % std::size_t(map.width),
                                       brightest / std::size_t(map.width)));
    for (glm::vec3& texel : map.texels)
        texel = glm::min(texel, 1.0f);
    return std::make_shared<const Texture>(Texture{map.width, map.height, std::move(map.texels)});
}

// What scene and files say is within the limit, and no corner of a box about that farther away than those of a ball's
// of the largest radius at the largest coordinates, 2 sqrt(3) limits; what transforms make of it may be.
void check_lengths(const Surface& surface) {
    const std::optional<SurfaceBounds> bounds = bounds_of({&surface, 1});
    if (bounds && !(reach_of(*bounds, glm::dvec3(0.0)) <= 4.0 * largest_length))
        throw InputError(fmt::format("its <transform> takes it to {:.3g} from the origin; lengths and coordinates end "
                                     "at {:g}: choose a larger unit",
                                     reach_of(*bounds, glm::dvec3(0.0)), largest_length));
}

} // namespace

Scene with_surface_files(Scene scene) {
    std::map<std::filesystem::path, std::shared_ptr<const Texture>> textures;
    MeshFileReader files(scene.surfaces);
    for (Surface& surface : scene.surfaces) {
        Material& material = surface.material;
        try {
            if (const auto* found = std::get_if<MeshSurface>(&surface.shape))
                load(MeshSurface(*found), surface, files, scene.warnings);
            else if (auto* mesh = std::get_if<TriangleSurface>(&surface.shape); mesh && mesh->is_mesh)
                finish(*mesh, surface);
            if (!material.texture.empty() && !textures[material.texture])
                textures[material.texture] = load_texture(material.texture, scene.warnings);
            if (!material.texture.empty())
                material.image = textures[material.texture];
            check_lengths(surface);
        } catch (const InputError& error) { // of the file; the scene says who asked for it
            throw InputError(surface.place.empty() ? error.what() : fmt::format("{}: {}", surface.place, error.what()));
        }
    }
    return scene;
}

std::optional<SurfaceBounds> bounds_of(std::span<const Surface> surfaces) {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    SurfaceBounds bounds{glm::dvec3(infinite), glm::dvec3(-infinite)};
    const auto add = [&](const glm::dvec3& middle, double reach) {
        bounds.low = glm::min(bounds.low, middle - reach);
        bounds.high = glm::max(bounds.high, middle + reach);
    };
    for (const Surface& surface : surfaces) {
        if (const auto* ball = std::get_if<BallSurface>(&surface.shape))
            add(ball->center, ball->radius);
        if (const auto* disk = std::get_if<DiskSurface>(&surface.shape))
            add(disk->center, disk->radius);
        if (const auto* rectangle = std::get_if<RectangleSurface>(&surface.shape))
            for (const double sign : {-1.0, 1.0}) {
                add(rectangle->center + sign * (rectangle->edge_u + rectangle->edge_v), 0.0);
                add(rectangle->center + sign * (rectangle->edge_u - rectangle->edge_v), 0.0);
            }
        if (const auto* mesh = std::get_if<TriangleSurface>(&surface.shape))
            for (const glm::dvec3& vertex : mesh->vertices)
                add(vertex, 0.0);
    }
    return bounds.low.x <= bounds.high.x ? std::optional(bounds) : std::nullopt;
}

double reach_of(const SurfaceBounds& bounds, const glm::dvec3& origin) {
    return glm::length(glm::max(glm::abs(bounds.low - origin), glm::abs(bounds.high - origin)));
}

std::uint32_t pieces_of(std::span<const Surface> surfaces) {
    std::size_t pieces = 0;
    for (const Surface& surface : surfaces)
        if (const auto* mesh = std::get_if<TriangleSurface>(&surface.shape))
            pieces += mesh->triangles.size();
        else
            pieces += std::holds_alternative<RectangleSurface>(surface.shape) ? 2 : 1;
    return static_cast<std::uint32_t>(std::min<std::size_t>(pieces, 0xffffffffu));
}

double reach_of_surfaces(std::span<const Surface> surfaces, const glm::dvec3& origin) {
    for (const Surface& surface : surfaces)
        if (std::holds_alternative<PlaneSurface>(surface.shape))
            return std::numeric_limits<double>::infinity();
    const std::optional<SurfaceBounds> bounds = bounds_of(surfaces);
    return bounds ? reach_of(*bounds, origin) : 0.0;
}

} // namespace vkvol
