#include "scene_xml.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>

#include "error.h"
#include "integrators.h"
#include "nearest_name.h"
#include "shared/bindings.h"
#include "xml_reader.h"

namespace vkvol {

namespace {

const std::vector<std::string> vocabulary = {
    "densityField", "sphere", "box", "sigma_a", "sigma_s", "heyneygreenstein_g", "medium", "emission", "light",
    "backgroundColor", "camera", "width", "height", "rayPerPixelCount", "maxDepth", "integrator", "filter",
    "russianRoulette", "majorant", "lightRayDensityMultiplier", "shadowRayDensityMultiplier", "stepSize",
    "importanceSampling", "models", "fileName", "multiThreaded", "multiThreadedChunkSize", "diffuseRebounds",
    // Names that are read for old files' sake: a misspelling in the original's report, and the old name of integrator.
    "heynegreenstein_g", "intersectionHandler"};

// The original's other integrators: ray marchers and analytic fog, most of them biased.
const std::vector<std::string> retired_integrators = {
    "densitySampling", "homogeneousRayMarcherNEE", "homogeneousRayMarcherImproved", "heterogeneousPerlinNoise",
    "nanoVDBSimple",   "nanoVDBEmission"};

const std::vector<std::string> color_attributes = {"r", "g", "b", "multiplier"};

constexpr double max_pixels = 65536;
constexpr long long max_integer = 2147483647;

class SceneReader {
public:
    SceneReader(XmlDocument& document, const SceneOverrides& overrides) : document_(document), overrides_(overrides) {}

    Scene read();

private:
    XmlElement one(std::initializer_list<const char*> names) const;
    XmlElement one(const char* name) const { return one({name}); }

    std::string integrator() const;
    RenderSettings settings() const;
    Camera camera() const;
    Picture picture() const;
    void read_edge(const char* name, int& size, double& start, double& reference) const;
    Rgb color(const XmlElement& element) const;
    void read_light(Scene& scene) const;
    std::optional<Volume> volume() const;
    XmlElement shape_element() const;
    Sphere sphere(const XmlElement& element) const;
    Box box(const XmlElement& element) const;
    GridFile grid_file(const XmlElement& element) const;
    void read_coefficients(Volume& volume) const;
    CoefficientUnit unit(const XmlElement& sigma_a, const XmlElement& sigma_s, bool is_grid) const;
    void warn_without_volume() const;
    void read_without_effect() const;
    void read_bookkeeping() const;

    XmlDocument& document_;
    const SceneOverrides& overrides_;
};

Scene SceneReader::read() {
    XmlElement(document_, document_.root()).allow({"xmlns:xsi", "xsi:noNamespaceSchemaLocation"}, false, vocabulary);
    Scene scene;
    scene.settings = settings();
    scene.camera = camera();
    scene.picture = picture();
    const XmlElement background = one("backgroundColor");
    background.allow(color_attributes);
    scene.background = color(background);
    read_light(scene);
    if (const std::optional<Volume> medium = volume())
        scene.volumes.push_back(*medium);
    read_without_effect();
    read_bookkeeping();
    scene.warnings = document_.warnings();
    return scene;
}

// The element of one of these names (they are spellings of the same thing); missing if there is none.
XmlElement SceneReader::one(std::initializer_list<const char*> names) const {
    pugi::xml_node found;
    for (const pugi::xml_node child : document_.root().children()) {
        const bool matches = std::any_of(names.begin(), names.end(),
                                         [&](const char* name) { return std::string(name) == child.name(); });
        if (!matches)
            continue;
        if (found)
            throw InputError(fmt::format("{}: a second <{}>, after the one at {}; remove one", document_.place(child),
                                         child.name(), document_.place(found)));
        found = child;
    }
    return XmlElement(document_, found);
}

std::string SceneReader::integrator() const {
    const XmlElement element = one("integrator");
    const XmlElement legacy = one("intersectionHandler");
    legacy.allow({}, true);
    if (legacy.exists())
        legacy.warn("<intersectionHandler> is without effect, as in the original renderer; write <integrator>");
    element.allow({}, true);
    if (overrides_.integrator) {
        check_integrator(*overrides_.integrator);
        return *overrides_.integrator;
    }
    const std::string name = element.text();
    if (name.empty())
        return "";
    try {
        check_integrator(name);
    } catch (const InputError& error) {
        element.fail_text(error.what());
    }
    return name;
}

RenderSettings SceneReader::settings() const {
    RenderSettings settings;
    settings.integrator = integrator();
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
    settings.majorant_scale = majorant.attribute_number("scale", settings.majorant_scale, positive);
    settings.majorant_cell = static_cast<int>(majorant.attribute_integer("cell", settings.majorant_cell, 0, 1024));

    const XmlElement filter = one("filter");
    filter.allow({}, true);
    if (const std::string name = filter.text(); name == "nearest")
        settings.filter = Filter::nearest;
    else if (name == "trilinear")
        settings.filter = Filter::trilinear;
    else if (filter.exists() && name != "stochastic")
        filter.fail_text(
            fmt::format("unknown filter '{}'{}", name, name_hint(name, {"nearest", "trilinear", "stochastic"})));
    return settings;
}

Camera SceneReader::camera() const {
    const XmlElement element = one("camera");
    element.allow({"x", "y", "z", "pitch", "yaw", "roll", "fov"});
    const auto number = [&](const char* name) { return element.attribute_number(name, 0.0, any_number); };
    Camera camera;
    camera.position = {number("x"), number("y"), number("z")};
    camera.pitch = number("pitch");
    camera.yaw = number("yaw");
    camera.roll = number("roll");
    camera.fov = element.attribute_number("fov", camera.fov,
                                          {0, 180, false, false, "an angle between 0 and 180 degrees, both excluded"});
    return camera;
}

void SceneReader::read_edge(const char* name, int& size, double& start, double& reference) const {
    const XmlElement element = one(name);
    element.allow({"startOffset", "reference"}, true);
    size = static_cast<int>(element.integer(size, 1, static_cast<long long>(max_pixels)));
    start = element.attribute_number("startOffset", 0.0, any_number);
    reference = element.attribute_number("reference", 0.0, not_negative);
    if (reference > 0.0)
        return;
    reference = size;
    if (start != 0.0)
        element.warn(
            fmt::format("startOffset without a reference; the reference frame is taken to be {} pixels", size));
}

Picture SceneReader::picture() const {
    Picture picture;
    read_edge("width", picture.width, picture.start_x, picture.reference_width);
    read_edge("height", picture.height, picture.start_y, picture.reference_height);
    return picture;
}

Rgb SceneReader::color(const XmlElement& element) const {
    const auto channel = [&](const char* name) { return element.attribute_number(name, 0.0, not_negative); };
    const double multiplier = element.attribute_number("multiplier", 1.0, not_negative);
    return Rgb(channel("r"), channel("g"), channel("b")) * multiplier;
}

void SceneReader::read_light(Scene& scene) const {
    const XmlElement element = one("light");
    element.allow({"x", "y", "z", "r", "g", "b", "multiplier"});
    const auto number = [&](const char* name) { return element.attribute_number(name, 0.0, any_number); };
    const glm::dvec3 direction(number("x"), number("y"), number("z"));
    const Rgb irradiance = color(element);
    if (irradiance == Rgb(0.0))
        return;
    const double largest = std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
    if (largest == 0.0)
        element.fail(
            "<light> has no direction; x, y, z point from the scene towards the light, e.g. x=\"0\" y=\"1\" z=\"0\"");
    scene.lights.push_back({glm::normalize(direction / largest), irradiance});
    if (!scene.settings.integrator.empty() && find_integrator(scene.settings.integrator)->nee == NEE_NONE)
        element.warn(fmt::format("{} cannot see a directional light, which is left out; ratioTracking renders it",
                                 scene.settings.integrator));
}

// A grid from the command line takes the place of whatever is here.
std::optional<Volume> SceneReader::volume() const {
    const XmlElement element = shape_element();
    Volume volume;
    if (element.exists() && element.name() == "sphere")
        volume.shape = sphere(element);
    else if (element.exists() && element.name() == "box")
        volume.shape = box(element);
    else if (element.exists())
        volume.shape = grid_file(element);
    if (overrides_.grid) {
        const GridFile* authored = std::get_if<GridFile>(&volume.shape);
        volume.shape = GridFile{*overrides_.grid, authored ? authored->grid : GridFile{}.grid};
    }
    read_coefficients(volume);
    if (element.exists() || overrides_.grid)
        return volume;
    warn_without_volume();
    return std::nullopt;
}

// The one densityField, sphere or box; missing if there is none or only a densityField that names no file.
XmlElement SceneReader::shape_element() const {
    XmlElement found(document_, {});
    for (const char* name : {"densityField", "sphere", "box"}) {
        const XmlElement element = one(name);
        if (!element.exists())
            continue;
        if (element.name() == "densityField") {
            element.allow({"baseDir", "grid"}, true);
            if (element.text().empty() && element.attribute("baseDir").empty())
                continue;
        }
        if (found.exists())
            element.fail(fmt::format("a <{}> beside the <{}> at {}; a scene has one medium: remove one", name,
                                     found.name(), found.place()));
        found = element;
    }
    return found;
}

Sphere SceneReader::sphere(const XmlElement& element) const {
    element.allow({"x", "y", "z", "radius"});
    const auto number = [&](const char* name) { return element.attribute_number(name, 0.0, any_number); };
    Sphere sphere;
    sphere.center = {number("x"), number("y"), number("z")};
    sphere.radius = element.attribute_number("radius", sphere.radius, positive);
    return sphere;
}

Box SceneReader::box(const XmlElement& element) const {
    element.allow({"x", "y", "z", "width", "height", "depth"});
    const auto number = [&](const char* name) { return element.attribute_number(name, 0.0, any_number); };
    const auto edge = [&](const char* name) { return element.attribute_number(name, 1.0, positive); };
    return {{number("x"), number("y"), number("z")}, {edge("width"), edge("height"), edge("depth")}};
}

// baseDir is the folder of the named file, with either kind of slash; relative paths start from the scene file.
GridFile SceneReader::grid_file(const XmlElement& element) const {
    const std::string name = element.text();
    if (name.empty())
        element.fail("<densityField> names no file; write one between the tags, e.g. cloud.nvdb");
    std::string path = element.attribute("baseDir");
    if (!path.empty() && path.back() != '/' && path.back() != '\\')
        path += '/';
    path += name;
    std::replace(path.begin(), path.end(), '\\', '/');
    GridFile file;
    file.path = (document_.file().parent_path() / path).lexically_normal();
    file.grid = element.attribute("grid", file.grid);
    if (file.grid.empty())
        element.fail_attribute("grid", "<densityField> grid: is empty; expected the name of a grid in the file");
    return file;
}

void SceneReader::read_coefficients(Volume& volume) const {
    const XmlElement sigma_a = one("sigma_a");
    const XmlElement sigma_s = one("sigma_s");
    sigma_a.allow({"unit"}, true);
    sigma_s.allow({"unit"}, true);
    volume.sigma_a = sigma_a.number(volume.sigma_a, not_negative);
    volume.sigma_s = sigma_s.number(volume.sigma_s, not_negative);
    volume.unit = unit(sigma_a, sigma_s, std::holds_alternative<GridFile>(volume.shape));

    const XmlElement g = one({"heyneygreenstein_g", "heynegreenstein_g"});
    g.allow({}, true);
    volume.g = g.number(volume.g, {-1, 1, false, false, "a number between -1 and 1, both excluded"});

    const XmlElement medium = one("medium");
    medium.allow(color_attributes);
    volume.Le = color(medium);

    const XmlElement path_density = one("lightRayDensityMultiplier");
    const XmlElement shadow_density = one("shadowRayDensityMultiplier");
    path_density.allow({}, true);
    shadow_density.allow({}, true);
    volume.density_scale = path_density.number(volume.density_scale, not_negative);
    if (shadow_density.number(volume.density_scale, not_negative) != volume.density_scale)
        shadow_density.warn(fmt::format("shadow rays cannot have a density of their own; they use "
                                        "lightRayDensityMultiplier, {}",
                                        volume.density_scale));
}

CoefficientUnit SceneReader::unit(const XmlElement& sigma_a, const XmlElement& sigma_s, bool is_grid) const {
    const auto read = [](const XmlElement& element) {
        const std::string name = element.attribute("unit", "voxel");
        if (name != "voxel" && name != "world")
            element.fail_attribute(
                "unit", fmt::format("<{}> unit: '{}' is unknown; expected voxel or world", element.name(), name));
        return name == "world" ? CoefficientUnit::world : CoefficientUnit::voxel;
    };
    const CoefficientUnit a = read(sigma_a);
    const CoefficientUnit s = read(sigma_s);
    if (!is_grid) {
        for (const XmlElement& element : {sigma_a, sigma_s})
            if (element.attribute("unit") == "voxel")
                element.warn("spheres and boxes have no voxels; the coefficient is taken per world unit");
        return CoefficientUnit::world;
    }
    if (sigma_a.exists() && sigma_s.exists() && a != s)
        sigma_s.fail(fmt::format("<sigma_s> and <sigma_a> (at {}) have different units; give both the same "
                                 "(unit=\"voxel\" is the default)",
                                 sigma_a.place()));
    return sigma_a.exists() ? a : s;
}

void SceneReader::warn_without_volume() const {
    for (const char* name : {"sigma_a", "sigma_s", "heyneygreenstein_g", "heynegreenstein_g", "medium"})
        if (const XmlElement element = one(name); element.exists()) {
            element.warn(fmt::format("<{}> is without effect: the scene has no densityField, sphere or box", name));
            return;
        }
}

// What asks for something that this renderer does not do, each with what is done in its place.
void SceneReader::read_without_effect() const {
    const XmlElement emission = one("emission");
    emission.allow(color_attributes);
    if (color(emission) != Rgb(0.0))
        emission.warn("emission by a temperature grid is not rendered in this version; <medium> glows uniformly");

    const XmlElement step = one("stepSize");
    step.allow({"min", "max", "multiplier"});
    for (const char* name : {"min", "max", "multiplier"})
        step.attribute_number(name, 0.0, not_negative);
    if (step.exists())
        step.warn("stepSize is without effect: free flights are sampled exactly, without steps");

    const XmlElement sampling = one("importanceSampling");
    sampling.allow({}, true);
    if (sampling.boolean(false))
        sampling.warn("importanceSampling is without effect: the original's weights were wrong; paths are sampled by "
                      "the phase function");

    const XmlElement models = one("models");
    models.allow({}, false, {"model"});
    for (const pugi::xml_node node : document_.root().child("models").children("model")) {
        const XmlElement model(document_, node);
        model.allow({"baseDir"}, true);
        model.warn("OBJ models are not rendered in this version; <sphere> and <box> hold homogeneous media");
    }

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

std::string read_file(const std::filesystem::path& file) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(file, error);
    if (!std::filesystem::exists(status))
        throw InputError(fmt::format("{}: no such scene file", file.string()));
    if (std::filesystem::is_directory(status))
        throw InputError(fmt::format("{}: is a directory; expected a scene file (.xml)", file.string()));
    std::ifstream stream(file, std::ios::binary);
    if (!stream)
        throw InputError(fmt::format("{}: cannot be opened for reading; check its permissions", file.string()));
    constexpr std::size_t limit = 16 << 20;
    std::string text(limit + 1, '\0');
    stream.read(text.data(), std::streamsize(text.size()));
    text.resize(std::size_t(stream.gcount()));
    if (text.size() > limit)
        throw InputError(fmt::format("{}: larger than 16 MiB; expected a scene file (.xml)", file.string()));
    return text;
}

} // namespace

std::vector<std::string> integrator_names() {
    std::vector<std::string> names;
    for (const Integrator& integrator : integrators())
        names.push_back(integrator.name);
    return names;
}

void check_integrator(const std::string& name) {
    if (find_integrator(name))
        return;
    const std::vector<std::string> known = integrator_names();
    if (std::find(retired_integrators.begin(), retired_integrators.end(), name) != retired_integrators.end())
        throw InputError(
            fmt::format("integrator {} is not available in this version; use {}", name, fmt::join(known, " or ")));
    throw InputError(fmt::format("unknown integrator '{}'{}", name, name_hint(name, known)));
}

Scene parse_scene(const std::string& xml, const std::filesystem::path& file, const Defines& defines,
                  const SceneOverrides& overrides) {
    XmlDocument document(xml, file, defines, "options");
    return SceneReader(document, overrides).read();
}

Scene load_scene(const std::filesystem::path& file, const Defines& defines, const SceneOverrides& overrides) {
    return parse_scene(read_file(file), file, defines, overrides);
}

void resize_picture(Picture& picture, std::optional<int> width, std::optional<int> height) {
    if (!width && !height)
        return;
    const auto scaled = [](int edge, int to, int from) { return std::max(1.0, std::round(double(edge) * to / from)); };
    const double new_width = width ? *width : scaled(picture.width, *height, picture.height);
    const double new_height = height ? *height : scaled(picture.height, *width, picture.width);
    if (!(new_width >= 1 && new_width <= max_pixels && new_height >= 1 && new_height <= max_pixels))
        throw InputError(fmt::format("a picture of {}x{} pixels is out of range; each edge is 1 to {}", new_width,
                                     new_height, max_pixels));
    const double scale_x = new_width / picture.width;
    const double scale_y = new_height / picture.height;
    picture.width = static_cast<int>(new_width);
    picture.height = static_cast<int>(new_height);
    picture.start_x *= scale_x;
    picture.start_y *= scale_y;
    picture.reference_width *= scale_x;
    picture.reference_height *= scale_y;
}

} // namespace vkvol
