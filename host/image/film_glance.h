// What a picture shows at first sight, before anyone asks why.
#pragma once

#include "film.h"
#include "tone_map.h"

namespace vkvol {

struct FilmGlance {
    std::size_t pixels = 0;
    std::size_t unsampled = 0; // pixels without a sample
    std::size_t shown = 0;     // that are not black on the screen
    std::size_t apart = 0;     // that a screen could tell from the background
    double brightest = 0.0;    // channel
};

// `mapping`: of the screen.
FilmGlance first_glance(const Film& film, const glm::dvec3& background, const ToneMapping& mapping);

// Whether noise explains all that pixels differ by, by the ratio of the variance between them to their own. Its
// expectation is 1 then; a picture that shows something is far above. Of single samples nobody knows: false.
bool is_without_structure(const Film& film);

} // namespace vkvol
