// Tables for drawing from discrete distributions: see AliasEntry in shaders/shared/frame.h.
#pragma once

#include <span>
#include <vector>

#include "shared/frame.h"

namespace vkvol {

// Entry i is drawn in proportion to weights[i] >= 0, of which one is above 0. Vose's construction ("A Linear Algorithm
// for Generating Random Numbers with a Given Distribution", 1991).
std::vector<shared::AliasEntry> make_alias_table(std::span<const double> weights);

// Chances in proportion to weights >= 0, which are known but roughly: none is less than a tenth of an even chance.
std::vector<double> defensive_chances(std::span<const double> weights);

} // namespace vkvol
