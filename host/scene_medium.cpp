// The part of SceneReader that reads the medium: its shape and its coefficients.
#include <algorithm>
#include <fmt/format.h>

#include "scene_reader.h"

namespace vkvol {

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
    volume.temperature = temperature_emission(std::holds_alternative<GridFile>(volume.shape));

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

TemperatureEmission SceneReader::temperature_emission(bool is_grid) const {
    const XmlElement element = one("emission");
    const auto blackbody_only = {"temperatureScale", "temperatureOffset", "temperatureCutoff", "referenceTemperature"};
    std::vector<std::string> allowed = {"r", "g", "b", "multiplier", "model", "grid"};
    allowed.insert(allowed.end(), blackbody_only.begin(), blackbody_only.end());
    element.allow(allowed);
    TemperatureEmission emission;
    emission.color = color(element);
    emission.grid = element.attribute("grid", emission.grid);
    const std::string model = element.attribute("model", "color");
    if (model == "blackbody")
        emission.model = TemperatureEmission::Model::blackbody;
    else if (model != "color")
        element.fail_attribute("model",
                               fmt::format("<emission> model: '{}' is unknown; expected color (the grid's value "
                                           "times r, g, b) or blackbody",
                                           model));
    emission.scale = element.attribute_number("temperatureScale", emission.scale, any_number);
    emission.offset = element.attribute_number("temperatureOffset", emission.offset, any_number);
    emission.cutoff = element.attribute_number("temperatureCutoff", emission.cutoff, not_negative);
    emission.reference = element.attribute_number("referenceTemperature", emission.reference, positive);
    if (emission.model == TemperatureEmission::Model::color)
        for (const char* name : blackbody_only)
            if (!element.attribute(name).empty())
                element.fail_attribute(name,
                                       fmt::format("<emission> {}: has a meaning with model=\"blackbody\" only", name));
    if (element.exists() && emission.color != Rgb(0.0) && !is_grid)
        element.warn(
            "spheres and boxes have no temperature grid: <emission> is without effect; <medium> glows uniformly");
    return emission;
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

} // namespace vkvol
