// A film as a table for spreadsheets and scripts.
#pragma once

#include <string>

#include "film.h"

namespace vkvol {

// Comma-separated, a line a pixel, with a heading: column and row in the picture, x, y, z where a sensor of flux stands
// [world units], R, G, B, their standard errors (empty of single samples), and samples. Numbers in their shortest exact
// form.
std::string film_table(const Film& film);

} // namespace vkvol
