// The command line of `vkvol bench`.
#pragma once

#include <string>
#include <vector>

#include "options.h"

namespace vkvol {

// Throws InputError: one line with a hint.
void parse_bench(const std::vector<std::string>& arguments, Options& options);

} // namespace vkvol
