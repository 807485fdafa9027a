// What the metadata of two images says against comparing them.
#pragma once

#include <string>
#include <vector>

#include "film.h"
#include "options.h"

namespace vkvol {

// One line each. Never a reason to refuse: images of other programs have no metadata, and different scenes may be what
// is to be compared.
std::vector<std::string> comparison_notes(const CompareOptions& options, const Metadata& a, const Metadata& b);

} // namespace vkvol
