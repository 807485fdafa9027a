// The part of PbrtTranslator that writes surfaces.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "error.h"
#include "nearest_name.h"
#include "pbrt_quadrics.h"
#include "pbrt_translator.h"

namespace vkvol {

namespace {

using std::numbers::pi;
constexpr double least_alpha = 1e-3; // of facets; what is smoother is a mirror to pbrt, too
const glm::dvec3 luminance_of_rgb(0.2126, 0.7152, 0.0722);

double size_of(const glm::dmat4& map) {
    return std::cbrt(std::abs(glm::determinant(glm::dmat3(map))));
}

bool has_texture(const XmlAttributes& material) {
    return std::any_of(material.begin(), material.end(),
                       [](const auto& each) { return each.first == "texture" || each.first == "checker"; });
}

bool is_left_out(const std::string& material) {
    return material.empty() || material == "none" || material == "interface";
}

} // namespace

glm::dvec3 PbrtTranslator::share_of_light(const PbrtThing& thing, const glm::dvec3& color) {
    const glm::dvec3 share = glm::clamp(color, 0.0, 1.0);
    if (share != color)
        note(thing.place, fmt::format("a reflectance of {} is none of 0 to 1, and taken for {}", xml_numbers(color),
                                      xml_numbers(share)));
    return share;
}

void PbrtTranslator::add_color(XmlAttributes& attributes, const PbrtThing& thing, const char* name,
                               const glm::dvec3& fallback) {
    if (thing.parameters->texture(name).empty())
        add_rgb(attributes, share_of_light(thing, colors_.share(thing, name).value_or(fallback)));
    else
        add_texture(attributes, texture_of(thing, name), glm::dvec3(1.0), 0);
}

// pbrt's GGX is along two axes, and its roughness the root of alpha unless told otherwise.
void PbrtTranslator::add_roughness(XmlAttributes& attributes, const PbrtThing& thing, const std::string& part) {
    const PbrtParameters& p = *thing.parameters;
    for (const char* name : {"roughness", "uroughness", "vroughness"})
        if (!p.texture(part + name).empty()) {
            note(p.find(part + name)->place, "a texture of roughness is left out; the surface is smooth");
            return;
        }
    const double both = p.number(part + "roughness", 0.0);
    double u = p.number(part + "uroughness", both), v = p.number(part + "vroughness", both);
    if (p.truth("remaproughness", true)) {
        u = std::sqrt(std::max(u, 0.0));
        v = std::sqrt(std::max(v, 0.0));
    }
    if (u != v)
        note(thing.place, "its roughness is the same along both axes, their mean");
    if (u + v > 2.0)
        note(thing.place, fmt::format("its roughness, alpha = {:.3g}, is 1 here, which is the most", 0.5 * (u + v)));
    const double alpha = std::min(0.5 * (u + v), 1.0);
    if (alpha >= least_alpha)
        attributes.emplace_back("roughness", xml_number(alpha));
}

// Index of refraction, the mean of the channels, from `least` to the most that scene files take. One beyond these is
// clamped, and a texture taken for 1.5, with a note.
double PbrtTranslator::index_of(const PbrtThing& thing, double least) {
    constexpr double most = 20.0;
    const glm::dvec3 eta = even_part(thing, "eta", 1.5, 0).value_or(glm::dvec3(0.0));
    const double index = (eta.x + eta.y + eta.z) / 3.0;
    if (index >= least && index <= most)
        return index;
    const double instead = index > 0.0 ? std::clamp(index, least, most) : 1.5;
    note(thing.place, fmt::format("its index of refraction is {:g} here", instead));
    return instead;
}

// By eta and k, or by what it reflects at normal incidence.
void PbrtTranslator::add_conductor(XmlAttributes& attributes, const PbrtThing& thing) {
    const PbrtParameters& p = *thing.parameters;
    const bool is_coated = thing.type == "coatedconductor";
    const auto part = [&](const char* own, const char* coated, const char* fallback, double least, double most) {
        const char* name = is_coated ? coated : own;
        const glm::dvec3 usual = *named_share(fallback);
        const std::optional<glm::dvec3> value = p.has(name) ? even_part(thing, name, 1.0, 0) : usual;
        const glm::dvec3 taken = glm::clamp(value.value_or(usual), least, most);
        if (!value || taken != *value)
            note(thing.place, fmt::format("its \"{}\" is {} here", name, xml_numbers(taken)));
        return taken;
    };
    glm::dvec3 eta = part("eta", "conductor.eta", "metal-Cu-eta", 0.05, 20.0),
               k = part("k", "conductor.k", "metal-Cu-k", 0.0, 100.0);
    if (p.has("reflectance")) {
        const std::optional<glm::dvec3> reflected = even_part(thing, "reflectance", 1.0, 0);
        if (!reflected)
            note(thing.place, "the texture of its reflectance is left out; it reflects a half");
        const glm::dvec3 share = glm::clamp(reflected.value_or(glm::dvec3(0.5)), 0.0, 0.9996); // k is 100 then
        eta = glm::dvec3(1.0);
        k = 2.0 * glm::sqrt(share / (1.0 - share));
    }
    attributes.emplace_back("eta", xml_numbers(eta));
    attributes.emplace_back("k", xml_numbers(k));
    add_roughness(attributes, thing, is_coated ? "conductor." : "");
    if (is_coated) {
        note(thing.place, "has no coat here; it is a conductor");
        for (const char* name : {"interface.eta", "interface.roughness", "interface.uroughness", "interface.vroughness",
                                 "thickness", "albedo", "g"})
            p.find(name);
    }
}

XmlAttributes PbrtTranslator::material(const PbrtThing& thing) {
    const PbrtParameters& p = *thing.parameters;
    XmlAttributes attributes;
    constexpr double thinnest = 0.05; // as scene files have indices
    if (thing.type == "diffuse" || thing.type == "diffusetransmission") {
        add_color(attributes, thing, "reflectance", glm::dvec3(thing.type == "diffuse" ? 0.5 : 0.25));
        if (thing.type == "diffusetransmission")
            note(thing.place, "lets no light through here; it is matte");
    } else if (thing.type == "coateddiffuse") {
        const auto is_rough = [&](const char* name) { return !p.texture(name).empty() || p.number(name, 0.0) > 0.0; };
        attributes.emplace_back("material", "coated");
        add_color(attributes, thing, "reflectance", glm::dvec3(0.5));
        attributes.emplace_back("ior", xml_number(index_of(thing, 1.0)));
        if (is_rough("roughness") || is_rough("uroughness") || is_rough("vroughness") || p.has("albedo"))
            note(thing.place, "its coat is smooth and clear here");
    } else if (thing.type == "conductor" || thing.type == "coatedconductor") {
        attributes.emplace_back("material", "conductor");
        add_conductor(attributes, thing);
    } else if (thing.type == "dielectric") {
        const double index = index_of(thing, thinnest);
        attributes.emplace_back("material", "dielectric");
        attributes.emplace_back("ior", xml_number(index));
        // Else it bends next to nothing, turned inside out or not, and scene files take no roughness of it.
        if (std::min(std::abs(index - 1.0), std::abs(1.0 / index - 1.0)) >= 0.01)
            add_roughness(attributes, thing);
    } else if (thing.type == "thindielectric") {
        attributes.emplace_back("material", "thinDielectric");
        attributes.emplace_back("ior", xml_number(index_of(thing, thinnest)));
    } else {
        note(thing.place, fmt::format("Material \"{}\" is left out; what has it is grey and matte", thing.type));
        return {};
    }
    note_unused(thing, {"type", "maxdepth", "nsamples"});
    return attributes;
}

const PbrtThing& PbrtTranslator::material_thing(const PbrtShape& shape) const {
    const PbrtThing& thing = shape.material.thing;
    if (!shape.material.is_named)
        return thing;
    const auto named = scene_.materials.find(thing.type);
    if (named != scene_.materials.end())
        return named->second;
    std::vector<std::string> known;
    for (const auto& [name, unused] : scene_.materials)
        known.push_back(name);
    fail_at(thing.place, fmt::format("no material \"{}\"{}", thing.type,
                                     known.empty() ? "; MakeNamedMaterial makes one" : name_hint(thing.type, known)));
}

std::optional<XmlAttributes> PbrtTranslator::material_of(const PbrtShape& shape) {
    const PbrtThing& thing = material_thing(shape);
    texture_.reset();
    if (is_left_out(thing.type))
        return std::nullopt;
    return material(thing);
}

// `area`: of the whole shape, where it is known.
void PbrtTranslator::write_emission(const PbrtShape& shape, std::optional<double> area) {
    if (!shape.light)
        return;
    const PbrtThing& light = *shape.light;
    const PbrtParameters& p = *light.parameters;
    glm::dvec3 radiance = light_color(light, "L");
    if (!p.text("filename").empty()) {
        try {
            radiance *= mean_of_image(light);
            note(light.place, "an image that shines does so evenly here, as its mean");
        } catch (const InputError& error) {
            note(light.place, fmt::format("an image that shines does so evenly here, as white: {}", error.what()));
        }
        if (const double luminance = glm::dot(radiance, luminance_of_rgb) / (p.number("scale", 1.0) * exposure_);
            p.number("power", -1.0) > 0.0 && luminance > 0.0)
            radiance /= luminance; // "power" is of that
    }
    const bool is_two_sided = p.truth("twosided", false);
    if (const double power = p.number("power", -1.0); power > 0.0 && area)
        radiance *= power / ((is_two_sided ? 2.0 : 1.0) * *area * pi);
    else if (power > 0.0)
        note(light.place, "\"power\" of a mesh in a file is left out");
    note_unused(light);
    XmlAttributes attributes;
    add_rgb(attributes, radiance);
    if (is_two_sided)
        attributes.emplace_back("sides", "2");
    xml_.element("emission", attributes, "", light.place.text());
}

void PbrtTranslator::write_ball(const PbrtShape& shape, const XmlAttributes& material) {
    const PbrtParameters& p = *shape.thing.parameters;
    // A texture's poles are at z, and it begins at x; here at y, with its middle at z.
    const glm::dmat4 as_globe(0, -1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 0, 0, 0, 0, 1);
    const double radius = p.number("radius", 1.0);
    XmlAttributes attributes = {{"radius", xml_number(radius)}};
    attributes.insert(attributes.end(), material.begin(), material.end());
    xml_.open("sphere", attributes, shape.thing.place.text());
    write_matrix(world_ * shape.thing.transform * as_globe);
    const double size = size_of(shape.thing.transform) * radius;
    write_emission(shape, 4.0 * pi * size * size);
    xml_.close();
}

void PbrtTranslator::write_disk(const PbrtShape& shape, const XmlAttributes& material) {
    const PbrtParameters& p = *shape.thing.parameters;
    const double radius = p.number("radius", 1.0), height = p.number("height", 0.0);
    const double side = faces_inwards(shape) ? -1.0 : 1.0;
    XmlAttributes attributes = {
        {"z", xml_number(height)}, {"lookAt", xml_numbers({0.0, 0.0, height + side})}, {"radius", xml_number(radius)}};
    attributes.insert(attributes.end(), material.begin(), material.end());
    xml_.open("disk", attributes, shape.thing.place.text());
    write_matrix(world_ * shape.thing.transform);
    const double size = size_of(shape.thing.transform) * radius;
    write_emission(shape, pi * size * size);
    xml_.close();
}

void PbrtTranslator::write_file_mesh(const PbrtShape& shape, const XmlAttributes& material) {
    XmlAttributes attributes = {{"file", file_name(shape.thing)}};
    attributes.insert(attributes.end(), material.begin(), material.end());
    if (shape.is_reversed && (shape.light || !material.empty()))
        note(shape.thing.place, "a mesh in a file has its front where its file says, whatever ReverseOrientation");
    xml_.open("mesh", attributes, shape.thing.place.text());
    write_matrix(world_ * shape.thing.transform);
    write_emission(shape, std::nullopt);
    xml_.close();
}

// `own`: in the shape's own space.
void PbrtTranslator::write_triangles(const PbrtShape& shape, const PbrtTriangles& own, const XmlAttributes& material) {
    constexpr std::size_t most = 20'000'000;
    triangle_count_ += own.triangles.size();
    if (triangle_count_ > most)
        fail_at(shape.thing.place,
                fmt::format("with this {} there are more than {} triangles, the most that are written: put meshes into "
                            "files (plymesh), and let spheres, cylinders and disks be round and whole",
                            shape.thing.type, most));
    PbrtTriangles mesh = moved(world_ * shape.thing.transform, own, shape.is_reversed);
    if (!has_texture(material))
        mesh.places.clear();
    if (has_normals_of_faces(mesh)) // on whose sides they have their fronts by now
        mesh.normals.clear();
    const std::string place = shape.thing.place.text();
    const std::optional<PbrtRectangle> rectangle = mesh.places.empty() ? as_rectangle(mesh) : std::nullopt;
    if (rectangle) {
        XmlAttributes attributes;
        add_xyz(attributes, rectangle->center);
        const glm::dvec3 normal = glm::normalize(glm::cross(rectangle->edge_u, rectangle->edge_v));
        attributes.emplace_back("lookAt", xml_numbers(rectangle->center + normal * glm::length(rectangle->edge_v)));
        attributes.emplace_back("up", xml_numbers(rectangle->edge_v));
        attributes.emplace_back("width", xml_number(glm::length(rectangle->edge_u)));
        attributes.emplace_back("height", xml_number(glm::length(rectangle->edge_v)));
        attributes.insert(attributes.end(), material.begin(), material.end());
        xml_.open("rectangle", attributes, place);
    } else {
        xml_.open("mesh", material, place);
        const auto numbers = [&](const char* name, const auto& rows) {
            std::string text;
            for (const auto& row : rows)
                for (int i = 0; i < row.length(); ++i)
                    text += fmt::format("{}{}", text.empty() ? "" : " ", row[i]);
            if (!rows.empty())
                xml_.element(name, {}, text);
        };
        numbers("vertices", mesh.points);
        numbers("normals", mesh.normals);
        numbers("places", mesh.places);
        numbers("triangles", mesh.triangles);
    }
    // Triangles to which pbrt gives the power of a light: a quadric is one shape there.
    const int all = int(mesh.triangles.size());
    const int each = shape.thing.type == "trianglemesh" ? 1 : shape.thing.type == "bilinearmesh" ? 2 : all;
    const double area = mesh.area() * each / all;
    if (shape.light && shape.light->parameters->has("power") && !mesh.is_even(each))
        note(shape.light->place, "each of the mesh's pieces has the light of one of mean size");
    write_emission(shape, area);
    xml_.close();
}

namespace {

// Glass whose normals point inwards has its inside around it, as pbrt sees it: a bubble.
void turn_inside_out(XmlAttributes& glass) {
    for (auto& [name, value] : glass)
        if (name == "ior")
            value = xml_number(1.0 / xml_value(value));
}

bool is_glass(const XmlAttributes& material) {
    return std::any_of(material.begin(), material.end(),
                       [](const auto& attribute) { return attribute.second == "dielectric"; });
}

} // namespace

bool PbrtTranslator::is_unseen(const PbrtShape& shape) {
    const PbrtParameters& p = *shape.thing.parameters;
    if (is_never_met(shape) && !shape.light)
        return true;
    if (is_never_met(shape))
        note(shape.thing.place, "\"alpha\" is left out; the light that pbrt does not show is seen, and opaque");
    else if (!p.texture("alpha").empty() || p.number("alpha", 1.0) < 1.0)
        note(shape.thing.place, "\"alpha\" is left out; it is opaque");
    return false;
}

void PbrtTranslator::note_odd_lists(const PbrtThing& mesh) {
    const PbrtParameters& p = *mesh.parameters;
    const std::size_t points = p.points("P").size();
    const auto look = [&](const char* name, std::size_t count) {
        if (count != 0 && count != points)
            note(p.find(name)->place,
                 fmt::format("\"{}\": {} of them for {} points are left out", name, count, points));
    };
    look("N", p.points("N").size());
    look("uv", p.pairs("uv").size());
    const std::size_t corners = mesh.type == "bilinearmesh" ? 4 : 3, indices = p.numbers("indices").size();
    if (indices > corners && indices % corners != 0)
        note(p.find("indices")->place, fmt::format("the last {} of \"indices\" are left out", indices % corners));
}

void PbrtTranslator::write_surface(const PbrtShape& shape) {
    std::optional<XmlAttributes> material = material_of(shape);
    if (!material) {
        if (shape.light)
            note(shape.thing.place,
                 "shines, but is an interface between media: pbrt leaves that light out, and so does "
                 "this");
        if (const PbrtParameters& p = *shape.thing.parameters;
            !is_never_met(shape) && (!p.texture("alpha").empty() || p.number("alpha", 1.0) < 1.0))
            note(shape.thing.place, "\"alpha\" is left out; it bounds its media everywhere");
        return;
    }
    const PbrtThing& thing = shape.thing;
    if (is_unseen(shape))
        return;
    PbrtShape turned = shape; // as its triangles would be
    if (thing.type == "sphere" || thing.type == "cylinder" || thing.type == "disk")
        turned.is_reversed = faces_inwards(shape);
    if (is_glass(*material) && thing.type != "disk" && thing.type != "plymesh" && faces_inwards(shape))
        turn_inside_out(*material);
    const bool shines_inwards = thing.type == "sphere" && turned.is_reversed && shape.light;
    const bool is_polar = thing.type == "disk" && has_texture(*material); // there
    const bool is_quadric = thing.type == "sphere" || thing.type == "disk" || thing.type == "cylinder";
    const bool is_mesh = thing.type == "trianglemesh" || thing.type == "bilinearmesh";
    if (!is_mesh)
        note_places(*material);
    if (thing.type == "plymesh") {
        even_out(shape, *material);
        write_file_mesh(shape, *material);
    } else if (is_mesh) {
        note_odd_lists(thing);
        const PbrtTriangles mesh = with_places_of_texture(thing, read_triangles(thing), *material);
        write_triangles(shape, mesh, *material);
    } else if (is_quadric && (shines_inwards || is_polar || !is_whole_ball_or_disk(thing, thing.transform))) {
        const PbrtTriangles mesh = quadric_triangles(thing);
        note(thing.place, fmt::format("this {} is {} triangles here", thing.type, mesh.triangles.size()));
        write_triangles(turned, mesh, *material);
    } else if (is_quadric) {
        thing.type == "sphere" ? write_ball(shape, *material) : write_disk(shape, *material);
    } else {
        note(thing.place, fmt::format("Shape \"{}\" is left out", thing.type));
    }
    note_unused(thing, {"S", "faceIndices", "shadowalpha", "zmin", "zmax", "phimax", "innerradius"});
}

void PbrtTranslator::write_surfaces() {
    xml_.open("surfaces");
    for (const PbrtShape& shape : scene_.shapes)
        write_surface(shape);
    xml_.close();
}

} // namespace vkvol
