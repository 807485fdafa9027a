// Phase functions from files.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scene.h"
#include "shared/frame.h"

namespace vkvol {

struct PhaseTable {
    std::vector<shared::PhaseNode> nodes;
    std::vector<std::string> warnings;
};

// A text of lines "angle value", angles in degrees from 0 (straight on) to 180, rising, values >= 0 in any unit; or of
// one number a line, the Legendre moments: means of P_0 = 1, P_1, P_2, ... of the cosine. "#" begins a comment. Throws
// InputError, which names the line.
PhaseTable load_phase_table(const std::filesystem::path& file);

// Of a phase function that kernels have as a table; of others none.
PhaseTable phase_table(const Volume& volume);

// Linear in the cosine between the given angles [radians, from 0 to pi, rising], and of integral 1. Some value is above
// 0.
std::vector<shared::PhaseNode> make_phase_nodes(std::span<const double> angles, std::span<const double> values);

} // namespace vkvol
