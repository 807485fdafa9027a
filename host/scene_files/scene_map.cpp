// The part of SceneReader that reads maps from a grid's values to densities and colours.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "scene_reader.h"

namespace vkvol {

namespace {

constexpr std::size_t most_points = 256;

// The values of a grid, as they are stored, are at least 0.
constexpr Limits grid_value{
    0.0, no_limit, true, true,
    "a number >= 0, as grids' values below 0 count as 0 (add 1000 to Hounsfield units where the grid is written)"};
constexpr Limits share_of_one{0.0, 1.0, true, true, "numbers from 0 to 1"};
constexpr Limits radiance{0.0, brightest_light, true, true, "numbers from 0 to 1e12"};

} // namespace

// After the last of them has been added.
void SceneReader::check_points(const std::vector<MapPoint>& points, const char* value, const XmlElement& last) const {
    if (points.size() > most_points)
        last.fail(fmt::format("more than {} points; leave some out", most_points));
    if (points.size() < 2)
        return;
    const MapPoint &from = points[points.size() - 2], &to = points.back();
    const bool third = points.size() > 2 && points[points.size() - 3].value == to.value;
    if (to.value < from.value || third)
        last.fail_attribute(value, fmt::format("<{}> {}: {:g} after {:g}; values ascend from one to the next, and two "
                                               "that are alike make a step",
                                               last.name(), value, to.value, from.value));
    const double values = to.value - from.value;
    const double most = std::max({std::abs(to.density - from.density), 1.0, to.emission.x, to.emission.y, to.emission.z,
                                  from.emission.x, from.emission.y, from.emission.z});
    if (values > 0.0 && !(most / values <= no_limit))
        last.fail(fmt::format("<{}> changes too much within {:g} of {} for single precision; give both the same, which "
                              "makes a step",
                              last.name(), values, value));
}

// A map's point: it has a density in a density map or layers, and in a transfer function or layers with colours
// sigma_t, albedo and emission.
MapPoint SceneReader::map_point(const XmlElement& element, const char* value, const Limits& limits,
                                bool is_transfer) const {
    const char* amount = is_transfer ? "sigma_t" : "density";
    if (is_transfer)
        element.allow({value, amount, "albedo", "emission"});
    else
        element.allow({value, amount});
    for (const char* needed : {value, amount})
        if (!element.has(needed))
            element.fail(fmt::format("<{}> lacks {}", element.name(), needed));
    MapPoint point;
    point.value = element.attribute_number(value, 0.0, limits);
    point.density = element.attribute_number(amount, 0.0, not_negative);
    point.albedo = channels(element, "albedo", share_of_one, point.albedo);
    point.emission = channels(element, "emission", radiance, point.emission);
    return point;
}

// In the element of that name.
std::vector<MapPoint> SceneReader::map_points(const char* name, bool is_transfer) const {
    std::vector<MapPoint> points;
    for (const pugi::xml_node node : find({name}).children("point")) {
        const XmlElement element(document_, node);
        points.push_back(map_point(element, "value", grid_value, is_transfer));
        check_points(points, "value", element);
    }
    return points;
}

// The map of values v to gain v + offset, where that is more than 0 and v is not below the threshold; else to 0.
ValueMap SceneReader::ramp(const XmlElement& element) const {
    const double gain = element.attribute_number("gain", 1.0, any_number);
    const double offset = element.attribute_number("offset", 0.0, any_number);
    const double threshold = element.attribute_number("threshold", 0.0, grid_value);
    ValueMap map;
    if (threshold > 0.0)
        map.points = {{0.0, 0.0}, {threshold, 0.0}};
    map.points.push_back({threshold, std::max(gain * threshold + offset, 0.0)});
    const double root = gain != 0.0 ? -offset / gain : 0.0;
    if (root > no_limit || map.points.back().density > no_limit)
        element.fail(fmt::format("<densityMap> ends beyond {:g}, and single precision with it; bring gain, offset and "
                                 "threshold nearer to 1",
                                 no_limit));
    if (root > threshold)
        map.points.push_back({root, 0.0});
    map.rise = std::max(gain, 0.0);
    return map;
}

ValueMap SceneReader::density_map(const XmlElement& element) const {
    element.allow({"gain", "offset", "threshold"}, false, {"point"});
    ValueMap map;
    map.points = map_points("densityMap", false);
    if (!map.exists())
        return ramp(element);
    for (const char* name : {"gain", "offset", "threshold"})
        if (element.has(name))
            element.fail_attribute(name, fmt::format("<densityMap> {}: its points say all; remove it, or them", name));
    return map;
}

ValueMap SceneReader::transfer_function(const XmlElement& element) const {
    element.allow({"unit"}, false, {"point"});
    ValueMap map;
    map.points = map_points("transferFunction", true);
    if (!map.exists())
        element.fail("<transferFunction> has no points; give it some, e.g. <point value=\"0.5\" sigma_t=\"2\" "
                     "albedo=\"0.9 0.6 0.4\"/>");
    return map;
}

void SceneReader::read_map(Volume& volume) const {
    const XmlElement density = one("densityMap"), transfer = one("transferFunction");
    if (!density.exists() && !transfer.exists())
        return;
    if (density.exists() && transfer.exists() && scope_of("densityMap") == scope_of("transferFunction"))
        transfer.fail(
            fmt::format("a <transferFunction> beside the <densityMap> at {}; a grid's values are mapped once: "
                        "remove one",
                        density.place()));
    const bool by_density = scope_of("densityMap") < scope_of("transferFunction"); // the nearer one counts
    const XmlElement& element = by_density ? density : transfer;
    const bool has_grid = std::holds_alternative<GridFile>(volume.shape);
    if (!has_grid && is_behind_shape(by_density ? "densityMap" : "transferFunction"))
        return;
    if (!has_grid)
        element.fail(fmt::format("<{}> maps the values of a <densityField>, and this volume has none; remove it",
                                 element.name()));
    if (by_density) {
        volume.map = density_map(density);
        return;
    }
    take_transfer(volume, transfer_function(transfer));
    volume.unit = unit(transfer, transfer, true);
}

void SceneReader::take_transfer(Volume& volume, ValueMap map) const {
    for (const char* name : {"sigma_a", "sigma_s"})
        if (const XmlElement other = one(name);
            other.exists() && scope_of(name) <= std::min(scope_of("transferFunction"), scope_of("layers")))
            other.fail(fmt::format("<{}> beside points that have sigma_t and albedo; remove one", name));
    map.is_transfer = true;
    volume.map = std::move(map);
    volume.sigma_a = Rgb(0.0);
    volume.sigma_s = Rgb(1.0);
}

} // namespace vkvol
