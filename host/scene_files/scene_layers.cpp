// The part of SceneReader that reads densities by height.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "layers.h"
#include "scene_reader.h"

namespace vkvol {

namespace {

// Above the bottom of what is everywhere: beyond, there is 2e-9 of it.
constexpr double usual_scale_heights = 20.0;

int axis_of(const XmlElement& element) {
    const std::string up = element.attribute("up", "y");
    if (up != "x" && up != "y" && up != "z")
        element.fail_attribute("up",
                               fmt::format("<layers> up: '{}' is no axis of the volume; expected x, y or z, and a "
                                           "<transform> for other directions",
                                           up));
    return up[0] - 'x';
}

} // namespace

Layers SceneReader::exponential_layers(const XmlElement& element, const Volume& volume) const {
    if (!element.has("scaleHeight"))
        element.fail(
            "<layers> lacks scaleHeight, over which the density falls to 1 / e, and has no <layer> either; give "
            "it one or the other");
    Layers layers;
    layers.axis = axis_of(element);
    layers.scale_height = element.attribute_number("scaleHeight", 1.0, length);
    layers.reference = element.attribute_number("height", 0.0, coordinate);
    const auto* box = std::get_if<Box>(&volume.shape);
    const double low = box ? box->center[layers.axis] - 0.5 * box->size[layers.axis] : layers.reference;
    layers.bottom = element.attribute_number("bottom", low, coordinate);
    const double high = box ? low + box->size[layers.axis] : layers.bottom + usual_scale_heights * layers.scale_height;
    layers.top = element.attribute_number("top", high, coordinate);
    const double lowest = box ? std::max(layers.bottom, low) : layers.bottom;
    if ((layers.reference - lowest) / layers.scale_height > std::log(no_limit))
        element.fail("<layers> are denser at the bottom than single precision has numbers for; raise bottom or "
                     "scaleHeight, or lower height");
    return layers;
}

// Heights become those above the lowest.
Layers SceneReader::layer_table(const XmlElement& element, Volume& volume) const {
    for (const char* name : {"scaleHeight", "height", "bottom", "top"})
        if (element.has(name))
            element.fail_attribute(name, fmt::format("<layers> {}: each <layer> has its height and its density; remove "
                                                     "it, or them",
                                                     name));
    ValueMap map;
    const bool is_transfer = !find({"layers"}).child("layer").attribute("sigma_t").empty();
    for (const pugi::xml_node node : find({"layers"}).children("layer")) {
        const XmlElement layer(document_, node);
        map.points.push_back(map_point(layer, "height", coordinate, is_transfer));
        check_points(map.points, "height", layer);
    }
    Layers layers;
    layers.axis = axis_of(element);
    layers.bottom = map.points.front().value;
    layers.top = map.points.back().value;
    for (MapPoint& point : map.points)
        point.value -= layers.bottom;
    if (is_transfer)
        take_transfer(volume, std::move(map));
    else
        volume.map = std::move(map);
    return layers;
}

void SceneReader::read_layers(Volume& volume) const {
    const XmlElement element = one("layers");
    const bool may_have = std::holds_alternative<Box>(volume.shape) || is_everywhere(volume);
    if (!element.exists() || (!may_have && is_behind_shape("layers")))
        return;
    element.allow({"up", "scaleHeight", "height", "bottom", "top"}, false, {"layer"});
    if (!may_have && overrides_.grid) {
        element.warn("<layers> are left out: the density is that of --grid");
        return;
    }
    if (!may_have)
        element.fail("<layers> are for a <box>, or <everywhere>; remove them, or take one of these");
    if (volume.noise && scope_of("noise") == scope_of("layers"))
        element.fail("<layers> beside <noise>; a volume has one density: remove one");
    if (volume.noise && scope_of("noise") < scope_of("layers")) // the nearer one counts
        return;
    volume.noise.reset();
    const bool has_table = !find({"layers"}).child("layer").empty();
    volume.layers = has_table ? layer_table(element, volume) : exponential_layers(element, volume);
    if (!(layer_box(volume).size[volume.layers->axis] > 0.0))
        element.fail(
            fmt::format("<layers> reach from {:g} to {:g}, and nothing of that is in the volume; let them begin "
                        "below where they end, and within the box",
                        volume.layers->bottom, volume.layers->top));
}

} // namespace vkvol
