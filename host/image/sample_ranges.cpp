#include "sample_ranges.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <optional>
#include <sstream>

#include "error.h"
#include "metadata.h"
#include "one_line.h"

namespace vkvol {

namespace {

constexpr const char* unknown = "unknown";

// Sorted, and what overlaps or touches joined.
void normalise(std::vector<SampleRange>& ranges) {
    std::sort(ranges.begin(), ranges.end());
    std::vector<SampleRange> joined;
    for (const SampleRange& range : ranges)
        if (!joined.empty() && joined.back().seed == range.seed && range.begin <= joined.back().end)
            joined.back().end = std::max(joined.back().end, range.end);
        else
            joined.push_back(range);
    ranges = std::move(joined);
}

// "7:0-64"
std::optional<SampleRange> parse_range(const std::string& word) {
    SampleRange range;
    const char* at = word.data();
    const char* const end = word.data() + word.size();
    const auto number = [&](std::uint64_t& value, char terminator) {
        const auto [next, error] = std::from_chars(at, end, value);
        if (error != std::errc() || (terminator ? next == end || *next != terminator : next != end))
            return false;
        at = next + 1;
        return true;
    };
    const bool valid = number(range.seed, ':') && number(range.begin, '-') && number(range.end, '\0');
    return valid && range.begin < range.end ? std::optional(range) : std::nullopt;
}

SampleRanges parse_ranges(const std::string& text, const std::string& image) {
    const auto fail = [&] {
        throw InputError(one_line(fmt::format("{}: {} is '{}'; expected seeds and ranges of samples, like 0:0-4096 "
                                              "7:0-64",
                                              image, sample_ranges_key, text)));
    };
    SampleRanges ranges;
    std::istringstream words(text);
    for (std::string word; words >> word;)
        if (word == unknown)
            ranges.complete = false;
        else if (const std::optional<SampleRange> range = parse_range(word))
            ranges.known.push_back(*range);
        else
            fail();
    if (ranges.known.empty() && ranges.complete)
        fail();
    normalise(ranges.known);
    return ranges;
}

} // namespace

std::string to_text(const SampleRanges& ranges) {
    std::string text;
    for (const SampleRange& range : ranges.known)
        text += fmt::format("{}{}:{}-{}", text.empty() ? "" : " ", range.seed, range.begin, range.end);
    if (!ranges.complete)
        text += text.empty() ? unknown : fmt::format(" {}", unknown);
    return text;
}

SampleRanges sample_ranges_of(const Metadata& metadata, const std::string& image) {
    if (metadata.count(sample_ranges_key))
        return parse_ranges(text_of(metadata, sample_ranges_key), image);
    const std::optional<std::uint64_t> seed = count_of(metadata, "vkvol/seed", image);
    if (!seed || !metadata.count("samplesPerPixel"))
        return {{}, false};
    const std::uint64_t begin = count_of(metadata, "vkvol/sampleOffset", image).value_or(0);
    const std::uint64_t end = begin + *count_of(metadata, "samplesPerPixel", image);
    if (begin >= end)
        throw InputError(one_line(fmt::format("{}: vkvol/sampleOffset is '{}' and samplesPerPixel '{}'; expected "
                                              "samples",
                                              image, begin, text_of(metadata, "samplesPerPixel"))));
    return {{{*seed, begin, end}}, true};
}

SampleRanges united(const SampleRanges& a, const SampleRanges& b) {
    SampleRanges both = a;
    both.known.insert(both.known.end(), b.known.begin(), b.known.end());
    both.complete = a.complete && b.complete;
    normalise(both.known);
    return both;
}

std::string shared_samples(const SampleRanges& a, const SampleRanges& b) {
    std::string text;
    auto i = a.known.begin(), j = b.known.begin();
    while (i != a.known.end() && j != b.known.end()) {
        const std::uint64_t begin = std::max(i->begin, j->begin), end = std::min(i->end, j->end);
        if (i->seed == j->seed && begin < end)
            text += fmt::format("{}seed {}, {}-{}", text.empty() ? "" : "; ", i->seed, begin, end - 1);
        // The one that ends first shares no more.
        (std::pair(i->seed, i->end) < std::pair(j->seed, j->end) ? i : j)++;
    }
    return text;
}

} // namespace vkvol
