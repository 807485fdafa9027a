// A layer of a picture, or its noise, as 8-bit colours.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "film.h"
#include "tone_choice.h"

namespace vkvol {

inline constexpr double whitest_noise = 0.25; // relative standard error of a pixel that is shown white

struct ShownLayer {
    std::vector<std::uint8_t> rgba; // four bytes a pixel, rows top to bottom; empty if the film has no such layer
    std::string scale;              // what black and white mean; empty for radiance
    ToneMapping mapping;            // of radiance
    std::size_t clipped = 0;        // pixels of radiance
};

// `layer`: "picture", "noise", or a layer's name. `sketch`: of the same view in fewer pixels, which shows through in
// the picture where it has no samples yet; or null.
ShownLayer show_layer(const Film& film, const Film* sketch, const std::string& layer, const ToneRequest& tone,
                      const Metadata& metadata);

} // namespace vkvol
