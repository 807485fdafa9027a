// Which samples an image holds. Equal seeds and sample numbers mean equal random numbers: images that share some are
// not independent, and must not be merged.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "film.h"

namespace vkvol {

struct SampleRange {
    std::uint64_t seed = 0;
    std::uint64_t begin = 0, end = 0; // [begin, end)

    auto operator<=>(const SampleRange&) const = default;
};

struct SampleRanges {
    std::vector<SampleRange> known; // sorted; those of one seed neither overlap nor touch
    bool complete = true;           // false: the image may hold others
};

// "0:0-4096 7:0-64": what a merged image says instead of a seed and an offset, and a render beside them if it has fewer
// samples than it drew, in every pixel. With "unknown" at the end, it is not complete.
inline constexpr const char* sample_ranges_key = "vkvol/ranges";
std::string to_text(const SampleRanges& ranges);

// Ranges that a merged image or a plain render holds; nothing known, and not complete, if the metadata does not tell.
// Throws InputError, naming the image, if it makes no sense.
SampleRanges sample_ranges_of(const Metadata& metadata, const std::string& image);

SampleRanges united(const SampleRanges& a, const SampleRanges& b);

// In words, what both are known to hold: "seed 0, 0-4095"; empty if that is nothing.
std::string shared_samples(const SampleRanges& a, const SampleRanges& b);

} // namespace vkvol
