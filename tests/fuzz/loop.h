// Runs inputs in a process of its own, so that a crash or a hang is a finding and not the end.
#pragma once

#include <cstdint>
#include <filesystem>

#include "target.h"

namespace vkvol::fuzz {

struct Range {
    std::uint64_t seed = 1, first = 0, runs = 1000;
};

struct Tally {
    std::uint64_t runs = 0, accepted = 0, findings = 0;
    double seconds = 0.0, slowest = 0.0;
    std::uint64_t slowest_input = 0, peak_bytes = 0;
};

// Writes the inputs of findings to `out`, and to standard error what was found and the command that replays it.
Tally run_inputs(Target& target, const Range& range, const std::filesystem::path& out);

} // namespace vkvol::fuzz
