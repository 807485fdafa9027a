// vkvol measure: a scene's readings as a table, for one value or many of its $keys.
#pragma once

#include "options.h"

namespace vkvol {

// Every reading with its standard error: of each pixel, or the means of pictures. Combinations of the keys' values
// follow one another, the last key fastest, in one process, with the same random numbers, so that what they differ by
// has less noise than they have. Written as CSV where an output is asked for, else printed. Throws InputError,
// RenderError; Interrupted leaves the rows so far.
int run_measure(const MeasureOptions& options);

} // namespace vkvol
