#include "scene.h"

#include <algorithm>
#include <cctype>
#include <unordered_set>
#include <utility>

namespace vkvol {

namespace {

// In the order in which they come first. There may be as many as volumes or lights.
class Names {
public:
    void add(const std::string& name) {
        if (known_.insert(name).second)
            names_.push_back(name);
    }
    std::vector<std::string> take() { return std::move(names_); }

private:
    std::unordered_set<std::string> known_;
    std::vector<std::string> names_;
};

} // namespace

std::vector<std::string> light_groups(const Scene& scene) {
    std::vector<std::pair<std::size_t, std::string>> of_lights; // by what comes before
    for (const BlackElement& element : scene.black)
        of_lights.emplace_back(element.before, element.group);
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
        of_lights.emplace_back(i, group_of(scene.lights[i]));
    std::stable_sort(of_lights.begin(), of_lights.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    Names groups;
    for (const auto& [before, group] : of_lights)
        if (!group.empty())
            groups.add(group);
    if (!scene.background_group.empty())
        groups.add(scene.background_group);
    return groups.take();
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
    Names names;
    for (std::size_t i = 0; i < scene.volumes.size(); ++i)
        names.add(medium_name(scene, i));
    return names.take();
}

} // namespace vkvol
