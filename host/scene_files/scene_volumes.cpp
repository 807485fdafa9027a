// The part of SceneReader that reads media in groups of their own, and where these are moved to.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "nearest_name.h"
#include "scene_reader.h"

namespace vkvol {

namespace {

constexpr std::size_t longest_name = 200; // of 255 characters of a channel, with what is before and behind it

const std::vector<std::string> in_a_volume = {"transform",
                                              "densityField",
                                              "sphere",
                                              "box",
                                              "everywhere",
                                              "layers",
                                              "models",
                                              "noise",
                                              "sigma_a",
                                              "sigma_s",
                                              "heyneygreenstein_g",
                                              "heynegreenstein_g",
                                              "phase",
                                              "medium",
                                              "emission",
                                              "albedo",
                                              "densityMap",
                                              "transferFunction",
                                              "lightRayDensityMultiplier",
                                              "shadowRayDensityMultiplier"};

constexpr Limits factor{-1e6, 1e6, true, true, "a number from -1e6 to 1e6, not 0"};

glm::dvec3 vector_of(const XmlElement& element, double fallback, const Limits& limits) {
    const auto number = [&](const char* name) { return element.attribute_number(name, fallback, limits); };
    return {number("x"), number("y"), number("z")};
}

glm::dmat4 scaling(const XmlElement& element) {
    element.allow({"value", "x", "y", "z"});
    const double all = element.attribute_number("value", 1.0, factor);
    const glm::dvec3 scale = all * vector_of(element, 1.0, factor);
    for (int axis = 0; axis < 3; ++axis)
        if (!(std::abs(scale[axis]) >= 1e-6))
            element.fail(
                fmt::format("<scale> by {:g} along an axis leaves nothing; expected at least 1e-6", scale[axis]));
    return glm::scale(glm::dmat4(1.0), scale);
}

// Counter-clockwise as seen from where the axis points to.
glm::dmat4 rotation(const XmlElement& element) {
    element.allow({"x", "y", "z", "angle"});
    const glm::dvec3 axis = vector_of(element, 0.0, any_number);
    const double largest = std::max({std::abs(axis.x), std::abs(axis.y), std::abs(axis.z)});
    if (largest == 0.0)
        element.fail("<rotate> lacks its axis, e.g. y=\"1\" beside angle, in degrees");
    return glm::rotate(glm::dmat4(1.0), glm::radians(element.attribute_number("angle", 0.0, any_number)),
                       glm::normalize(axis / largest));
}

// Row by row; three of four numbers, or four.
glm::dmat4 matrix(const XmlElement& element) {
    element.allow({"values"});
    const std::vector<double> numbers = element.attribute_numbers("values", any_number);
    if (numbers.size() != 12 && numbers.size() != 16)
        element.fail(fmt::format("<matrix> has {} values; expected 16, row by row, or the first 12", numbers.size()));
    glm::dmat4 m(1.0);
    for (std::size_t i = 0; i < 12; ++i)
        m[int(i % 4)][int(i / 4)] = numbers[i];
    for (std::size_t i = 12; i < numbers.size(); ++i)
        if (numbers[i] != (i == 15 ? 1.0 : 0.0))
            element.fail_attribute("values",
                                   "<matrix> values: the last row is not 0 0 0 1; only affine maps move a volume");
    return m;
}

glm::dmat4 transform_of(XmlDocument& document, pugi::xml_node transform) {
    XmlElement(document, transform).allow({}, false, {"translate", "rotate", "scale", "matrix"});
    glm::dmat4 map(1.0);
    for (const pugi::xml_node node : transform.children()) {
        if (node.type() != pugi::node_element)
            continue;
        const XmlElement step(document, node);
        if (step.name() == "translate") {
            step.allow({"x", "y", "z"});
            map = glm::translate(glm::dmat4(1.0), vector_of(step, 0.0, coordinate)) * map;
        } else {
            map = (step.name() == "rotate"  ? rotation(step)
                   : step.name() == "scale" ? scaling(step)
                                            : matrix(step)) *
                  map;
        }
    }
    return map;
}

bool is_usable(const glm::dmat4& map) {
    const double size = std::cbrt(std::abs(glm::determinant(glm::dmat3(map))));
    bool fits = size >= 1e-9 && size <= 1e9;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 3; ++row)
            fits = fits && std::abs(map[column][row]) <= (column < 3 ? 1e6 * size : largest_length);
    return fits;
}

} // namespace

// Its parts one after another, the first one first; where a volume is like another, after that one's.
glm::dmat4 SceneReader::transform() const {
    glm::dmat4 map(1.0);
    for (auto scope = scopes_.rbegin(); scope != scopes_.rend(); ++scope)
        map = transform_of(document_, find_one(document_, *scope, {"transform"})) * map;
    const XmlElement element(document_, find({"transform"}));
    if (element.exists() && !is_usable(map))
        element.fail(
            "<transform> leaves nothing of the volume, or flattens it a million times, or moves it beyond 1e11; "
            "check its factors");
    return map;
}

// By their names; also who has a name in common, which nobody can be like.
NamedVolumes SceneReader::named_volumes(pugi::xml_node list) const {
    NamedVolumes named;
    for (const pugi::xml_node node : list.children("volume")) {
        const XmlElement volume(document_, node);
        volume.allow({"name", "like"}, false, in_a_volume);
        if (const std::string name = volume.attribute("name"); !name.empty())
            named[name].push_back(node);
    }
    return named;
}

// The volume whose name stands in `like`.
pugi::xml_node SceneReader::volume_it_is_like(const XmlElement& volume, const NamedVolumes& named) const {
    const std::string name = volume.attribute("like");
    const auto found = named.find(name);
    if (found == named.end()) {
        std::vector<std::string> names;
        for (const auto& [known, nodes] : named)
            names.push_back(known);
        const std::string nearest = nearest_name(name, names);
        volume.fail_attribute("like", fmt::format("<volume> like: no volume is named '{}'; {}", name,
                                                  nearest.empty() ? "expected the name of another"
                                                                  : fmt::format("did you mean {}?", nearest)));
    }
    if (found->second.size() > 1)
        volume.fail_attribute("like",
                              fmt::format("<volume> like: two volumes are named '{}', at {} and {}; rename one", name,
                                          document_.place(found->second[0]), document_.place(found->second[1])));
    return found->second.front();
}

// Itself first, then that which it is like, and so on.
std::vector<pugi::xml_node> SceneReader::with_those_it_is_like(pugi::xml_node volume, const NamedVolumes& named) const {
    constexpr std::size_t longest = 64; // written by hand it has two or three
    std::vector<pugi::xml_node> chain{volume};
    for (XmlElement last(document_, volume); last.has("like"); last = XmlElement(document_, chain.back())) {
        const pugi::xml_node next = volume_it_is_like(last, named);
        if (std::find(chain.begin(), chain.end(), next) != chain.end())
            last.fail_attribute("like", fmt::format("<volume> like: '{}' is in the end like this one itself; one of "
                                                    "them needs what they have in common",
                                                    last.attribute("like")));
        if (chain.size() == longest)
            last.fail_attribute("like",
                                fmt::format("<volume> like: more than {} volumes each like the next; let all be "
                                            "like the last of them",
                                            longest));
        chain.push_back(next);
    }
    return chain;
}

void SceneReader::warn_of_what_is_in_no_volume() const {
    for (const std::string& name : in_a_volume)
        if (const XmlElement element(document_, document_.root().child(name.c_str())); element.exists()) {
            if (name == "models" || name == "densityField") // empty, as the original's own scenes have them
                continue;
            element.warn(
                fmt::format("<{}> is without effect: it is in no volume; write it into each <volume> that it is "
                            "meant of",
                            name));
            return;
        }
}

// What stands in the scene itself is one, too.
void SceneReader::read_volumes(Scene& scene) {
    const XmlElement groups = one("volumes");
    groups.allow({}, false, {"volume"});
    const pugi::xml_node root = document_.root(), list = root.child("volumes");
    const bool has_groups = !list.child("volume").empty();
    if (has_groups && overrides_.grid)
        groups.fail("--grid: of several <volumes> it is not clear which one is meant; write the grid's file into one");
    if (has_groups && !shape_element(scene.settings.integrator).exists())
        warn_of_what_is_in_no_volume();
    else if (const std::optional<Volume> medium = volume(scene.settings.integrator))
        scene.volumes.push_back(*medium);
    const NamedVolumes named = named_volumes(list);
    for (const pugi::xml_node node : list.children("volume")) {
        scopes_ = with_those_it_is_like(node, named);
        std::optional<Volume> medium = volume(scene.settings.integrator);
        if (!medium)
            XmlElement(document_, node)
                .fail("<volume> has no shape; add a densityField, sphere, box, models or everywhere to it, or say "
                      "like=\"NAME\" of a volume that has one");
        for (const char* name : {"medium", "emission"})
            warn_of_forgotten_color(XmlElement(document_, node.child(name)));
        medium->name = XmlElement(document_, node).attribute("name");
        if (medium->name.size() > longest_name)
            XmlElement(document_, node)
                .fail(fmt::format(
                    "the name has {} characters; expected {} at most, for which channels of images have room",
                    medium->name.size(), longest_name));
        medium->transform = transform();
        scene.volumes.push_back(*medium);
    }
    scopes_ = {root};
    std::map<std::string, std::string> layers;
    for (std::size_t i = 0; i < scene.volumes.size(); ++i) {
        const std::string layer = medium_name(scene, i), &name = scene.volumes[i].name;
        if (const std::string& before = layers.try_emplace(layer, name).first->second; before != name) {
            groups.warn(fmt::format("volumes \"{}\" and \"{}\" would have one layer, medium.{}; name them otherwise",
                                    before, name, layer));
            break;
        }
    }
    constexpr std::size_t most = 100000;
    if (scene.volumes.size() > most)
        groups.fail(fmt::format("{} volumes are more than the {} that are rendered; leave some out",
                                scene.volumes.size(), most));
}

} // namespace vkvol
