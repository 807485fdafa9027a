// Renders of the same picture with different samples, or of different parts of it, put together.
#pragma once

#include <string>
#include <vector>

#include "film.h"
#include "options.h"

namespace vkvol {

struct MergeInput {
    std::string name; // for messages
    Film film;
    Metadata metadata;
};

struct MergeResult {
    Film film;
    Metadata metadata;
    std::vector<std::string> warnings; // what could not be checked, and what is missing
};

// Equal windows: every pixel is weighted by its samples, and the variance is that of the pooled samples. Disjoint
// windows of one picture: put side by side in their bounding window. Throws InputError when the images do not belong
// together.
MergeResult merge_films(const std::vector<MergeInput>& inputs);

// The `merge` command.
int run_merge(const MergeOptions& options);

} // namespace vkvol
