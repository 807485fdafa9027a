// Bands of a spectrum: renders of one scene with other values of its $keys, whose weighted sum is the reading.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "film.h"

namespace vkvol {

struct SpectralBand {
    double weight = 1.0;
    std::map<std::string, std::string> values; // of keys, the same ones in all bands
};

// A text file: a line of names, "weight" and keys, and a line of values for each band, commas between. `#` begins a
// comment. Throws InputError, with file and line.
std::vector<SpectralBand> read_bands(const std::filesystem::path& file);

inline constexpr const char* another_size = "bands are of pictures of one size; the values of some make it another";

// Adds a film of the same pixels. Bands have seeds of their own and are independent, so that the squares of their
// standard errors add up; with the same random numbers errors themselves would, which is more.
void add_band(const Film& film, double weight, Film& sum);

} // namespace vkvol
