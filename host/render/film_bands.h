// The film on the device: in bands of whole rows, each within what one storage buffer may span.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "commands.h"
#include "film.h"
#include "shared/frame.h"
#include "shared/items.h"

namespace vkvol {

struct Band {
    std::uint32_t first_row;
    std::uint32_t rows;
    Buffer film;                  // and behind its pixels the sum of all, of particles: see collect.comp
    std::optional<Buffer> layers; // records of paths, then sums of pixels; where layers are asked for
};

// Rows [begin, end) of a band.
struct Rows {
    std::uint32_t begin = 0, end = 0;
    bool empty() const { return begin >= end; }
};

// Bands without samples, none higher than the first. `most_bytes`: of one buffer of them; `most_rows`: in one, or 0.
// `layers`: how many, and of how many paths they have records. `films`: such as lie in this machine's memory, of all
// devices. Throws InputError if the film is too large.
std::vector<Band> make_bands(const Device& device, Commands& commands, const Crop& crop, std::uint64_t most_bytes,
                             std::uint32_t most_rows, const shared::AovParams& layers, int films);
void clear(Commands& commands, const Band& band);

// All bands' pixels, row by row.
std::vector<shared::FilmPixel> read_bands(Commands& commands, const std::vector<Band>& bands, std::uint32_t width);
void write_bands(Commands& commands, const std::vector<Band>& bands, std::uint32_t width,
                 std::span<const shared::FilmPixel> pixels);

// Of particles: each band's sum over all its pixels, with which the error of the picture's sum is known.
std::vector<shared::FilmPixel> read_sums(Commands& commands, const std::vector<Band>& bands, std::uint32_t width);
void write_sums(Commands& commands, const std::vector<Band>& bands, std::uint32_t width,
                std::span<const shared::FilmPixel> sums);

// Rows of a band, with its layers, of one device to the same band of another. The layers' records may differ in number.
struct BandOn {
    Commands& commands;
    const Band& band;
    const shared::AovParams& layers;
};
void copy_rows(const BandOn& from, const BandOn& to, Rows rows, std::uint32_t width);

// Likewise the sums of layers, four for each of each pixel.
std::vector<glm::vec3> read_layers(Commands& commands, const std::vector<Band>& bands, std::uint32_t width,
                                   const shared::AovParams& layers);
void write_layers(Commands& commands, const std::vector<Band>& bands, std::uint32_t width,
                  const shared::AovParams& layers, std::span<const glm::vec3> sums);

// Variance of one sample's sum over all pixels: the bands' are independent. Nothing if one has less than two samples.
std::optional<glm::dvec3> variance_of_sums(std::span<const shared::FilmPixel> sums);

// Means, and variances of the means, of all bands. What else the film says is not touched.
void develop(Commands& commands, const std::vector<Band>& bands, std::uint32_t width, Film& film);

} // namespace vkvol
