// The causes that a picture can have for showing nothing: each is a question to the evidence.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "explain.h"
#include "method.h"

namespace vkvol {

// What is wrong with a picture.
enum class Odd { unfinished, black, background, white, noise };

// Optical depth through which a camera sees nothing: exp(-8) is less than a step on the screen.
constexpr double deep = 8.0;

struct Evidence {
    const Scene& scene; // as its integrator sees it
    const Scene& authored;
    const Method& method;
    Odd odd = Odd::black;
    bool emits = false; // the medium, by whatever
    // Known once it is rendered; null before, when the picture is black for certain.
    const RenderResult* result = nullptr;
    const FilmGlance* look = nullptr;
    const Sight* sight = nullptr; // null also if there is no medium
    const Tone* tone = nullptr;   // null also if there is no screen
};

struct Cause {
    const char* name;
    // Why, and the remedy; none if it is not this.
    std::optional<std::string> (*explain)(const Evidence&);
};

// Whether paths get light from any of the lights.
bool sees_light(const Scene& scene, const Method& method);

// In the order in which they are asked: what would hide the next comes first.
const std::vector<Cause>& causes();

} // namespace vkvol
