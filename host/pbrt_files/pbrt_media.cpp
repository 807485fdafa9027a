// The part of PbrtTranslator that writes media.
#include <algorithm>
#include <fmt/format.h>

#include "density_field.h"
#include "error.h"
#include "nearest_name.h"
#include "pbrt_translator.h"

namespace vkvol {

namespace {

// Jensen, Marschner, Levoy, Hanrahan, "A Practical Model for Subsurface Light Transport", 2001, figure 5 [1 / mm].
struct Preset {
    const char* name;
    glm::dvec3 sigma_s, sigma_a;
};
const Preset presets[] = {
    {"Apple", {2.29, 2.39, 1.97}, {0.0030, 0.0034, 0.046}}, {"Chicken1", {0.15, 0.21, 0.38}, {0.015, 0.077, 0.19}},
    {"Chicken2", {0.19, 0.25, 0.32}, {0.018, 0.088, 0.20}}, {"Cream", {7.38, 5.47, 3.15}, {0.0002, 0.0028, 0.0163}},
    {"Ketchup", {0.18, 0.07, 0.03}, {0.061, 0.97, 1.45}},   {"Marble", {2.19, 2.62, 3.00}, {0.0021, 0.0041, 0.0071}},
    {"Potato", {0.68, 0.70, 0.55}, {0.0024, 0.0090, 0.12}}, {"Skimmilk", {0.70, 1.22, 1.90}, {0.0014, 0.0025, 0.0142}},
    {"Skin1", {0.74, 0.88, 1.01}, {0.032, 0.17, 0.48}},     {"Skin2", {1.09, 1.59, 1.79}, {0.013, 0.070, 0.145}},
    {"Spectralon", {11.6, 20.4, 14.9}, {0.0, 0.0, 0.0}},    {"Wholemilk", {2.55, 3.21, 3.77}, {0.0011, 0.0024, 0.014}}};

bool has_grid(const std::filesystem::path& file, const std::string& grid) {
    try {
        const std::vector<std::string> names = grid_names(file);
        return std::find(names.begin(), names.end(), grid) != names.end();
    } catch (const InputError&) { // whoever loads it says so
        return false;
    }
}

// Whether light that meets it goes on into what it encloses.
bool lets_light_in(const PbrtShape& shape) {
    const std::string& type = shape.material.thing.type;
    return !shape.material.is_named &&
           (type.empty() || type == "none" || type == "interface" || type == "dielectric" || type == "thindielectric");
}

} // namespace

const PbrtThing* PbrtTranslator::medium_of(const std::string& name, const PbrtPlace& place) const {
    if (name.empty())
        return nullptr;
    const auto medium = scene_.media.find(name);
    if (medium != scene_.media.end())
        return &medium->second;
    std::vector<std::string> known;
    for (const auto& [other, unused] : scene_.media)
        known.push_back(other);
    fail_at(place, known.empty() ? fmt::format("no medium \"{}\"; MakeNamedMedium makes one", name)
                                 : fmt::format("no medium \"{}\"{}", name, name_hint(name, known)));
}

void PbrtTranslator::write_coefficients(const PbrtThing& medium) {
    const PbrtParameters& p = *medium.parameters;
    glm::dvec3 sigma_a(1.0), sigma_s(1.0);
    const std::string wanted = medium.type == "homogeneous" ? p.text("preset") : "";
    if (!wanted.empty()) {
        const auto* preset = std::find_if(std::begin(presets), std::end(presets),
                                          [&](const Preset& each) { return wanted == each.name; });
        if (preset == std::end(presets))
            fail_at(p.find("preset")->place,
                    fmt::format("preset \"{}\" is not known here; write its sigma_a and sigma_s", wanted));
        sigma_a = preset->sigma_a;
        sigma_s = preset->sigma_s;
    } else {
        sigma_a = colors_.share(medium, "sigma_a").value_or(sigma_a);
        sigma_s = colors_.share(medium, "sigma_s").value_or(sigma_s);
    }
    const double scale = p.number("scale", 1.0);
    write_coefficients(scale * sigma_a, scale * sigma_s, p.number("g", 0.0));
}

void PbrtTranslator::write_coefficients(const glm::dvec3& sigma_a, const glm::dvec3& sigma_s, double g) {
    for (const auto& [name, sigma] : {std::pair("sigma_a", sigma_a), std::pair("sigma_s", sigma_s)}) {
        XmlAttributes attributes = {{"unit", "world"}};
        add_rgb(attributes, sigma);
        xml_.element(name, attributes);
    }
    xml_.element("heyneygreenstein_g", {}, xml_number(g));
}

void PbrtTranslator::write_matrix(const glm::dmat4& matrix) {
    std::string values;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            values += (values.empty() ? "" : " ") + xml_number(matrix[column][row]);
    xml_.open("transform");
    xml_.element("matrix", {{"values", values}});
    xml_.close();
}

void PbrtTranslator::write_medium(const std::string& name, const PbrtThing& medium, const Region& region,
                                  const PbrtPlace& place) {
    xml_.open("volume", {{"name", name}}, place.text());
    if (region.element.empty()) {
        xml_.open("models");
        xml_.element("model", {}, region.model);
        xml_.close();
    } else {
        xml_.element(region.element);
    }
    if (region.element != "everywhere")
        write_matrix(region.transform);
    write_coefficients(medium);
    if (const std::optional<glm::dvec3> glow = colors_.light(medium, "Le")) {
        XmlAttributes attributes;
        add_rgb(attributes, *glow * (medium.parameters->number("Lescale", 1.0) * exposure_));
        xml_.element("medium", attributes);
    }
    note_unused(medium, {"type"});
    xml_.close();
}

void PbrtTranslator::write_grid_medium(const std::string& name, const PbrtThing& medium) {
    const PbrtParameters& p = *medium.parameters;
    const std::string file = p.text("filename");
    if (file.empty())
        fail_at(medium.place, "medium \"nanovdb\" lacks its \"string filename\"");
    xml_.open("volume", {{"name", name}}, medium.place.text());
    xml_.element("densityField", {{"grid", p.text("gridname", "density")}}, file_name(medium));
    write_matrix(world_ * medium.transform);
    write_coefficients(medium);
    const std::string temperature = p.text("temperaturename", "temperature");
    const double glow = p.number("Lescale", 1.0);
    if (glow > 0.0 && has_grid(scene_.folder / file, temperature))
        write_black_body(temperature, glow, medium);
    note_unused(medium, {"type"});
    xml_.close();
}

// A value v of the temperatures stands for x * v + y kelvin.
glm::dvec2 PbrtTranslator::kelvins(const PbrtThing& medium) {
    const PbrtParameters& p = *medium.parameters;
    const double scale = p.number("temperaturescale", 1.0);
    return {scale, -scale * p.number("temperatureoffset", p.number("temperaturecutoff", 0.0))};
}

void PbrtTranslator::write_black_body(const std::string& grid, double glow, const PbrtThing& medium) {
    const glm::dvec2 kelvin = kelvins(medium);
    XmlAttributes attributes = {{"grid", grid},
                                {"model", "blackbody"},
                                {"brightness", "peak"},
                                {"temperatureScale", xml_number(kelvin.x)},
                                {"temperatureOffset", xml_number(kelvin.y)},
                                {"temperatureCutoff", xml_number(least_kelvin)}};
    add_rgb(attributes, glm::dvec3(glow * exposure_));
    xml_.element("emission", attributes);
}

// Nothing, with a note, for shapes that hold no medium here.
std::optional<PbrtTranslator::Region> PbrtTranslator::region_within(const PbrtShape& shape) {
    const PbrtThing& thing = shape.thing;
    const glm::dmat4 transform = world_ * thing.transform;
    if (thing.type == "sphere")
        return Region{"sphere", "", transform * glm::dmat4(glm::dmat3(thing.parameters->number("radius", 1.0)))};
    if (thing.type == "plymesh")
        return Region{"", file_name(thing), transform};
    if (thing.type == "trianglemesh" || thing.type == "bilinearmesh")
        if (const std::optional<glm::dmat4> box = as_box(read_triangles(thing)))
            return Region{"box", "", transform * *box};
    note(thing.place, fmt::format("\"{}\" encloses medium \"{}\", which is left out: of shapes a sphere, a box or a "
                                  "plymesh can hold it",
                                  thing.type, shape.inside));
    return std::nullopt;
}

// As far as that can be told here: what a file's mesh holds is taken to have it.
bool PbrtTranslator::has_camera(const Region& region) const {
    if (!scene_.camera)
        return false;
    const glm::dmat4 camera = world_ * glm::inverse(scene_.camera->transform);
    const glm::dvec3 p(glm::inverse(region.transform) * camera[3]);
    if (region.element == "sphere")
        return glm::length(p) < 1.0;
    return region.element.empty() || std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < 0.5;
}

bool PbrtTranslator::ends_camera_medium() {
    return std::any_of(scene_.shapes.begin(), scene_.shapes.end(), [&](const PbrtShape& shape) {
        if (shape.inside != scene_.camera_medium || shape.outside == shape.inside)
            return false;
        const std::optional<Region> region = region_within(shape);
        return region && has_camera(*region);
    });
}

// The camera's medium has no end, unless a shape about the camera ends it.
void PbrtTranslator::write_media() {
    xml_.open("volumes");
    std::set<std::string> grids; // those that are written: they end by themselves
    const auto is_grid = [&](const std::string& name, const PbrtThing& medium) {
        const bool is_file = medium.type == "nanovdb", is_one = is_file || is_dense(medium);
        if (!is_one && medium.type != "homogeneous")
            fail_at(medium.place,
                    fmt::format(
                        "medium \"{}\" cannot be rendered; take homogeneous, uniformgrid, rgbgrid, cloud, or nanovdb "
                        "with a file",
                        medium.type));
        if (is_one && grids.insert(name).second) {
            if (is_file)
                write_grid_medium(name, medium);
            else
                write_dense_medium(name, medium);
        }
        return is_one;
    };
    const PbrtPlace camera = scene_.camera ? scene_.camera->place : PbrtPlace();
    if (const PbrtThing* medium = medium_of(scene_.camera_medium, camera))
        if (!is_grid(scene_.camera_medium, *medium) && !ends_camera_medium())
            write_medium(scene_.camera_medium, *medium, {"everywhere", "", glm::dmat4(1.0)}, camera);
    for (const PbrtShape& shape : scene_.shapes) {
        if (shape.inside == shape.outside)
            continue;
        const PbrtThing* inside = medium_of(shape.inside, shape.thing.place);
        const PbrtThing* outside = medium_of(shape.outside, shape.thing.place);
        if (outside && outside->type != "homogeneous")
            is_grid(shape.outside, *outside);
        else if (outside && lets_light_in(shape))
            note(shape.thing.place,
                 fmt::format("medium \"{}\" goes on within: media add up where they overlap here", shape.outside));
        if (!inside || is_grid(shape.inside, *inside))
            continue;
        if (const std::optional<Region> region = region_within(shape))
            write_medium(shape.inside, *inside, *region, shape.thing.place);
    }
    xml_.close();
}

} // namespace vkvol
