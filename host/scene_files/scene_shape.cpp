// The part of SceneReader that reads where the medium is, and its procedural density.
#include <algorithm>
#include <fmt/format.h>

#include "integrators.h"
#include "scene_reader.h"

namespace vkvol {

namespace {

constexpr const char* shape_names[] = {"densityField", "sphere", "box", "everywhere", "models"};

bool asks_for_shape(const XmlElement& element, pugi::xml_node node) {
    if (element.name() == "densityField")
        return !element.text().empty() || !element.attribute("baseDir").empty();
    return element.name() != "models" || node.child("model");
}

bool has_shape(XmlDocument& document, pugi::xml_node scope) {
    return std::any_of(std::begin(shape_names), std::end(shape_names), [&](const char* name) {
        const pugi::xml_node node = find_one(document, scope, {name});
        const XmlElement element(document, node);
        return element.exists() && asks_for_shape(element, node);
    });
}

} // namespace

// A grid from the command line takes the place of whatever is here, and has none in the file.
std::optional<Shape> SceneReader::shape(const std::string& integrator, std::string& place) const {
    const XmlElement element = shape_element(integrator);
    std::optional<Shape> shape;
    if (element.exists() && element.name() == "sphere")
        shape = sphere(element);
    else if (element.exists() && element.name() == "box")
        shape = box(element);
    else if (element.exists() && element.name() == "everywhere")
        shape = everywhere(element);
    else if (element.exists() && element.name() == "models")
        shape = mesh_files();
    else if (element.exists())
        shape = grid_file(element);
    if (element.exists() && !overrides_.grid)
        place = element.place();
    if (overrides_.grid) {
        const GridFile* authored = shape ? std::get_if<GridFile>(&*shape) : nullptr;
        if (shape && !authored)
            element.warn(fmt::format("<{}> is left out: the medium is that of --grid, whose coefficients are per voxel "
                                     "unless they name another unit",
                                     element.name()));
        shape = GridFile{*overrides_.grid, authored ? authored->grid : GridFile{}.grid};
    }
    return shape;
}

// The one densityField, sphere, box or models; missing if there is none, or one that asks for nothing. Between models
// and a density field the original's integrators decided by what they could read, and so do they here.
XmlElement SceneReader::shape_element(const std::string& integrator) const {
    // One that names a grid and no file is --grid's, or forgot it.
    XmlElement without_file(document_, {});
    for (const pugi::xml_node scope : scopes_) {
        const pugi::xml_node node = find_one(document_, scope, {"densityField"});
        if (const XmlElement element(document_, node);
            !without_file.exists() && !asks_for_shape(element, node) &&
            (!element.attribute("grid").empty() || !element.attribute("velocity").empty()))
            without_file = element;
        if (const XmlElement element = shape_element(scope, integrator); element.exists()) {
            if (without_file.exists() && !overrides_.grid)
                without_file.fail(fmt::format("<densityField> names a grid and no file, and the volume is that of the "
                                              "<{}> at {}; write the file between the tags, or remove one",
                                              element.name(), element.place()));
            return element;
        }
    }
    return without_file;
}

std::size_t SceneReader::scope_of(const char* name) const {
    std::size_t i = 0;
    while (i < scopes_.size() && !find_one(document_, scopes_[i], {name}))
        ++i;
    return i;
}

bool SceneReader::is_behind_shape(const char* name) const {
    std::size_t shape = 0;
    while (shape < scopes_.size() && !has_shape(document_, scopes_[shape]))
        ++shape;
    return shape < scope_of(name);
}

XmlElement SceneReader::shape_element(pugi::xml_node scope, const std::string& integrator) const {
    // Without a name the original takes deltaTracking.
    const Integrator* row = find_integrator(integrator.empty() ? "deltaTracking" : integrator);
    const bool of_thesis = row && row->origin != Integrator::Origin::own;
    XmlElement found(document_, {});
    for (const char* name : shape_names) {
        const pugi::xml_node node = find_one(document_, scope, {name});
        const XmlElement element(document_, node);
        if (!element.exists())
            continue;
        if (element.name() == "densityField")
            element.allow({"baseDir", "grid", "velocity", "framesPerSecond"}, true);
        if (element.name() == "models")
            element.allow({}, false, {"model"});
        if (!asks_for_shape(element, node))
            continue;
        if (element.name() == "models") {
            if (of_thesis && found.exists() && found.name() == "densityField") {
                const bool takes_models = row->origin == Integrator::Origin::thesis_models;
                const XmlElement& left_out = takes_models ? found : element;
                left_out.warn(fmt::format("<{}> is left out: {} renders {}, as in the original renderer",
                                          left_out.name(),
                                          integrator.empty() ? "a scene without an integrator's name" : row->name,
                                          takes_models ? "models" : "density fields"));
                if (takes_models)
                    found = element;
                continue;
            }
        }
        if (found.exists())
            element.fail(fmt::format(
                "a <{}> beside the <{}> at {}; a volume has one shape: remove one, or give each a <volume> of its own",
                name, found.name(), found.place()));
        found = element;
    }
    return found;
}

Sphere SceneReader::sphere(const XmlElement& element) const {
    element.allow({"x", "y", "z", "radius"});
    const auto number = [&](const char* name) { return element.attribute_number(name, 0.0, coordinate); };
    Sphere sphere;
    sphere.center = {number("x"), number("y"), number("z")};
    sphere.radius = element.attribute_number("radius", sphere.radius, length);
    return sphere;
}

Box SceneReader::box(const XmlElement& element) const {
    element.allow({"x", "y", "z", "width", "height", "depth"});
    const auto number = [&](const char* name) { return element.attribute_number(name, 0.0, coordinate); };
    const auto edge = [&](const char* name) { return element.attribute_number(name, 1.0, length); };
    return {{number("x"), number("y"), number("z")}, {edge("width"), edge("height"), edge("depth")}};
}

Everywhere SceneReader::everywhere(const XmlElement& element) const {
    element.allow({});
    return {};
}

// baseDir is the folder of the named file, with either kind of slash; relative paths start from the scene file.
std::filesystem::path SceneReader::file_path(const XmlElement& element, const char* example) const {
    const std::string name = element.text();
    if (name.empty())
        element.fail(fmt::format("<{}> names no file; write one between the tags, e.g. {}", element.name(), example));
    return file_path(element, name);
}

// Beside the scene, or below `baseDir`.
std::filesystem::path SceneReader::file_path(const XmlElement& element, const std::string& name) const {
    std::string path = element.attribute("baseDir");
    if (!path.empty() && path.back() != '/' && path.back() != '\\')
        path += '/';
    path += name;
    std::replace(path.begin(), path.end(), '\\', '/');
    if (one_line(path) != path)
        element.fail(fmt::format("<{}> names a file that is very long or has control characters: '{}'; rename the file",
                                 element.name(), path.substr(0, 60)));
    const std::filesystem::path whole = document_.file().parent_path() / path, shorter = whole.lexically_normal();
    // Beyond a link to a folder .. is another one than before it, and means what it means elsewhere.
    std::error_code error;
    return std::filesystem::exists(whole, error) && !std::filesystem::equivalent(whole, shorter, error) ? whole
                                                                                                        : shorter;
}

GridFile SceneReader::grid_file(const XmlElement& element) const {
    GridFile file;
    if (!overrides_.grid) // whose file it is then
        file.path = file_path(element, "cloud.nvdb");
    for (const std::string& name : {element.text(), file.path.filename().string()})
        if (const auto found = overrides_.grids.find(name); found != overrides_.grids.end() && !file.memory)
            file.memory = found->second;
    file.grid = element.attribute("grid", file.grid);
    if (file.grid.empty())
        element.fail_attribute("grid", "<densityField> grid: is empty; expected the name of a grid in the file");
    return file;
}

// Drift of the shape that is a density field, in its file or in that of --grid.
Drift SceneReader::drift(const std::string& integrator) const {
    const XmlElement element = shape_element(integrator);
    if (!element.exists() || element.name() != "densityField")
        return {};
    Drift drift;
    drift.grid = element.attribute("velocity");
    const double rate =
        element.attribute_number("framesPerSecond", 24.0, {1e-3, 1e6, true, true, "a number from 0.001 to 1000000"});
    if (drift.grid.empty() && element.has("framesPerSecond"))
        element.fail_attribute("framesPerSecond", "<densityField> framesPerSecond: of which velocities? Add "
                                                  "velocity=\"v\", the name of a grid in the file, or remove it");
    drift.seconds = document_.later() / rate;
    if (!drift.grid.empty() && document_.root().child("motionBlur").empty())
        element.warn("<densityField> velocity is without effect: only <motionBlur> has other times in a picture");
    return drift;
}

// All models; the original kept the last one alone.
MeshFiles SceneReader::mesh_files() const {
    MeshFiles files;
    pugi::xml_node models; // those that are asked for
    for (std::size_t i = 0; i < scopes_.size() && !models.child("model"); ++i)
        models = find_one(document_, scopes_[i], {"models"});
    for (const pugi::xml_node node : models.children("model")) {
        const XmlElement model(document_, node);
        model.allow({"baseDir"}, true);
        files.paths.push_back(file_path(model, "sphere.obj"));
    }
    return files;
}

std::optional<Noise> SceneReader::noise(const Volume& volume) const {
    const bool is_grid = std::holds_alternative<GridFile>(volume.shape);
    const XmlElement element = one("noise");
    if (!element.exists() || ((is_grid || is_everywhere(volume)) && is_behind_shape("noise")))
        return std::nullopt;
    element.allow({"frequency", "octaves", "gain", "lacunarity"});
    Noise noise;
    noise.frequency = element.attribute_number("frequency", noise.frequency, positive);
    noise.octaves = static_cast<int>(element.attribute_integer("octaves", noise.octaves, 1, 16));
    noise.gain = element.attribute_number("gain", noise.gain, {0, 1, true, true, "a number from 0 to 1"});
    noise.lacunarity =
        element.attribute_number("lacunarity", noise.lacunarity, {1, no_limit, true, true, "a number >= 1"});
    if (is_everywhere(volume))
        element.fail("<noise> is for spheres, boxes and models, and would have no end in <everywhere>; use a <box>");
    if (!is_grid)
        return noise;
    if (!overrides_.grid)
        element.fail("<noise> is for spheres, boxes and models, and a <densityField> has its own density; remove one");
    element.warn("<noise> is left out: the density is that of --grid");
    return std::nullopt;
}

} // namespace vkvol
