#include "view_json.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "camera_view.h"
#include "error.h"
#include "integrators.h"
#include "tone_choice.h"

namespace vkvol {

namespace {

using Json = nlohmann::json;

constexpr double largest_factor = 1e6;

[[noreturn]] void refuse(const std::string& message) {
    throw InputError("a wish of the viewer: " + message);
}

double number(const Json& json, const char* name, double low, double high) {
    if (!json.is_number())
        refuse(fmt::format("{} is no number", name));
    const double value = json.get<double>();
    if (!(value >= low && value <= high))
        refuse(fmt::format("{} is {:g}; expected {:g} to {:g}", name, value, low, high));
    return value;
}

glm::dvec3 vector(const Json& json, const char* name) {
    if (!json.is_array() || json.size() != 3)
        refuse(fmt::format("{} is not three numbers", name));
    glm::dvec3 v;
    for (int c = 0; c < 3; ++c)
        v[c] = number(json[std::size_t(c)], name, -largest_length, largest_length);
    return v;
}

std::string text(const Json& json, const char* name) {
    if (!json.is_string() || json.get_ref<const std::string&>().size() > 1000)
        refuse(fmt::format("{} is no short text", name));
    return json.get<std::string>();
}

Projection projection_of(const std::string& name) {
    for (const Projection known : {Projection::perspective, Projection::orthographic, Projection::equirectangular})
        if (name == projection_name(known))
            return known;
    refuse(fmt::format("a camera has no projection '{}'", name));
}

Camera camera_of(const Json& json) {
    Camera camera;
    camera.position = vector(json.at("position"), "position");
    const glm::dvec3 forward = vector(json.at("forward"), "forward"), up = vector(json.at("up"), "up");
    if (forward == glm::dvec3(0.0) || up == glm::dvec3(0.0) || is_parallel(forward, up))
        refuse("forward and up give no view");
    look_along(camera, forward, up);
    camera.projection = projection_of(text(json.at("projection"), "projection"));
    camera.fov = number(json.at("fov"), "fov", narrowest_fov, widest_fov);
    camera.view_height = number(json.at("viewHeight"), "viewHeight", 1.0 / largest_length, largest_length);
    camera.lens.radius = number(json.at("lensRadius"), "lensRadius", 0.0, largest_length);
    camera.lens.focus = number(json.at("focus"), "focus", 0.0, largest_length);
    return camera;
}

Json json_of(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

Json json_of(const Camera& camera) {
    const glm::dmat3 rotation = camera_rotation(camera);
    return {{"position", json_of(camera.position)},
            {"forward", json_of(-rotation[2])},
            {"up", json_of(rotation[1])},
            {"projection", projection_name(camera.projection)},
            {"fov", camera.fov},
            {"viewHeight", camera.view_height},
            {"lensRadius", camera.lens.radius},
            {"focus", camera.lens.focus}};
}

Json lights_json(const ViewedScene& scene, const ViewWish& wish) {
    Json lights = Json::array();
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const auto edit = wish.edits.lights.find(i);
        const Shining& light = scene.lights[i];
        lights.push_back({{"name", light.name},
                          {"factor", edit == wish.edits.lights.end() ? 1.0 : edit->second.factor},
                          {"direction", light.direction ? json_of(*light.direction) : Json()}});
    }
    return lights;
}

// As wish_of() reads them.
Json wished_lights(const SceneEdits& edits) {
    Json lights = Json::array();
    for (const auto& [place, edit] : edits.lights)
        lights.push_back({{"place", place},
                          {"factor", edit.factor},
                          {"direction", edit.direction ? json_of(*edit.direction) : Json()}});
    return lights;
}

void add_scene(const ViewedScene& scene, const ViewWish& wish, Json& state) {
    state["scene"] = scene.name;
    state["device"] = scene.device;
    state["integrator"] = scene.integrator;
    state["biased"] = scene.biased;
    state["sceneWish"] = scene.wish;
    state["begun"] = scene.number;
    state["hasGrids"] = scene.has_grids;
    state["lights"] = lights_json(scene, wish);
    if (scene.has_view) {
        state["camera"] = json_of(scene.camera);
        state["target"] = json_of(scene.target);
    }
}

} // namespace

ViewWish wish_of(const std::string& json) {
    const Json read = Json::parse(json, nullptr, false);
    if (!read.is_object())
        refuse("no JSON object");
    ViewWish wish;
    try {
        if (read.contains("camera") && !read["camera"].is_null())
            wish.edits.camera = camera_of(read["camera"]);
        if (read.contains("integrator"))
            wish.edits.integrator = text(read["integrator"], "integrator");
        if (!wish.edits.integrator.empty())
            parse_integrator(wish.edits.integrator);
        if (read.contains("density"))
            wish.edits.density = number(read["density"], "density", 0.0, largest_factor);
        if (read.contains("lights"))
            for (const Json& light : read["lights"]) {
                LightEdit edit{number(light.at("factor"), "factor", 0.0, largest_factor), {}};
                if (light.contains("direction") && !light["direction"].is_null())
                    edit.direction = vector(light["direction"], "direction");
                if (edit.direction == glm::dvec3(0.0))
                    refuse("a direction of length 0");
                wish.edits.lights[static_cast<std::size_t>(number(light.at("place"), "place", 0, 1e6))] = edit;
            }
        if (read.contains("layer"))
            wish.layer = text(read["layer"], "layer");
        if (read.contains("paused"))
            wish.paused = read["paused"].is_boolean() && read["paused"].get<bool>();
    } catch (const Json::exception& error) {
        refuse(error.what());
    }
    const std::vector<std::string>& layers = layer_names();
    if (wish.layer != "picture" && wish.layer != "noise" &&
        std::find(layers.begin(), layers.end(), wish.layer) == layers.end())
        refuse(fmt::format("unknown layer '{}'", wish.layer));
    return wish;
}

std::string state_json(const Shot* shot, const ShownLayer& shown, const ViewWish& wish, std::uint64_t wish_number,
                       const std::string& message) {
    Json state = {{"message", message},
                  {"wish", wish_number},
                  {"layer", wish.layer},
                  {"paused", wish.paused},
                  {"density", wish.edits.density},
                  {"wishedIntegrator", wish.edits.integrator},
                  {"wishesCamera", wish.edits.camera.has_value()},
                  {"wishedLights", wished_lights(wish.edits)},
                  {"version", 0},
                  {"width", 0},
                  {"height", 0}};
    if (shot) {
        const bool has_picture = !shown.rgba.empty();
        state["version"] = shot->version;
        state["width"] = has_picture ? shot->film.width() : 0;
        state["height"] = has_picture ? shot->film.height() : 0;
        state["samples"] = shot->samples;
        state["seconds"] = shot->seconds;
        state["sketch"] = shot->is_sketch;
        state["done"] = shot->is_done;
        state["scale"] = shown.scale;
        if (shown.scale.empty()) // stops besides the camera's, as a wish has them
            state["exposure"] = shown.mapping.exposure - camera_exposure(shot->metadata);
        state["curve"] = name_of(shown.mapping.curve);
        state["clipped"] = shown.clipped;
        // Amid the first samples, pixels that are done would speak for all.
        const std::optional<double> noise = shot->samples > 1 ? relative_noise(shot->film) : std::nullopt;
        state["noise"] = noise ? Json(*noise) : Json();
        if (shot->scene)
            add_scene(*shot->scene, wish, state);
    }
    return state.dump(-1, ' ', false, Json::error_handler_t::replace);
}

} // namespace vkvol
