// The part of SceneReader that reads <surfaces>.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "nearest_name.h"
#include "scene_places.h"
#include "scene_reader.h"

namespace vkvol {

namespace {

const std::vector<std::string> shapes = {"sphere", "disk", "rectangle", "box", "plane", "mesh"};
constexpr Limits share{0.0, 1.0, true, true, "a number from 0 to 1"};
constexpr Limits index_limits{0.05, 20.0, true, true, "an index of refraction from 0.05 to 20"};
constexpr Limits rough{0.0, 1.0, true, true, "a number from 0 to 1"};
constexpr Limits repeats{0.0, 1e6, false, true, "a number above 0, of at most a million"};
constexpr Limits absorbing{0.0, 100.0, true, true, "a number from 0 to 100"};

const std::vector<std::string> of_materials = {"material", "r", "g",         "b",       "multiplier", "ior",    "metal",
                                               "eta",      "k", "roughness", "texture", "repeat",     "checker"};

std::vector<std::string> with_material(std::vector<std::string> attributes) {
    attributes.insert(attributes.end(), of_materials.begin(), of_materials.end());
    return attributes;
}

// Complex indices in the three channels, of measured spectra (Johnson and Christy 1972; of aluminium Rakic 1995).
struct Metal {
    const char* name;
    Rgb eta, k;
};
const Metal metals[] = {{"aluminium", {1.657, 0.880, 0.521}, {9.224, 6.270, 4.837}},
                        {"copper", {0.200, 0.924, 1.102}, {3.912, 2.452, 2.142}},
                        {"gold", {0.143, 0.375, 1.442}, {3.983, 2.386, 1.603}},
                        {"silver", {0.155, 0.117, 0.138}, {4.828, 3.122, 2.147}}};

Rgb three(const XmlElement& element, const char* attribute, const Limits& limits) {
    const std::vector<double> numbers = element.attribute_numbers(attribute, limits);
    if (numbers.size() != 1 && numbers.size() != 3)
        element.fail_attribute(attribute,
                               fmt::format("<{}> {}: {} numbers; expected one, or three for red, green, blue",
                                           element.name(), attribute, numbers.size()));
    return numbers.size() == 1 ? Rgb(numbers[0]) : Rgb(numbers[0], numbers[1], numbers[2]);
}

void read_metal(const XmlElement& element, Material& material) {
    const bool has_eta = element.has("eta"), has_k = element.has("k");
    if (has_eta != has_k)
        element.fail_attribute(has_eta ? "eta" : "k",
                               fmt::format("<{}> has {} without {}; a conductor is described by both, or by metal=",
                                           element.name(), has_eta ? "eta" : "k", has_eta ? "k" : "eta"));
    if (has_eta && element.has("metal"))
        element.fail_attribute(
            "metal", fmt::format("<{}> has eta and k, and is of no metal besides; remove it, or them", element.name()));
    if (has_eta) {
        material.eta = three(element, "eta", index_limits);
        material.k = three(element, "k", absorbing);
        return;
    }
    const std::string name = element.attribute("metal", "aluminium");
    const auto* metal =
        std::find_if(std::begin(metals), std::end(metals), [&](const Metal& m) { return name == m.name; });
    if (metal == std::end(metals))
        element.fail_attribute(
            "metal", fmt::format("<{}> metal: '{}' is unknown{}; others are described by eta=\"r g b\" and "
                                 "k=\"r g b\"",
                                 element.name(), name, name_hint(name, {"aluminium", "copper", "gold", "silver"})));
    material.eta = metal->eta;
    material.k = metal->k;
}

MeshNormals mesh_normals(const XmlElement& element) {
    const std::string name = element.attribute("normals", "file");
    if (name == "file")
        return MeshNormals::of_file;
    if (name == "flat")
        return MeshNormals::flat;
    if (name != "smooth")
        element.fail_attribute("normals", fmt::format("<mesh> normals: '{}' is unknown{}", name,
                                                      name_hint(name, {"file", "flat", "smooth"})));
    return MeshNormals::smooth;
}

// One whose vertices stand in the scene.
void check_mesh_of_numbers(const XmlElement& element) {
    if (element.has("file"))
        element.fail("<mesh> names a file and has <vertices>; leave out one of them");
    if (element.has("normals"))
        element.fail_attribute("normals",
                               "<mesh> normals: is for those of a file; beside <vertices> each has its own in "
                               "<normals>, without which faces are flat");
    std::vector<std::string> attributes;
    if (element.has("texture"))
        attributes = {"baseDir"};
    element.allow(with_material(std::move(attributes)), false,
                  {"transform", "emission", "vertices", "normals", "places", "triangles"});
}

glm::dvec3 moved(const glm::dmat4& map, const glm::dvec3& point) {
    return glm::dvec3(map * glm::dvec4(point, 1.0));
}

// The factor by which `map` enlarges what must stay round, or flat across its normal.
double scale_of(const XmlElement& element, const glm::dmat4& map) {
    const glm::dmat3 m(map);
    const double scale = std::cbrt(std::abs(glm::determinant(m)));
    const glm::dmat3 square = glm::transpose(m) * m;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            if (std::abs(square[column][row] - (column == row ? scale * scale : 0.0)) >
                stretch_of_digits * scale * scale)
                element.fail(fmt::format("<{}> transform: stretches it along one axis, or shears it, and it would not "
                                         "stay what it is; use a mesh",
                                         element.name()));
    return scale;
}

TriangleSurface moved(const glm::dmat4& map, TriangleSurface shape) {
    for (glm::dvec3& vertex : shape.vertices)
        vertex = moved(map, vertex);
    const glm::dmat3 of_normals = glm::transpose(glm::inverse(glm::dmat3(map)));
    for (glm::mat3& normals : shape.normals)
        for (int corner = 0; corner < 3; ++corner)
            normals[corner] = glm::vec3(of_normals * glm::dvec3(normals[corner]));
    if (glm::determinant(glm::dmat3(map)) < 0.0)
        shape.turn_about();
    return shape;
}

// A mirror leaves its front where the mirrored front is; sheared it is a parallelogram, of triangles.
// `shows`: what goes along with a mirror, a texture, so that it has to be of triangles.
SurfaceShape moved(const glm::dmat4& map, const Rectangle& r, bool shows) {
    const glm::dmat3 linear(map);
    const double turn = glm::determinant(linear) < 0.0 ? -1.0 : 1.0;
    if (shows && turn < 0.0)
        return moved(map, RectangleSurface{r.center, r.edge_u, r.edge_v}.triangles());
    const glm::dvec3 center = moved(map, r.center), u = turn * (linear * r.edge_u), v = linear * r.edge_v;
    if (std::abs(glm::dot(u, v)) > stretch_of_digits * glm::length(u) * glm::length(v))
        return RectangleSurface{center, u, v}.triangles();
    return RectangleSurface{center, u, v - u * (glm::dot(u, v) / glm::dot(u, u))};
}

TriangleSurface box_of(const Box& box) {
    TriangleSurface shape;
    for (int corner = 0; corner < 8; ++corner)
        shape.vertices.push_back(box.center + box.size * (glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2) - 0.5));
    shape.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                       {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    // Each face shows the whole texture, upright, or above and below with its top at the back and at the front.
    constexpr int first_place[] = {1, 0, 0, 3, 0, 1}; // of a face's first corner, among a square's counterclockwise
    const glm::vec2 square[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (const int first : first_place)
        for (const int second : {1, 2})
            shape.places.emplace_back(square[first], square[(first + second) % 4], square[(first + second + 1) % 4]);
    return shape;
}

struct MaterialChoice {
    const char* name;
    MaterialKind kind;
    double color; // unless another is asked for
};
constexpr MaterialChoice material_choices[] = {
    {"diffuse", MaterialKind::diffuse, 0.5},     {"mirror", MaterialKind::mirror, 1.0},
    {"conductor", MaterialKind::conductor, 1.0}, {"dielectric", MaterialKind::dielectric, 1.0},
    {"coated", MaterialKind::coated, 0.5},       {"thinDielectric", MaterialKind::thin_dielectric, 1.0}};

const MaterialChoice& material_choice(const XmlElement& element) {
    const std::string name = element.attribute("material", "diffuse");
    std::vector<std::string> names;
    for (const MaterialChoice& choice : material_choices) {
        if (name == choice.name)
            return choice;
        names.emplace_back(choice.name);
    }
    element.fail_attribute(
        "material", fmt::format("<{}> material: '{}' is unknown{}", element.name(), name, name_hint(name, names)));
}

} // namespace

Material SceneReader::material(const XmlElement& element) const {
    const MaterialChoice& choice = material_choice(element);
    Material material;
    material.kind = choice.kind;
    const bool colored = element.has("r") || element.has("g") || element.has("b");
    const double usual = element.has("texture") ? 1.0 : choice.color;
    material.color = colored ? color(element) : Rgb(usual * element.attribute_number("multiplier", 1.0, not_negative));
    for (int i = 0; i < 3; ++i)
        if (material.color[i] > share.high)
            element.fail(
                fmt::format("<{}> scatters {:g} of the light in one colour, more than it gets; lower r, g, b or "
                            "multiplier to 1 at most",
                            element.name(), material.color[i]));
    const auto only = [&](const char* attribute, std::initializer_list<MaterialKind> kinds, const char* names) {
        if (element.has(attribute) && std::find(kinds.begin(), kinds.end(), material.kind) == kinds.end())
            element.fail_attribute(attribute, fmt::format("<{}> {}: has a meaning with material=\"{}\" only",
                                                          element.name(), attribute, names));
    };
    only("ior", {MaterialKind::dielectric, MaterialKind::coated, MaterialKind::thin_dielectric},
         "dielectric\", \"coated\" or \"thinDielectric");
    for (const char* attribute : {"metal", "eta", "k"})
        only(attribute, {MaterialKind::conductor}, "conductor");
    only("roughness", {MaterialKind::conductor, MaterialKind::dielectric}, "conductor\" or \"dielectric");
    for (const char* attribute : {"texture", "checker"})
        only(attribute, {MaterialKind::diffuse, MaterialKind::mirror, MaterialKind::conductor, MaterialKind::coated},
             "diffuse\", \"mirror\", \"conductor\" or \"coated");
    read_texture(element, material);
    material.ior = element.attribute_number("ior", material.ior, index_limits);
    if (material.kind == MaterialKind::coated && material.ior < 1.0)
        element.fail_attribute(
            "ior", fmt::format("<{}> ior: a coat is denser than what is around it; 1 at least", element.name()));
    if (material.kind == MaterialKind::conductor)
        read_metal(element, material);
    material.roughness = element.attribute_number("roughness", 0.0, rough);
    if (document_.later() != 0.0 && material.roughness < least_roughness) // on its way from 0, or to it
        material.roughness = material.roughness < 0.5 * least_roughness ? 0.0 : least_roughness;
    if (material.roughness > 0.0 && material.roughness < least_roughness)
        element.fail_attribute("roughness", fmt::format("<{}> roughness: {:g} is too little to tell from 0, which is "
                                                        "smooth; {:g} at least",
                                                        element.name(), material.roughness, least_roughness));
    if (material.roughness > 0.0 && std::abs(material.ior - 1.0) < 0.01)
        element.fail_attribute("ior", fmt::format("<{}> ior: glass of {:g} bends next to nothing, and its roughness "
                                                  "shows nothing; leave roughness out, or the surface",
                                                  element.name(), material.ior));
    return material;
}

void SceneReader::read_texture(const XmlElement& element, Material& material) const {
    const bool is_checkered = element.has("checker");
    if (element.has("repeat") && !element.has("texture") && !is_checkered)
        element.fail_attribute(
            "repeat", fmt::format("<{}> repeat: has a meaning with texture=\"image.png\" or checker=\"0.1\" only",
                                  element.name()));
    if (element.has("texture") && is_checkered)
        element.fail_attribute("checker", fmt::format("<{}> has a texture; leave that or checker out", element.name()));
    if (!element.has("texture") && !is_checkered)
        return;
    if (is_checkered) {
        const glm::vec3 own = material.color, other = three(element, "checker", share);
        material.image = std::make_shared<const Texture>(Texture{2, 2, {other, own, own, other}, true});
        material.color = Rgb(1.0);
    } else if (element.attribute("texture").empty()) {
        element.fail_attribute(
            "texture",
            fmt::format("<{}> texture: names no file; write one, e.g. texture=\"wood.png\"", element.name()));
    } else {
        material.texture = file_path(element, element.attribute("texture"));
    }
    const std::vector<double> times = element.attribute_numbers("repeat", repeats);
    if (times.empty() && element.has("repeat"))
        element.fail_attribute("repeat",
                               fmt::format("<{}> repeat: is empty; expected one number, or two for across and "
                                           "upwards",
                                           element.name()));
    if (times.size() > 2)
        element.fail_attribute("repeat", fmt::format("<{}> repeat: {} numbers; expected one, or two for across and "
                                                     "upwards",
                                                     element.name(), times.size()));
    if (!times.empty())
        material.repeat = {times.front(), times.back()};
}

// By the numbers of <vertices>, <triangles>, and, for each vertex, <normals> and <places> on a texture.
TriangleSurface SceneReader::triangles() const {
    const auto numbers = [&](const char* name, std::size_t each, const Limits& limits) {
        const XmlElement element = one(name);
        element.allow({}, true);
        std::vector<double> values = element.text_numbers(limits);
        if (values.size() % each != 0 || (values.empty() && element.exists()))
            element.fail_text(fmt::format("<{}> has {} numbers; expected {} for each", name, values.size(), each));
        return values;
    };
    const std::vector<double> points = numbers("vertices", 3, coordinate),
                              corners = numbers("triangles", 3, not_negative);
    const std::vector<double> normals = numbers("normals", 3, any_number), places = numbers("places", 2, any_number);
    const std::size_t count = points.size() / 3;
    for (const auto& [name, size] : {std::pair("normals", normals.size() / 3), std::pair("places", places.size() / 2)})
        if (size != 0 && size != count)
            one(name).fail_text(fmt::format("<{}> is for {} vertices, of {}; expected as many", name, size, count));
    TriangleSurface shape;
    shape.is_mesh = true;
    for (std::size_t i = 0; i < count; ++i)
        shape.vertices.emplace_back(points[3 * i], points[3 * i + 1], points[3 * i + 2]);
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        glm::uvec3 triangle;
        glm::mat3 normal;
        glm::mat3x2 place;
        for (int k = 0; k < 3; ++k) {
            const double vertex = corners[i + std::size_t(k)];
            if (vertex != std::floor(vertex) || vertex >= double(count))
                one("triangles")
                    .fail_text(
                        fmt::format("<triangles>: {:g} is none of the {} vertices, which count from 0", vertex, count));
            const auto v = static_cast<std::size_t>(vertex);
            triangle[k] = static_cast<unsigned>(v);
            if (!normals.empty())
                normal[k] = glm::vec3(normals[3 * v], normals[3 * v + 1], normals[3 * v + 2]);
            if (!places.empty())
                place[k] = glm::vec2(places[2 * v], places[2 * v + 1]);
        }
        shape.triangles.push_back(triangle);
        if (!normals.empty())
            shape.normals.push_back(normal);
        if (!places.empty())
            shape.places.push_back(place);
    }
    if (shape.triangles.empty())
        one("vertices").fail("<vertices> has no <triangles> beside it; expected three vertices for each, from 0");
    return shape;
}

// Within its own scope.
Surface SceneReader::surface(const XmlElement& element) const {
    Surface surface;
    surface.place = element.place();
    const std::string kind = element.name();
    const std::vector<std::string> inner = {"transform", "emission"};
    const glm::dmat4 map = transform();
    const auto allow = [&](std::vector<std::string> attributes) {
        element.allow(with_material(std::move(attributes)), false, inner);
    };
    if (kind == "sphere") {
        allow({"x", "y", "z", "radius"});
        surface.shape = BallSurface{moved(map, xyz(element, coordinate)),
                                    element.attribute_number("radius", 1.0, length) * scale_of(element, map)};
        surface.axes = glm::dmat3(map) / scale_of(element, map);
    } else if (kind == "disk") {
        allow({"x", "y", "z", "lookAt", "up", "radius"});
        const glm::dvec3 center = xyz(element, coordinate), normal = looking_at(element, center);
        surface.shape = DiskSurface{moved(map, center), vkvol::unit(glm::dmat3(map) * normal),
                                    element.attribute_number("radius", 1.0, length) * scale_of(element, map)};
        surface.axes = glm::dmat3(map) * axes_facing(element, normal) / scale_of(element, map);
    } else if (kind == "plane") {
        allow({"x", "y", "z", "lookAt", "up"});
        const glm::dvec3 point = xyz(element, coordinate);
        const glm::dvec3 normal = element.has("lookAt") ? looking_at(element, point) : glm::dvec3(0.0, 1.0, 0.0);
        surface.shape = PlaneSurface{moved(map, point), vkvol::unit(glm::dmat3(map) * normal)};
        surface.axes = glm::dmat3(map) * axes_facing(element, normal) / scale_of(element, map);
    } else if (kind == "rectangle") {
        allow({"x", "y", "z", "lookAt", "up", "width", "height"});
        surface.shape = moved(map, rectangle(element), element.has("texture") || element.has("checker"));
    } else if (kind == "box") {
        allow({"x", "y", "z", "width", "height", "depth"});
        const auto edge = [&](const char* name) { return element.attribute_number(name, 1.0, length); };
        surface.shape = moved(map, box_of({xyz(element, coordinate), {edge("width"), edge("height"), edge("depth")}}));
    } else if (kind == "mesh" && one("vertices").exists()) {
        check_mesh_of_numbers(element);
        surface.shape = moved(map, triangles());
    } else {
        allow({"file", "baseDir", "normals"});
        if (element.attribute("file").empty())
            element.fail("<mesh> names no file; write one, e.g. file=\"bunny.obj\", or <vertices> and <triangles>");
        surface.shape = MeshSurface{file_path(element, element.attribute("file")), mesh_normals(element)};
        surface.transform = map;
    }
    surface.material = material(element);
    if (kind == "plane") // tiles are a unit of what the transform is of
        surface.material.repeat /= scale_of(element, map);
    const XmlElement emission = one("emission");
    emission.allow({"r", "g", "b", "kelvin", "multiplier", "sides"});
    if (emission.exists())
        surface.emission = light_color(emission);
    surface.shines_both_ways = emission.attribute_integer("sides", 1, 1, 2) == 2;
    return surface;
}

void SceneReader::read_surfaces(Scene& scene) {
    one("surfaces").allow({}, false, shapes);
    const pugi::xml_node root = document_.root();
    for (const pugi::xml_node node : root.child("surfaces").children()) {
        if (node.type() != pugi::node_element)
            continue;
        scopes_ = {node};
        const XmlElement element(document_, node);
        scene.surfaces.push_back(surface(element));
        scopes_ = {root};
    }
}

} // namespace vkvol
