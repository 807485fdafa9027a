// Why a picture is black, shows nothing but its background, or is white.
#pragma once

#include <optional>
#include <string>

#include "film_glance.h"
#include "session.h"
#include "sight.h"
#include "tone_choice.h"

namespace vkvol {

struct Explanation {
    std::string picture; // what is wrong with it: "unfinished", "black", "background", "white" or "noise"
    std::string cause;   // a word for it, as in the README
    std::string text;    // one line: what the picture is, why, and the remedy
    std::optional<FilmGlance> look;
    std::optional<Sight> sight; // if there is a medium
};

// Before anything is rendered: a picture that will be black for certain. Whatever could give light and does not.
std::optional<Explanation> foresee(const Scene& scene);

// Explains a picture that was rendered; nothing if it looks like one. `tone`: as it is shown; without pixels, it is
// not, and pictures are too dark or too bright for nobody.
std::optional<Explanation> explain(const Scene& scene, const RenderResult& result, const Tone& tone);

} // namespace vkvol
