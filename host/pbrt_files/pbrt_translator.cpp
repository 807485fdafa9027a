#include "pbrt_translator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "gzip.h"
#include "one_line.h"

namespace vkvol {

namespace {

glm::dvec3 point(const glm::dmat4& map, const glm::dvec3& p) {
    return glm::dvec3(map * glm::dvec4(p, 1.0));
}

const PbrtThing& thing_or(const std::optional<PbrtThing>& thing, const PbrtThing& fallback) {
    return thing ? *thing : fallback;
}

PbrtThing named(const char* type) {
    PbrtThing thing;
    thing.type = type;
    thing.place.file = std::make_shared<const std::string>();
    return thing;
}

// What pbrt takes where a scene says nothing.
const PbrtThing usual_camera = named("perspective"), usual_film = named("rgb"), usual_filter = named("gaussian"),
                usual_sampler = named("zsobol"), usual_integrator = named("volpath");

// The rectangle of a camera's plane that the whole film shows, in units of half of its shorter edge unless the scene
// says otherwise; x to the right, y upwards.
struct Screen {
    double left, right, bottom, top;
};

Screen screen_of(const PbrtThing& camera, double width, double height) {
    const double aspect = camera.parameters->number("frameaspectratio", width / height);
    const std::vector<double> window = camera.parameters->numbers("screenwindow");
    if (!window.empty() && (window.size() != 4 || !(window[0] < window[1]) || !(window[2] < window[3])))
        fail_at(camera.parameters->find("screenwindow")->place, "\"screenwindow\": expected left, right, bottom, top");
    if (!window.empty())
        return {window[0], window[1], window[2], window[3]};
    if (!(aspect > 0.0))
        fail_at(camera.place, "\"frameaspectratio\": expected a number > 0");
    return aspect > 1.0 ? Screen{-aspect, aspect, -1.0, 1.0} : Screen{-1.0, 1.0, -1.0 / aspect, 1.0 / aspect};
}

// The film's pixels, and those of them that are rendered.
struct Pixels {
    long long width, height;
    long long left, right, top, bottom;
};

Pixels pixels_of(const PbrtThing& film) {
    const PbrtParameters& p = *film.parameters;
    Pixels pixels{p.integer("xresolution", 1280), p.integer("yresolution", 720), 0, 0, 0, 0};
    if (pixels.width < 1 || pixels.height < 1)
        fail_at(film.place,
                fmt::format("a film of {} by {} pixels; expected one at least", pixels.width, pixels.height));
    const auto four = [&](const char* name) {
        std::vector<double> numbers = p.numbers(name);
        if (!numbers.empty() && numbers.size() != 4)
            fail_at(p.find(name)->place, fmt::format("\"{}\": expected left, right, top, bottom", name));
        return numbers;
    };
    const std::vector<double> bounds = four("pixelbounds"), crop = four("cropwindow");
    std::array<double, 4> part = {0.0, double(pixels.width), 0.0, double(pixels.height)};
    for (int i = 0; i < 4; ++i) {
        const double edge = double(i < 2 ? pixels.width : pixels.height);
        if (!crop.empty())
            part[i] = std::ceil(float(edge) * std::clamp(float(crop[i]), 0.0f, 1.0f)); // rounded as pbrt does
        else if (!bounds.empty())
            part[i] = std::clamp(std::floor(bounds[i]), 0.0, edge);
    }
    pixels.left = static_cast<long long>(std::min(part[0], part[1]));
    pixels.right = static_cast<long long>(std::max(part[0], part[1]));
    pixels.top = static_cast<long long>(std::min(part[2], part[3]));
    pixels.bottom = static_cast<long long>(std::max(part[2], part[3]));
    if (pixels.left == pixels.right || pixels.top == pixels.bottom)
        fail_at(film.place, "no pixel of the film is within its pixelbounds or cropwindow; widen them");
    return pixels;
}

// That nearest to `m`, as a rotation that may mirror.
glm::dmat3 rotation_of(const glm::dmat3& m) {
    const glm::dvec3 x = glm::normalize(m[0]), y = glm::normalize(m[1] - glm::dot(m[1], x) * x);
    return {x, y, glm::cross(x, y) * (glm::determinant(m) < 0.0 ? -1.0 : 1.0)};
}

bool is_map(const PbrtThing& light) {
    return light.type == "infinite" && !light.parameters->text("filename").empty();
}

// The part of the frame that the film has.
void write_window(const Pixels& pixels, const Screen& screen, const PbrtPlace& place, XmlText& xml) {
    const double width = screen.right - screen.left, height = screen.top - screen.bottom;
    const auto edge = [&](const char* name, long long whole, long long first, long long end, double offset) {
        xml.element(name,
                    {{"reference", fmt::format("{}", whole)}, {"startOffset", xml_number(double(first) + offset)}},
                    fmt::format("{}", end - first), place.text());
    };
    // By how much the window's middle is off that of the frame.
    edge("width", pixels.width, pixels.left, pixels.right,
         0.5 * (screen.left + screen.right) / width * double(pixels.width));
    edge("height", pixels.height, pixels.top, pixels.bottom,
         -0.5 * (screen.bottom + screen.top) / height * double(pixels.height));
}

} // namespace

bool turns_alone(const glm::dmat3& m, double& scale) {
    scale = std::cbrt(std::abs(glm::determinant(m)));
    const glm::dmat3 square = glm::transpose(m) * m;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (std::abs(square[i][j] - (i == j ? scale * scale : 0.0)) > 1e-4 * scale * scale)
                return false;
    return true;
}

PbrtTranslator::PbrtTranslator(const PbrtScene& scene, PbrtTranslationOptions options)
    : scene_(scene), options_(std::move(options)), colors_(scene.folder) {
    const PbrtThing& film = thing_or(scene.film, usual_film);
    const PbrtThing& camera = thing_or(scene.camera, usual_camera);
    const double open = camera.parameters->number("shutteropen", 0.0),
                 close = camera.parameters->number("shutterclose", 1.0);
    if (!(close > open))
        fail_at(camera.place, "an exposure of 0; expected a shutter that opens before it closes");
    exposure_ = (close - open) * film.parameters->number("iso", 100.0) / 100.0;
    if (!(exposure_ > 0.0))
        fail_at(film.place, "an exposure of 0; expected an iso > 0");
}

void PbrtTranslator::note(const PbrtPlace& place, const std::string& message) {
    const std::string text = one_line(place.text() + ": " + message);
    if (heard_.insert(text).second)
        notes_.push_back(text);
}

// Empty if it names none.
std::string PbrtTranslator::file_name(const PbrtThing& thing, const char* parameter) const {
    const std::string name = thing.parameters->text(parameter);
    if (name.ends_with(".gz") && !is_packed(name, ".ply"))
        fail_at(thing.place, fmt::format("{} is compressed; unpack it with gunzip, and name what that leaves", name));
    return name.empty() || !options_.name_of_file ? name : options_.name_of_file(name);
}

// Parameters that nothing here has asked for; `known`: those that make no difference here.
void PbrtTranslator::note_unused(const PbrtThing& thing, std::initializer_list<const char*> known) {
    for (const char* name : known)
        thing.parameters->find(name);
    for (const PbrtParameter* parameter : thing.parameters->unused())
        note(parameter->place, fmt::format("\"{}\" is left out", parameter->name));
}

// From pbrt's world; see the head of pbrt_translator.h.
void PbrtTranslator::choose_world() {
    const PbrtThing& camera = thing_or(scene_.camera, usual_camera);
    // To its own pictures a spherical camera shows space as if from without.
    const bool is_spherical = camera.type == "spherical";
    const bool mirrors = (glm::determinant(glm::dmat3(camera.transform)) > 0.0) != is_spherical;
    const auto map = std::find_if(scene_.lights.begin(), scene_.lights.end(), is_map);
    if (map == scene_.lights.end()) {
        world_[2][2] = mirrors ? -1.0 : 1.0;
        return;
    }
    const glm::dmat3 upright(1, 0, 0, 0, 0, 1, 0, 1, 0); // z of a map to y
    glm::dmat3 turn = upright * glm::transpose(rotation_of(glm::dmat3(map->transform)));
    sky_is_mirrored_ = (glm::determinant(turn) < 0.0) != mirrors;
    if (sky_is_mirrored_)
        turn = glm::dmat3(-1, 0, 0, 0, 1, 0, 0, 0, 1) * turn;
    world_ = glm::dmat4(turn);
}

// `height`: of the window of its screen; `scale`: of world units over the camera's.
void PbrtTranslator::add_projection(const PbrtThing& camera, double height, double scale, XmlAttributes& attributes) {
    const PbrtParameters& p = *camera.parameters;
    const double sharp = p.number("focaldistance", 1e6) * scale, lens = p.number("lensradius", 0.0) * scale;
    if (camera.type == "perspective") {
        const double fov = p.number("fov", 90.0);
        if (!(fov > 0.0) || !(fov < 180.0))
            fail_at(camera.place, fmt::format("\"fov\": {:g}; expected degrees between 0 and 180", fov));
        const double half = std::tan(0.5 * glm::radians(fov)) * 0.5 * height;
        attributes.emplace_back("fov", xml_number(glm::degrees(2.0 * std::atan(half))));
        if (lens > 0.0) {
            attributes.emplace_back("lensRadius", xml_number(lens));
            attributes.emplace_back("focus", xml_number(sharp));
        }
    } else if (camera.type == "orthographic") {
        attributes.emplace_back("projection", "orthographic");
        attributes.emplace_back("viewHeight", xml_number(height * scale));
        if (lens > 0.0)
            note(camera.place, "an orthographic camera has no lens here; all is sharp");
    } else {
        if (camera.type != "spherical")
            fail_at(camera.place, fmt::format("Camera \"{}\" cannot be rendered; take perspective, orthographic or "
                                              "spherical",
                                              camera.type));
        attributes.emplace_back("projection", "equirectangular");
        if (p.text("mapping", "equalarea") != "equirectangular")
            note(camera.place, "its picture is equirectangular, not of equal areas");
    }
}

void PbrtTranslator::write_camera() {
    const PbrtThing& camera = thing_or(scene_.camera, usual_camera);
    const PbrtThing& film = thing_or(scene_.film, usual_film);
    const Pixels pixels = pixels_of(film);
    const bool is_spherical = camera.type == "spherical"; // for which pbrt has windows read, and uses none
    const Screen screen = screen_of(is_spherical ? usual_camera : camera, double(pixels.width), double(pixels.height));
    const double width = screen.right - screen.left, height = screen.top - screen.bottom;
    if (std::abs(width / height / (double(pixels.width) / double(pixels.height)) - 1.0) > 1e-3)
        note(camera.place, "pixels are not square to this camera; they are here, by its window's height");

    const glm::dmat4 to_world = glm::inverse(camera.transform);
    double scale = 1.0;
    if (!turns_alone(glm::dmat3(to_world), scale))
        note(camera.place, "its transform stretches what it sees; it is turned and moved alone");
    const glm::dvec3 eye = point(world_ * to_world, glm::dvec3(0.0));
    const glm::dmat3 axes(world_ * to_world);
    const glm::dvec3 forward = glm::normalize(is_spherical ? -axes[0] : axes[2]);
    XmlAttributes attributes;
    add_xyz(attributes, eye);
    attributes.emplace_back("lookAt", xml_numbers(eye + forward * std::max(1.0, glm::length(eye))));
    attributes.emplace_back("up", xml_numbers(glm::normalize(axes[1])));
    add_projection(camera, height, scale, attributes);
    note_unused(camera, {is_spherical ? "screenwindow" : "", is_spherical ? "frameaspectratio" : ""});
    xml_.element("camera", attributes, "", camera.place.text());

    write_window(pixels, screen, film.place, xml_);
}

void PbrtTranslator::write_film() {
    const PbrtThing& film = thing_or(scene_.film, usual_film);
    const PbrtParameters& p = *film.parameters;
    if (film.type != "rgb")
        note(film.place, fmt::format("Film \"{}\" is left out; the picture is red, green and blue", film.type));
    if (p.text("sensor", "cie1931") != "cie1931")
        note(film.place, "the camera's sensor is left out; colours are those of the CIE's observer");
    if (p.number("whitebalance", 0.0) != 0.0)
        note(film.place, "\"whitebalance\" is left out");
    if (p.has("maxcomponentvalue"))
        note(film.place, "\"maxcomponentvalue\" is left out: samples are not cut, which would darken the picture");
    note_unused(film, {"filename", "savefp16", "diagonal"});
}

void PbrtTranslator::write_filter() {
    const PbrtThing& filter = thing_or(scene_.filter, usual_filter);
    const PbrtParameters& p = *filter.parameters;
    struct Known {
        const char* name;
        const char* here;
        double radius;
    };
    constexpr Known known[] = {{"box", "box", 0.5}, {"triangle", "tent", 2.0}, {"gaussian", "gaussian", 1.5}};
    const auto* kind =
        std::find_if(std::begin(known), std::end(known), [&](const Known& each) { return filter.type == each.name; });
    if (kind == std::end(known)) {
        note(filter.place, fmt::format("PixelFilter \"{}\" is left out; the picture has pbrt's Gaussian", filter.type));
        xml_.element("pixelFilter", {{"radius", "1.5"}}, "gaussian", filter.place.text());
        return;
    }
    double x = p.number("xradius", kind->radius);
    const double y = p.number("yradius", kind->radius);
    const double sigma = filter.type == "gaussian" ? p.number("sigma", 0.5) : 0.0;
    if (x != y)
        note(filter.place, fmt::format("\"yradius\" is left out; the filter is {:g} pixels wide along either axis", x));
    if (filter.type == "gaussian" && 3.0 * sigma > (1.0 + 1e-6) * x)
        note(filter.place, "\"sigma\" is left out; it is a third of the radius");
    else if (filter.type == "gaussian") // beyond which there is a hundredth of it
        x = std::max(3.0 * sigma, 0.01);
    note_unused(filter);
    xml_.element("pixelFilter", {{"radius", xml_number(x)}}, kind->here, filter.place.text());
}

void PbrtTranslator::write_settings() {
    const PbrtThing& sampler = thing_or(scene_.sampler, usual_sampler);
    const PbrtThing& integrator = thing_or(scene_.integrator, usual_integrator);
    const PbrtParameters& s = *sampler.parameters;
    const bool is_grid = sampler.type == "stratified";
    const long long samples = is_grid ? s.integer("xsamples", 4) * s.integer("ysamples", 4)
                                      : s.integer("pixelsamples", sampler.type == "independent" ? 4 : 16);
    xml_.element("rayPerPixelCount", {}, fmt::format("{}", samples), sampler.place.text());
    note_unused(sampler, {"seed", "randomization", "jitter"});
    if (integrator.type != "volpath" && integrator.type != "path" && integrator.type != "simplevolpath")
        note(integrator.place,
             fmt::format("Integrator \"{}\" is left out; the best unbiased one for the scene renders it",
                         integrator.type));
    if (integrator.type == "path" && !scene_.media.empty())
        note(integrator.place,
             "pbrt's \"path\" leaves media out, and they are shown here; \"volpath\" shows them there");
    if (integrator.parameters->truth("regularize", false))
        note(integrator.place, "\"regularize\" is left out: roughness stays what it is");
    xml_.element("maxDepth", {}, fmt::format("{}", integrator.parameters->integer("maxdepth", 5)),
                 integrator.place.text());
    note_unused(integrator, {"lightsampler", "samplelights", "samplebsdf", "visiblesurfaces"});
}

PbrtTranslation PbrtTranslator::translate() {
    notes_ = scene_.notes;
    choose_world();
    xml_.open("options");
    write_media();
    write_surfaces();
    write_lights();
    write_camera();
    write_film();
    write_filter();
    write_settings();
    xml_.close();
    return {xml_.text(), xml_.places(), std::move(notes_), std::move(grids_)};
}

PbrtTranslation translate_pbrt(const PbrtScene& scene, const PbrtTranslationOptions& options) {
    return PbrtTranslator(scene, options).translate();
}

} // namespace vkvol
