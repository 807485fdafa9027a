// Scenes of a few directives of pbrt's, as the renderer sees them.
#pragma once

#include <catch2/catch.hpp>
#include <variant>

#include "pbrt_scene.h"
#include "scene_xml.h"

namespace vkvol {

inline Scene scene_of(const std::string& text) {
    return parse_scene(translate_pbrt(read_pbrt(text, "s.pbrt")), "s.pbrt");
}

// A world of this after a plain beginning.
inline Scene world_of(const std::string& text) {
    return scene_of("Camera \"perspective\"\nWorldBegin\n" + text);
}

inline bool near(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-9) {
    return glm::distance(a, b) <= tolerance * std::max(1.0, glm::length(b));
}

template <class Kind> Kind only_light(const Scene& scene) {
    REQUIRE(scene.lights.size() == 1);
    REQUIRE(std::holds_alternative<Kind>(scene.lights[0]));
    return std::get<Kind>(scene.lights[0]);
}

} // namespace vkvol
