#include "scene_edits.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <pugixml.hpp>
#include <sstream>
#include <string_view>

#include "error.h"

namespace vkvol {

namespace {

constexpr const char* multiplier = "multiplier";

pugi::xml_document parsed(const std::string& xml) {
    pugi::xml_document document;
    // All of it comes out again, but for the space between elements.
    const pugi::xml_parse_result result =
        document.load_buffer(xml.data(), xml.size(), pugi::parse_full, pugi::encoding_utf8);
    if (!result || !document.document_element())
        throw InputError(fmt::format("the scene is no XML: {}", result.description()));
    return document;
}

std::optional<double> number_in(std::string_view text) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool good = error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
    return good ? std::optional(value) : std::nullopt;
}

std::string number_text(double value) {
    return fmt::format("{:.9g}", value);
}

// What may be a number or stand for one: "$sun", "${= 2*pi}".
std::string scaled(const std::string& text, double factor) {
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first == std::string::npos)
        return number_text(factor);
    const std::string value = text.substr(first, text.find_last_not_of(" \t\r\n") + 1 - first);
    if (const std::optional<double> number = number_in(value))
        return number_text(factor * *number);
    if (value.starts_with("${=") && value.ends_with('}'))
        return fmt::format("${{= {}*({})}}", number_text(factor), value.substr(3, value.size() - 4));
    return fmt::format("${{= {}*{}}}", number_text(factor), value);
}

void set(pugi::xml_node node, const char* name, const std::string& value) {
    pugi::xml_attribute attribute = node.attribute(name);
    if (!attribute)
        attribute = node.append_attribute(name);
    attribute.set_value(value.c_str());
}

void set_text(pugi::xml_node node, const std::string& value) {
    node.text().set(value.c_str());
}

pugi::xml_node child(pugi::xml_node parent, const char* name) {
    const pugi::xml_node found = parent.child(name);
    return found ? found : parent.append_child(name);
}

// Media that stand for themselves, each with all that it is made of; the scene itself is one if it has a shape, or none
// else is.
std::vector<pugi::xml_node> media(pugi::xml_node root) {
    std::vector<pugi::xml_node> found;
    constexpr std::array shapes{"densityField", "sphere", "box", "everywhere", "layers", "models"};
    if (std::any_of(shapes.begin(), shapes.end(), [&](const char* shape) { return root.child(shape); }))
        found.push_back(root);
    for (const pugi::xml_node volume : root.child("volumes").children("volume"))
        found.push_back(volume);
    if (found.empty())
        found.push_back(root);
    return found;
}

std::vector<pugi::xml_node> shining_elements(pugi::xml_node root) {
    std::vector<pugi::xml_node> found;
    const auto add = [&found](pugi::xml_node node) {
        if (node.type() == pugi::node_element)
            found.push_back(node);
    };
    add(root.child("light"));
    for (const pugi::xml_node light : root.child("lights").children())
        add(light);
    add(root.child("backgroundColor"));
    for (const pugi::xml_node medium : media(root)) {
        add(medium.child("emission"));
        add(medium.child("medium"));
    }
    for (const pugi::xml_node surface : root.child("surfaces").children())
        add(surface.child("emission"));
    return found;
}

bool is_far_away(pugi::xml_node node) {
    const std::string_view name = node.name();
    return name == "light" || name == "directional" || name == "sun" || name == "daylight";
}

// None where it is not written in numbers.
std::optional<glm::dvec3> direction_of(pugi::xml_node node) {
    if (!is_far_away(node))
        return std::nullopt;
    const auto number = [&](const char* name) {
        return node.attribute(name) ? number_in(node.attribute(name).value()) : std::optional(0.0);
    };
    if (node.attribute("zenith") || node.attribute("azimuth")) {
        const std::optional<double> zenith = number("zenith"), azimuth = number("azimuth");
        if (!zenith || !azimuth)
            return std::nullopt;
        const double polar = glm::radians(*zenith), around = glm::radians(*azimuth);
        return glm::dvec3(std::sin(polar) * std::sin(around), std::cos(polar), std::sin(polar) * std::cos(around));
    }
    const std::optional<double> x = number("x"), y = number("y"), z = number("z");
    if (!x || !y || !z || glm::dvec3(*x, *y, *z) == glm::dvec3(0.0))
        return std::nullopt;
    return glm::normalize(glm::dvec3(*x, *y, *z));
}

void edit_camera(pugi::xml_node root, const Camera& camera) {
    pugi::xml_node node = child(root, "camera");
    for (const char* name : {"lookAt", "distance", "azimuth", "elevation", "up"})
        node.remove_attribute(name);
    const std::pair<const char*, double> values[] = {{"x", camera.position.x}, {"y", camera.position.y},
                                                     {"z", camera.position.z}, {"pitch", camera.pitch},
                                                     {"yaw", camera.yaw},      {"roll", camera.roll}};
    for (const auto& [name, value] : values)
        set(node, name, number_text(value));
    if (camera.projection == Projection::perspective)
        set(node, "fov", number_text(camera.fov));
    if (camera.projection == Projection::orthographic)
        set(node, "viewHeight", number_text(camera.view_height));
    if (camera.lens.radius > 0.0)
        set(node, "focus", number_text(camera.lens.focus));
}

void edit_light(pugi::xml_node node, const LightEdit& edit) {
    if (edit.factor != 1.0) {
        const char* const name = node.attribute("power") ? "power" : multiplier;
        const pugi::xml_attribute attribute = node.attribute(name);
        set(node, name, scaled(attribute ? attribute.value() : "1", edit.factor));
    }
    if (!edit.direction || !is_far_away(node))
        return;
    for (const char* name : {"x", "y", "z"})
        node.remove_attribute(name);
    const glm::dvec3 towards = glm::normalize(*edit.direction);
    set(node, "zenith", number_text(glm::degrees(std::acos(std::clamp(towards.y, -1.0, 1.0)))));
    set(node, "azimuth", number_text(glm::degrees(std::atan2(towards.x, towards.z))));
}

// "ratioTracking:flight=weighted" becomes <integrator flight="weighted">ratioTracking</integrator>.
void edit_integrator(pugi::xml_node root, const std::string& request) {
    root.remove_child("integrator");
    root.remove_child("intersectionHandler");
    pugi::xml_node node = root.append_child("integrator");
    std::istringstream parts(request);
    std::string part;
    std::getline(parts, part, ':');
    set_text(node, part);
    while (std::getline(parts, part, ':')) {
        const std::size_t equals = part.find('=');
        if (equals != std::string::npos)
            set(node, part.substr(0, equals).c_str(), part.substr(equals + 1));
    }
}

void edit_density(pugi::xml_node root, double factor) {
    constexpr const char* name = "lightRayDensityMultiplier";
    for (pugi::xml_node medium : media(root)) {
        const bool is_like_another = medium.attribute("like") && !medium.child(name);
        if (!is_like_another) {
            pugi::xml_node node = child(medium, name);
            set_text(node, scaled(node.text().get(), factor));
        }
        if (pugi::xml_node shadow = medium.child("shadowRayDensityMultiplier"))
            set_text(shadow, scaled(shadow.text().get(), factor));
    }
}

} // namespace

std::vector<Shining> what_shines(const std::string& xml) {
    const pugi::xml_document document = parsed(xml);
    std::vector<Shining> found;
    for (const pugi::xml_node node : shining_elements(document.document_element())) {
        const std::string group = node.attribute("group").value();
        found.push_back({node.name() + (group.empty() ? "" : " (" + group + ")"), direction_of(node)});
    }
    return found;
}

std::string edited(const std::string& xml, const SceneEdits& edits) {
    const pugi::xml_document document = parsed(xml);
    const pugi::xml_node root = document.document_element();
    if (edits.camera)
        edit_camera(root, *edits.camera);
    const std::vector<pugi::xml_node> shining = shining_elements(root);
    for (const auto& [place, edit] : edits.lights)
        if (place < shining.size())
            edit_light(shining[place], edit);
    if (edits.density != 1.0)
        edit_density(root, edits.density);
    if (!edits.integrator.empty())
        edit_integrator(root, edits.integrator);
    std::ostringstream text;
    document.save(text, "  ");
    return text.str();
}

} // namespace vkvol
