#include "scene.h"

#include <cctype>

namespace vkvol {

namespace {

void add_once(std::vector<std::string>& names, const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end())
        names.push_back(name);
}

} // namespace

std::vector<std::string> light_groups(const Scene& scene) {
    std::vector<std::string> groups;
    for (const Light& light : scene.lights)
        if (!group_of(light).empty())
            add_once(groups, group_of(light));
    if (!scene.background_group.empty())
        add_once(groups, scene.background_group);
    return groups;
}

std::string trouble_with_layers(const Scene& scene) {
    if (scene.motion_blur && (scene.layers & layer_position))
        return "position: what moves has many; leave the layer out, or <motionBlur>";
    if (!reads_flux(scene.camera) || (scene.layers & layers_of_rays) == 0)
        return "";
    std::string names;
    for (std::size_t i = 0; i < layer_names().size(); ++i)
        if (scene.layers & layers_of_rays & 1u << i)
            names += (names.empty() ? "" : ", ") + layer_names()[i];
    return names + (names.find(',') == std::string::npos ? ": is a layer" : ": are layers") +
           " of a camera's rays, and a sensor of flux has some in all directions; leave them out";
}

std::uint32_t place_among(const std::vector<std::string>& names, const std::string& name) {
    return static_cast<std::uint32_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

// As names of channels may be, in which a dot parts a layer from its channel.
std::string medium_name(const Scene& scene, std::size_t volume) {
    std::string name = scene.volumes[volume].name;
    std::replace_if(
        name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c) && c != '_' && c != '-' && c < 128; },
        '_');
    return name.empty() ? "volume" + std::to_string(volume + 1) : name;
}

std::vector<std::string> medium_names(const Scene& scene) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < scene.volumes.size(); ++i)
        add_once(names, medium_name(scene, i));
    return names;
}

} // namespace vkvol
