// From linear radiance to 8-bit pictures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "film.h"

namespace vkvol {

// srgb: clip, then the sRGB curve. aces: Narkowicz' fit of the ACES filmic curve, then sRGB. agx: Sobotka's AgX in the
// polynomial form of Wrensch. reinhard: the original renderer's curve, v (1 + v/w^2) / (1 + v) with w the
// brightest channel value of the picture (over its alpha, where it has one), and no sRGB encoding.
enum class ToneCurve { srgb, aces, agx, reinhard };

struct ToneMapping {
    ToneCurve curve = ToneCurve::srgb;
    double exposure = 0.0; // stops: radiance is multiplied by 2^exposure first
};

// Three bytes a pixel, rows top to bottom. Values that are not finite become black.
std::vector<std::uint8_t> tone_map(const Film& film, const ToneMapping& mapping);

// Four bytes a pixel, the last of alpha. Means are premultiplied by it, and colours in such files, as PNG has it, are
// not: what the curve makes of a mean over its alpha. Readers that put it over something in linear light get what that
// would look like behind the medium; light where alpha is 0, as flames may be, is lost.
std::vector<std::uint8_t> tone_map(const Film& film, const ToneMapping& mapping, const FilmLayer& alpha);

// As the first of these, but with a fourth byte, 255, as screens have it. `whole`: of which the brightest value counts.
std::vector<std::uint8_t> tone_map_opaque(std::span<const glm::vec3> radiance, const ToneMapping& mapping,
                                          std::span<const glm::vec3> whole);

// Pixels brighter than the curve has values for, in one channel or more: what they differ by is lost.
std::size_t clipped_pixels(const Film& film, const ToneMapping& mapping);

// What is darker is black on the screen. (By reinhard, of a picture with a bright white.)
double faintest_radiance(const ToneMapping& mapping);

// The exposure, in hundredths of a stop, at which of the pixels that are not black the curve puts 99 % below nine
// tenths of white. 0 if all are black.
double suitable_exposure(const Film& film, ToneCurve curve);

} // namespace vkvol
