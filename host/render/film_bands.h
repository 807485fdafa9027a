// The film on the device: in bands of whole rows, each within what one storage buffer may span.
#pragma once

#include <vector>

#include "commands.h"
#include "film.h"
#include "shared/items.h"

namespace vkvol {

struct Band {
    std::uint32_t first_row;
    std::uint32_t rows;
    Buffer film;
};

// Bands without samples. `most_bytes`: of one of them.
std::vector<Band> make_bands(const Device& device, Commands& commands, const Crop& crop, std::uint64_t most_bytes);

// All bands' pixels, row by row.
std::vector<shared::FilmPixel> read_bands(Commands& commands, const std::vector<Band>& bands, std::uint32_t width);
void write_bands(Commands& commands, const std::vector<Band>& bands, std::uint32_t width,
                 std::span<const shared::FilmPixel> pixels);

// Means, and variances of the means. What else the film says is not touched.
void develop(std::span<const shared::FilmPixel> pixels, Film& film);

} // namespace vkvol
