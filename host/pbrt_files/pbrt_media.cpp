// The part of PbrtTranslator that writes media.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/constants.hpp>
#include <numbers>

#include "density_field.h"
#include "error.h"
#include "mesh.h"
#include "nearest_name.h"
#include "pbrt_presets.h"
#include "pbrt_quadrics.h"
#include "pbrt_translator.h"
#include "pbrt_voxels.h"

namespace vkvol {

namespace {

bool has_grid(const std::filesystem::path& file, const std::string& grid) {
    try {
        const std::vector<std::string> names = grid_names(file);
        return std::find(names.begin(), names.end(), grid) != names.end();
    } catch (const InputError&) { // whoever loads it says so
        return false;
    }
}

bool is_closed(const std::filesystem::path& file) {
    try {
        load_mesh({{file}});
        return true;
    } catch (const InputError&) { // then it holds none of several media; of one alone, whoever renders it says so
        return false;
    }
}

// Whether a closed mesh has the point within, by the solid angle that it takes up there (van Oosterom and Strackee
// 1983).
bool has_within(const std::filesystem::path& file, const glm::dmat4& transform, const glm::dvec3& point) {
    try {
        const Mesh mesh = load_mesh({{file}}, transform);
        double angle = 0.0;
        for (const glm::uvec3& t : mesh.triangles) {
            const glm::dvec3 a = mesh.vertices[t.x] - point, b = mesh.vertices[t.y] - point,
                             c = mesh.vertices[t.z] - point;
            const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
            angle += 2.0 * std::atan2(glm::dot(a, glm::cross(b, c)),
                                      la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
        }
        return angle > glm::two_pi<double>();
    } catch (const InputError&) { // whoever renders it says so
        return false;
    }
}

} // namespace

// Whether light that meets it goes on into what it encloses.
bool PbrtTranslator::lets_light_in(const PbrtShape& shape) const {
    const std::string& type = material_thing(shape).type;
    return type.empty() || type == "none" || type == "interface" || type == "dielectric" || type == "thindielectric";
}

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
        const std::optional<PbrtPreset> preset = pbrt_preset(wanted);
        if (!preset)
            fail_at(p.find("preset")->place,
                    fmt::format("preset \"{}\" is not known{}; or write its sigma_a and sigma_s", wanted,
                                name_hint(wanted, pbrt_preset_names())));
        sigma_a = preset->sigma_a;
        sigma_s = preset->sigma_s;
    } else {
        sigma_a = colors_.share(medium, "sigma_a").value_or(sigma_a);
        sigma_s = colors_.share(medium, "sigma_s").value_or(sigma_s);
    }
    const double scale = medium.type == "cloud" ? 1.0 : p.number("scale", 1.0); // pbrt's clouds have none
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
    xml_.open("volume", {{"name", name}}, medium.place.text());
    if (region.element.empty()) {
        xml_.open("models", {}, place.text());
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
        add_rgb(attributes, *glow * (glow_scale(medium) * exposure_));
        xml_.element("medium", attributes);
    }
    note_unused(medium, {"type"});
    xml_.close();
}

// "LeScale" to scenes from before pbrt's 22nd of June, 2022.
double PbrtTranslator::glow_scale(const PbrtThing& medium) {
    const PbrtParameters& p = *medium.parameters;
    return p.number(p.has("Lescale") ? "Lescale" : "LeScale", 1.0);
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
    const double glow = glow_scale(medium);
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

// Nothing for shapes that hold no medium here.
std::optional<PbrtTranslator::Region> PbrtTranslator::region_of(const PbrtShape& shape) const {
    const PbrtThing& thing = shape.thing;
    const glm::dmat4 transform = world_ * thing.transform;
    if (thing.type == "sphere" && is_whole_ball_or_disk(thing, glm::dmat4(1.0)))
        return Region{"sphere", "", transform * glm::dmat4(glm::dmat3(thing.parameters->number("radius", 1.0)))};
    if (thing.type == "plymesh" && (media_count_ <= 1 || is_closed(scene_.folder / thing.parameters->text("filename"))))
        return Region{"", file_name(thing), transform};
    if (thing.type == "trianglemesh" || thing.type == "bilinearmesh")
        if (const std::optional<glm::dmat4> box = as_box(read_triangles(thing)))
            return Region{"box", "", transform * *box};
    return std::nullopt;
}

std::optional<PbrtTranslator::Region> PbrtTranslator::region_within(const PbrtShape& shape, const std::string& medium) {
    std::optional<Region> region = region_of(shape);
    if (!region)
        note(shape.thing.place,
             fmt::format("\"{}\" encloses medium \"{}\", which {}: of shapes a whole sphere, a box or a "
                         "plymesh that is closed can hold it",
                         shape.thing.type, medium, is_endless(medium) ? "has no end here" : "is left out"));
    return region;
}

// Around the camera, with no shape that ends it.
bool PbrtTranslator::is_endless(const std::string& medium) const {
    return camera_medium_is_endless_ && medium == scene_.camera_medium;
}

bool PbrtTranslator::has_camera(const PbrtShape& shape, const Region& region) const {
    const glm::dmat4 placed = scene_.camera ? scene_.camera->transform : glm::dmat4(1.0); // pbrt's usual one
    return has_point(shape, region, world_ * glm::inverse(placed)[3]);
}

bool PbrtTranslator::has_point(const PbrtShape& shape, const Region& region, const glm::dvec4& point) const {
    if (region.element.empty()) { // whose name is, for `vkvol convert`, that beside the new scene
        const std::string file = shape.thing.parameters->text("filename");
        return has_within(scene_.folder / file, region.transform, glm::dvec3(point));
    }
    const glm::dvec3 p(glm::inverse(region.transform) * point);
    if (region.element == "sphere")
        return glm::length(p) < 1.0;
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < 0.5;
}

bool PbrtTranslator::ends_camera_medium() {
    return std::any_of(scene_.shapes.begin(), scene_.shapes.end(), [&](const PbrtShape& shape) {
        const PbrtSides sides = sides_of(shape);
        if (sides.within != scene_.camera_medium || sides.beyond == sides.within)
            return false;
        const std::optional<Region> region = region_of(shape);
        return region && has_camera(shape, *region);
    });
}

// Whether it is one. Grids end by themselves, and are written once.
bool PbrtTranslator::write_grid_once(const std::string& name, const PbrtThing& medium) {
    const bool is_file = medium.type == "nanovdb", is_grid = is_file || is_dense(medium);
    if (!is_grid && medium.type != "homogeneous")
        fail_at(
            medium.place,
            fmt::format("medium \"{}\" cannot be rendered; take homogeneous, uniformgrid, rgbgrid, cloud, or nanovdb "
                        "with a file",
                        medium.type));
    if (is_grid && written_grids_.insert(name).second) {
        if (is_file)
            write_grid_medium(name, medium);
        else
            write_dense_medium(name, medium);
    }
    return is_grid;
}

// The volumes that shapes ask for, each grid once.
void PbrtTranslator::count_media() {
    std::set<std::string> grids;
    const auto is_grid = [&](const std::string& name) {
        const auto medium = scene_.media.find(name);
        return medium != scene_.media.end() && medium->second.type != "homogeneous";
    };
    if (is_grid(scene_.camera_medium))
        grids.insert(scene_.camera_medium);
    for (const PbrtShape& shape : scene_.shapes) {
        if (shape.inside == shape.outside)
            continue;
        const PbrtSides sides = sides_of(shape);
        media_within_.insert(sides.within);
        for (const std::string& name : {sides.within, sides.beyond})
            if (is_grid(name))
                grids.insert(name);
        if (sides.within.empty() || is_grid(sides.within))
            continue;
        ++media_count_;
        if (shape.thing.type == "plymesh")
            continue;
        if (const std::optional<Region> region = region_of(shape); region && sides.within != sides.beyond)
            bounded_.push_back({&shape, sides.within, *region});
    }
    media_count_ += int(grids.size());
}

// It has no end, unless a shape about the camera ends it.
void PbrtTranslator::write_camera_medium() {
    const PbrtPlace place = scene_.camera ? scene_.camera->place : PbrtPlace();
    const PbrtThing* medium = medium_of(scene_.camera_medium, place);
    if (!medium || write_grid_once(scene_.camera_medium, *medium) || ends_camera_medium())
        return;
    ++media_count_;
    camera_medium_is_endless_ = true;
    write_medium(scene_.camera_medium, *medium, {"everywhere", "", glm::dmat4(1.0)}, place);
    if (std::any_of(scene_.lights.begin(), scene_.lights.end(),
                    [](const PbrtThing& light) { return light.type == "distant" || light.type == "infinite"; }))
        note(place, fmt::format("medium \"{}\" has no end, and lets no light through from \"distant\" and \"infinite\" "
                                "sources; pbrt has it "
                                "come from twice the scene's radius. A sphere about camera and scene would end it",
                                scene_.camera_medium));
}

void PbrtTranslator::write_media_of(const PbrtShape& shape) {
    const PbrtSides sides = sides_of(shape);
    if (sides.within == sides.beyond)
        return;
    const PbrtThing* within = medium_of(sides.within, shape.thing.place);
    const PbrtThing* beyond = medium_of(sides.beyond, shape.thing.place);
    if (beyond && !write_grid_once(sides.beyond, *beyond))
        note_beyond(shape, sides.beyond);
    else if (beyond && is_dense(*beyond) && lets_light_in(shape))
        note(shape.thing.place,
             fmt::format("the grid of medium \"{}\" goes on within: shapes do not cut grids here", sides.beyond));
    if (camera_medium_is_endless_ && sides.beyond.empty() && sides.within != scene_.camera_medium)
        note(shape.thing.place, fmt::format("medium \"{}\" goes on beyond this; pbrt's rays leave it here, since the "
                                            "MediumInterface has none outside",
                                            scene_.camera_medium));
    if (!within)
        return;
    if (write_grid_once(sides.within, *within)) {
        note_what_is_not_cut(shape, sides.within, *within);
        const std::optional<Region> region = region_of(shape);
        if (scene_.camera_medium.empty() && region && has_camera(shape, *region))
            note(
                shape.thing.place,
                fmt::format("the camera is within this, and sees the grid of medium \"{}\"; pbrt's rays begin in none, "
                            "as there is no MediumInterface before Camera",
                            sides.within));
    } else if (const std::optional<Region> region = region_within(shape, sides.within);
               region && is_endless(sides.within)) {
        note(shape.thing.place,
             fmt::format("medium \"{}\" is everywhere here, and not twice within this", sides.within));
    } else if (region) {
        if (sides.beyond.empty())
            note_media_around(shape, *region);
        write_medium(sides.within, *within, *region, shape.thing.place);
        if (sides.within != scene_.camera_medium && has_camera(shape, *region))
            note(shape.thing.place,
                 fmt::format(
                     "the camera is within medium \"{}\", and so are its rays; pbrt's begin in {}, as there is no "
                     "MediumInterface before Camera that says otherwise",
                     sides.within, scene_.camera_medium.empty() ? "none" : '"' + scene_.camera_medium + '"'));
    }
}

void PbrtTranslator::write_media() {
    xml_.open("volumes");
    count_media();
    write_camera_medium();
    for (const PbrtShape& shape : scene_.shapes)
        write_media_of(shape);
    xml_.close();
}

} // namespace vkvol
