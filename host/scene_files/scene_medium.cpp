// The part of SceneReader that reads the medium's coefficients.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <sstream>

#include "scene_reader.h"

namespace vkvol {

std::optional<Volume> SceneReader::volume(const std::string& integrator) const {
    Volume volume;
    const std::optional<Shape> authored = shape(integrator, volume.place);
    if (authored)
        volume.shape = *authored;
    volume.drift = drift(integrator);
    volume.noise = noise(volume);
    read_coefficients(volume);
    if (authored)
        return volume;
    warn_without_volume();
    return std::nullopt;
}

// A number, or one for each channel.
Rgb SceneReader::coefficient(const char* name, const Rgb& fallback) const {
    const XmlElement element = one(name);
    element.allow({"unit", "r", "g", "b"}, true);
    if (std::istringstream words(element.text()); std::distance(std::istream_iterator<std::string>(words), {}) > 1)
        element.fail_text(fmt::format("<{}> has several numbers; one for each channel is <{} r=\"...\" g=\"...\" "
                                      "b=\"...\"/>",
                                      name, name));
    if (!element.has("r") && !element.has("g") && !element.has("b"))
        return element.exists() ? Rgb(element.number(0.0, not_negative)) : fallback;
    if (!element.text().empty())
        element.fail_text(fmt::format("<{}> has both a number and r, g, b; keep one of them", name));
    const auto channel = [&](const char* letter) {
        if (!element.has(letter))
            element.fail(fmt::format("<{}> lacks {}; all of r, g, b are needed", name, letter));
        return element.attribute_number(letter, 0.0, not_negative);
    };
    return {channel("r"), channel("g"), channel("b")};
}

void SceneReader::read_coefficients(Volume& volume) const {
    volume.sigma_a = coefficient("sigma_a", volume.sigma_a);
    volume.sigma_s = coefficient("sigma_s", volume.sigma_s);
    volume.unit = unit(one("sigma_a"), one("sigma_s"), std::holds_alternative<GridFile>(volume.shape));

    read_phase(volume);

    const XmlElement medium = one("medium");
    medium.allow(color_attributes);
    volume.Le = color(medium);
    const bool is_grid = std::holds_alternative<GridFile>(volume.shape);
    volume.temperature = temperature_emission(is_grid);
    volume.albedo_grid = albedo_grid(is_grid);
    read_map(volume);
    read_layers(volume);
    warn_of_glow_without_absorption(volume);

    const XmlElement path_density = one("lightRayDensityMultiplier");
    const XmlElement shadow_density = one("shadowRayDensityMultiplier");
    path_density.allow({}, true);
    shadow_density.allow({}, true);
    volume.density_scale = path_density.number(volume.density_scale, not_negative);
    if (shadow_density.number(volume.density_scale, not_negative) != volume.density_scale)
        shadow_density.warn(fmt::format("shadow rays cannot have a density of their own; they use "
                                        "lightRayDensityMultiplier, {}",
                                        volume.density_scale));
    check_extinction(volume);
}

// What multiplies the density must neither overflow nor vanish in single precision.
void SceneReader::check_extinction(const Volume& volume) const {
    const Rgb sigma_t = (volume.sigma_a + volume.sigma_s) * volume.density_scale;
    const double most = std::max({sigma_t.x, sigma_t.y, sigma_t.z});
    if (most == 0.0 || (most >= smallest_number && most <= no_limit))
        return;
    XmlElement cause = one("sigma_s");
    for (const char* name : {"sigma_a", "lightRayDensityMultiplier"})
        if (const XmlElement other = one(name); other.exists())
            cause = other;
    cause.fail(fmt::format("sigma_a and sigma_s, times lightRayDensityMultiplier, amount to {:g}; expected 0, or from "
                           "{:g} to {:g}",
                           most, smallest_number, no_limit));
}

TemperatureEmission SceneReader::temperature_emission(bool is_grid) const {
    const XmlElement element = one("emission");
    const auto blackbody_only = {"temperatureScale", "temperatureOffset", "temperatureCutoff", "referenceTemperature",
                                 "brightness"};
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
    constexpr Limits kelvin{0.0, hottest_kelvin, true, true, "a number from 0 to 1e9"};
    emission.scale = element.attribute_number("temperatureScale", emission.scale, any_number);
    emission.offset =
        element.attribute_number("temperatureOffset", emission.offset,
                                 {-hottest_kelvin, hottest_kelvin, true, true, "a number from -1e9 to 1e9"});
    emission.cutoff = element.attribute_number("temperatureCutoff", emission.cutoff, kelvin);
    emission.reference = element.attribute_number("referenceTemperature", emission.reference,
                                                  {0.0, hottest_kelvin, false, true, "a number > 0, at most 1e9"});
    const std::string brightness = element.attribute("brightness", "planck");
    if (brightness != "planck" && brightness != "peak")
        element.fail_attribute(
            "brightness", fmt::format("<emission> brightness: '{}' is unknown; expected planck or peak", brightness));
    if (brightness == "peak" && element.has("referenceTemperature"))
        element.fail_attribute("referenceTemperature", "<emission> referenceTemperature: has a meaning with "
                                                       "brightness=\"planck\" only");
    if (brightness == "peak")
        emission.reference = 0.0;
    if (emission.model == TemperatureEmission::Model::color)
        for (const char* name : blackbody_only)
            if (!element.attribute(name).empty())
                element.fail_attribute(name,
                                       fmt::format("<emission> {}: has a meaning with model=\"blackbody\" only", name));
    if (element.exists() && emission.color != Rgb(0.0) && !is_grid)
        element.warn("spheres, boxes and models have no temperature grid: <emission> is without effect; <medium> glows "
                     "uniformly");
    return is_grid ? emission : TemperatureEmission();
}

std::string SceneReader::albedo_grid(bool is_grid) const {
    const XmlElement element = one("albedo");
    element.allow({"grid"});
    if (!element.exists())
        return {};
    const std::string grid = element.attribute("grid");
    if (grid.empty())
        element.fail(
            "<albedo> lacks grid, the name of a grid in the density field's file, such as Cd; a constant albedo "
            "is sigma_s / (sigma_a + sigma_s)");
    if (!is_grid)
        element.warn("spheres, boxes and models have no grids: <albedo> is without effect");
    return is_grid ? grid : "";
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
                element.warn("only grids have voxels; the coefficient is taken per world unit");
        return CoefficientUnit::world;
    }
    if (sigma_a.exists() && sigma_s.exists() && a != s)
        sigma_s.fail(fmt::format("<sigma_s> and <sigma_a> (at {}) have different units; give both the same "
                                 "(unit=\"voxel\" is the default)",
                                 sigma_a.place()));
    return sigma_a.exists() ? a : s;
}

void SceneReader::warn_of_glow_without_absorption(const Volume& volume) const {
    if (volume.sigma_a != Rgb(0.0) || has_albedo_of_place(volume))
        return;
    for (const auto& [name, radiance] : {std::pair{"medium", volume.Le}, {"emission", volume.temperature.color}})
        if (radiance != Rgb(0.0))
            one(name).warn(
                fmt::format("<{}> is without effect: what is absorbed is what glows, and sigma_a is 0", name));
}

void SceneReader::warn_without_volume() const {
    for (const char* name : {"sigma_a", "sigma_s", "heyneygreenstein_g", "heynegreenstein_g", "phase", "medium",
                             "albedo", "densityMap", "transferFunction", "noise", "layers"})
        if (const XmlElement element = one(name); element.exists()) {
            element.warn(
                fmt::format("<{}> is without effect: the scene has no densityField, sphere, box or model", name));
            return;
        }
}

} // namespace vkvol
