// What a merged image says of itself.
#pragma once

#include <vector>

#include "merge.h"

namespace vkvol {

// What all inputs agree on stays; times and counts are added up, reasons of bias and sample ranges united. Throws
// InputError where counts or ranges make no sense.
Metadata merged_metadata(const std::vector<MergeInput>& inputs, const Film& merged);

} // namespace vkvol
