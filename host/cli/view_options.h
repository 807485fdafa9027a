// The command line of `vkvol view`.
#pragma once

#include "options.h"

namespace vkvol {

void parse_view(const std::vector<std::string>& arguments, Options& options);

} // namespace vkvol
