// A film as one row of numbers a pixel, as image files and viewers have it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "film.h"

namespace vkvol {

// "direct.R", and with a prefix "variance.direct.R". Alpha by which the picture is multiplied is its own, "A": readers
// take that for so.
std::string channel_name(const std::string& prefix, const FilmLayer& layer, char letter, bool is_premultiplied);

// What every film has: R, G, B, variance.R, variance.G, variance.B, and then this.
inline constexpr std::size_t samples_channel = 6;

// Channels of the film with its layers.
std::vector<std::string> channel_names(const Film& film);

// All channels of each pixel, rows top to bottom: the bits of floats, but for the whole number of samples.
std::vector<std::uint32_t> interleaved_channels(const Film& film);

} // namespace vkvol
