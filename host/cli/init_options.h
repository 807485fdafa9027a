// The command line of `vkvol init`.
#pragma once

#include "options.h"

namespace vkvol {

void parse_init(const std::vector<std::string>& arguments, Options& options);

} // namespace vkvol
