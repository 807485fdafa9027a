// Changes of a scene that a viewer makes, as changes of its text: what is seen is what can be kept.
#pragma once

#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene.h"

namespace vkvol {

// What shines in a scene file, in the order of its elements: <light>, those in <lights>, <backgroundColor>, and
// <emission> and <medium> of media.
struct Shining {
    std::string name;                    // of its element, and its group in parentheses
    std::optional<glm::dvec3> direction; // unit, towards it; of those far away
};

struct LightEdit {
    double factor = 1.0;                      // of its brightness, >= 0
    std::optional<glm::dvec3> direction = {}; // unit
};

struct SceneEdits {
    std::optional<Camera> camera;            // its place, angles, fov or viewHeight, and focus
    std::string integrator;                  // NAME:axis=choice...; empty: the scene's
    std::map<std::size_t, LightEdit> lights; // by place among what shines
    double density = 1.0;                    // a factor of all media's, >= 0
};

// Throw InputError for what is no XML.
std::vector<Shining> what_shines(const std::string& xml);
std::string edited(const std::string& xml, const SceneEdits& edits);

} // namespace vkvol
