#include "scene_reader.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <fmt/format.h>

#include "error.h"
#include "nearest_name.h"
#include "one_line.h"
#include "scene_places.h"

namespace vkvol {

namespace {

const std::vector<std::string> vocabulary = {
    "densityField", "sphere", "box", "everywhere", "layers", "models", "volumes", "surfaces", "noise", "sigma_a",
    "sigma_s", "heyneygreenstein_g", "phase", "medium", "emission", "albedo", "densityMap", "transferFunction", "light",
    "lights", "backgroundColor", "camera", "irradiance", "fluence", "absorption", "units", "periodic", "motionBlur",
    "width", "height", "film", "rayPerPixelCount", "maxDepth", "integrator", "march", "filter", "russianRoulette",
    "majorant", "pixelFilter", "lightRayDensityMultiplier", "shadowRayDensityMultiplier", "stepSize",
    "importanceSampling", "fileName", "multiThreaded", "multiThreadedChunkSize", "diffuseRebounds", "expected",
    // Names that are read for old files' sake: a misspelling in the original's report, and the old name of integrator.
    "heynegreenstein_g", "intersectionHandler"};

} // namespace

Scene SceneReader::read() {
    XmlElement(document_, document_.root()).allow({"xmlns:xsi", "xsi:noNamespaceSchemaLocation"}, false, vocabulary);
    Scene scene;
    scene.settings = settings();
    scene.camera = sensor();
    scene.has_camera = one("camera").exists() || reads_flux(scene.camera);
    scene.picture = picture(scene.camera);
    const XmlElement background = one("backgroundColor");
    background.allow({"r", "g", "b", "multiplier", "group"});
    scene.background = color(background);
    scene.background_group = group_name(background);
    scene.motion_blur = motion_blur();
    read_film(scene);
    read_light(scene);
    read_lights(scene);
    read_volumes(scene);
    read_surfaces(scene);
    check_motion(scene);
    scene.periodic = periodic();
    read_units(scene);
    if (!any_medium(scene, [](const Volume& each) { return std::holds_alternative<GridFile>(each.shape); }))
        scene.settings.march.unit = CoefficientUnit::world;
    scene.expected = expected();
    check_method(scene);
    read_without_effect();
    read_bookkeeping();
    if (const XmlElement light = one("light"); light.exists() && color(light) == Rgb(0.0)) // the first of lights
        scene.black.insert(scene.black.begin(), {"light", light.place(), group_name(light)});
    for (const char* name : {"backgroundColor", "medium", "emission"})
        if (const XmlElement element = one(name); element.exists() && color(element) == Rgb(0.0))
            scene.black.push_back({name, element.place()});
    for (const char* name : {"light", "backgroundColor", "medium", "emission"})
        warn_of_forgotten_color(one(name));
    scene.warnings = document_.warnings();
    return scene;
}

pugi::xml_node find_one(XmlDocument& document, pugi::xml_node scope, std::initializer_list<const char*> names) {
    pugi::xml_node found;
    for (const pugi::xml_node child : scope.children()) {
        const bool matches = std::any_of(names.begin(), names.end(),
                                         [&](const char* name) { return std::strcmp(name, child.name()) == 0; });
        if (!matches)
            continue;
        if (found)
            XmlElement(document, child)
                .fail(
                    fmt::format("a second <{}>, after the one at {}; remove one", child.name(), document.place(found)));
        found = child;
    }
    return found;
}

// The element of one of these names (they are spellings of the same thing); null if there is none.
pugi::xml_node SceneReader::find(std::initializer_list<const char*> names) const {
    for (const pugi::xml_node scope : scopes_)
        if (const pugi::xml_node found = find_one(document_, scope, names))
            return found;
    return {};
}

RenderSettings SceneReader::settings() const {
    RenderSettings settings;
    read_integrator(settings);
    settings.march = march();
    const XmlElement spp = one("rayPerPixelCount");
    spp.allow({}, true);
    settings.spp = static_cast<std::uint32_t>(spp.integer(settings.spp, 1, max_integer));
    const XmlElement depth = one("maxDepth");
    depth.allow({}, true);
    if (depth.exists())
        settings.max_depth = static_cast<std::uint32_t>(depth.integer(0, 0, max_integer));
    const XmlElement roulette = one("russianRoulette");
    roulette.allow({"threshold"});
    settings.roulette_threshold = roulette.attribute_number("threshold", settings.roulette_threshold,
                                                            {0, 1, true, true, "a number from 0 (never) to 1"});
    const XmlElement majorant = one("majorant");
    majorant.allow({"scale", "cell"});
    settings.majorant_scale = majorant.attribute_number("scale", settings.majorant_scale,
                                                        {1e-6, 1e6, true, true, "a number from 1e-6 to 1e6"});
    settings.majorant_cell = static_cast<int>(majorant.attribute_integer("cell", settings.majorant_cell, 0, 1024));

    const XmlElement filter = one("filter");
    filter.allow({}, true);
    if (const std::string name = filter.text(); name == "nearest")
        settings.filter = Filter::nearest;
    else if (name == "trilinear")
        settings.filter = Filter::trilinear;
    else if (name == "stochastic")
        settings.filter = Filter::stochastic;
    else if (filter.exists())
        filter.fail_text(
            fmt::format("unknown filter '{}'{}", name, name_hint(name, {"nearest", "trilinear", "stochastic"})));
    read_pixel_filter(settings);
    return settings;
}

void SceneReader::read_pixel_filter(RenderSettings& settings) const {
    const XmlElement element = one("pixelFilter");
    element.allow({"radius"}, true);
    if (!element.exists())
        return;
    struct Choice {
        const char* name;
        PixelFilter filter;
        double radius; // unless another is asked for
    };
    constexpr Choice choices[] = {{"box", PixelFilter::box, 0.5},
                                  {"tent", PixelFilter::tent, 1.0},
                                  {"gaussian", PixelFilter::gaussian, 1.5},
                                  {"blackmanHarris", PixelFilter::blackman_harris, 1.5}};
    const std::string name = element.text();
    const auto* choice =
        std::find_if(std::begin(choices), std::end(choices), [&](const Choice& each) { return name == each.name; });
    if (choice == std::end(choices))
        return element.fail_text(fmt::format("unknown pixelFilter '{}'{}", name,
                                             name_hint(name, {"box", "tent", "gaussian", "blackmanHarris"})));
    settings.pixel_filter = choice->filter;
    settings.pixel_filter_radius = element.attribute_number(
        "radius", choice->radius, {0.01, 16.0, true, true, "a number from 0.01 to 16, in pixels"});
}

void SceneReader::read_edge(const char* name, int& size, double& start, double& reference) const {
    const XmlElement element = one(name);
    element.allow({"startOffset", "reference"}, true);
    size = static_cast<int>(element.integer(size, 1, max_edge));
    start = element.attribute_number("startOffset", 0.0, {-1e9, 1e9, true, true, "a number from -1e9 to 1e9"});
    reference = element.attribute_number("reference", 0.0, {0.0, 1e9, true, true, "a number from 0 to 1e9"});
    if (reference >= 1.0)
        return;
    if (reference > 0.0)
        element.fail_attribute("reference", fmt::format("<{}> reference: a frame of {:g} pixels holds no picture; "
                                                        "expected at least 1, or 0 for the picture's own size",
                                                        name, reference));
    reference = size;
    if (start != 0.0)
        element.warn(
            fmt::format("startOffset without a reference; the reference frame is taken to be {} pixels", size));
}

Picture SceneReader::picture(const Camera& camera) const {
    if (camera.projection == Projection::fluence)
        return picture_of_points(camera);
    if (camera.projection == Projection::absorption)
        return picture_of_cells(camera);
    Picture picture;
    if (camera.projection == Projection::irradiance) // one reading, unless more are asked for
        picture.width = picture.height = 1;
    read_edge("width", picture.width, picture.start_x, picture.reference_width);
    read_edge("height", picture.height, picture.start_y, picture.reference_height);
    return picture;
}

void warn_of_forgotten_color(const XmlElement& element) {
    const auto has_any = [&](std::initializer_list<const char*> names) {
        return std::any_of(names.begin(), names.end(), [&](const char* name) { return element.has(name); });
    };
    if (has_any({"multiplier", "model", "grid", "temperatureScale"}) && !has_any({"r", "g", "b"}))
        element.warn(
            fmt::format("<{0}> is black: r, g and b are 0 unless given; write <{0} r=\"1\" g=\"1\" b=\"1\" .../> "
                        "for white",
                        element.name()));
}

Rgb SceneReader::color(const XmlElement& element) const {
    const auto channel = [&](const char* name) { return element.attribute_number(name, 0.0, not_negative); };
    const double multiplier = element.attribute_number("multiplier", 1.0, not_negative);
    const Rgb color = Rgb(channel("r"), channel("g"), channel("b")) * multiplier;
    for (const char* name : {"r", "g", "b"})
        if (channel(name) * multiplier > brightest_light)
            element.fail_attribute(name,
                                   fmt::format("<{}> {} times multiplier is {:g}, but {:g} is the most; lower one "
                                               "of them",
                                               element.name(), name, channel(name) * multiplier, brightest_light));
    return color;
}

// What the picture has besides radiance.
void SceneReader::read_film(Scene& scene) const {
    const XmlElement element = one("film");
    element.allow({"aov", "alpha"});
    std::string wrong;
    const std::optional<unsigned> layers = parse_layers(element.attribute("aov"), wrong);
    if (!layers)
        element.fail_attribute("aov",
                               fmt::format("<film> aov: unknown layer '{}'{}", wrong, name_hint(wrong, layer_names())));
    scene.layers = *layers;
    scene.holds_out = element.attribute_boolean("alpha", false);
    if (scene.holds_out)
        scene.layers |= layer_alpha;
    if (const std::string trouble = trouble_with_layers(scene); !trouble.empty())
        element.fail("<film> " + trouble);
}

// Group of a light, for layers: spelled as names of channels may be, in which a dot parts a layer from its channel.
std::string SceneReader::group_name(const XmlElement& element) const {
    const std::string name = element.attribute("group");
    const bool good =
        std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; });
    if (!good || name.size() > 64 || name == "none")
        element.fail_attribute("group", fmt::format("<{}> group: '{}' is no name of a layer; expected letters, digits, "
                                                    "_ and -, 64 at most, and not none",
                                                    element.name(), one_line(name.substr(0, 80))));
    return name;
}

void SceneReader::read_light(Scene& scene) const {
    const XmlElement element = one("light");
    element.allow({"x", "y", "z", "zenith", "azimuth", "r", "g", "b", "multiplier", "group"});
    const Rgb irradiance = color(element);
    const std::string group = group_name(element);
    const bool has_direction =
        element.has("zenith") || element.has("azimuth") || xyz(element, any_number) != glm::dvec3(0.0);
    if (irradiance == Rgb(0.0) && !has_direction)
        return;
    const glm::dvec3 direction = direction_towards(element);
    if (irradiance != Rgb(0.0))
        scene.lights.push_back(DirectionalLight{direction, irradiance, group});
}

// What asks for something that this renderer does not do, each with what is done in its place.
void SceneReader::read_without_effect() const {

    const XmlElement sampling = one("importanceSampling");
    sampling.allow({}, true);
    if (sampling.boolean(false))
        sampling.warn("importanceSampling is without effect: the original's weights were wrong; paths are sampled by "
                      "the phase function");

    const XmlElement rebounds = one("diffuseRebounds");
    rebounds.allow({}, false, {"rebound"});
    if (rebounds.exists())
        rebounds.warn("diffuseRebounds is without effect, as in the original renderer");
}

// How the original organised its work: nothing in the picture depends on it.
void SceneReader::read_bookkeeping() const {
    const XmlElement threaded = one("multiThreaded");
    threaded.allow({"freeThreads"}, true);
    threaded.boolean(true);
    threaded.attribute_integer("freeThreads", 0, 0, max_integer);
    const XmlElement chunk = one("multiThreadedChunkSize");
    chunk.allow({}, true);
    chunk.integer(0, 0, max_integer);
    const XmlElement file_name = one("fileName");
    file_name.allow({}, true);
    if (!file_name.text().empty())
        file_name.warn("fileName is without effect, as in the original renderer; -o names the picture");
}

} // namespace vkvol
