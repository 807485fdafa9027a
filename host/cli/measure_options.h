// The command line of `vkvol measure`.
#pragma once

#include <string>
#include <vector>

#include "options.h"

namespace vkvol {

// Throws InputError: one line with a hint.
void parse_measure(const std::vector<std::string>& arguments, Options& options);

// "KEY=A,B,C", or "KEY=A..BxN": N numbers, evenly from A to B.
Sweep parse_sweep(const std::string& text);

} // namespace vkvol
