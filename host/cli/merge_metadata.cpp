#include "merge_metadata.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <limits>
#include <optional>
#include <string_view>

#include "metadata.h"
#include "sample_ranges.h"

namespace vkvol {

namespace {

std::uint64_t add(std::uint64_t a, std::uint64_t b) {
    return a + std::min(b, std::numeric_limits<std::uint64_t>::max() - a);
}

int metadata_int(std::uint64_t count) {
    return static_cast<int>(std::min<std::uint64_t>(count, std::numeric_limits<int>::max()));
}

Metadata common_metadata(const std::vector<MergeInput>& inputs) {
    Metadata metadata;
    for (const auto& [key, value] : inputs.front().metadata)
        if (std::all_of(inputs.begin(), inputs.end(), [&key = key, &value = value](const MergeInput& input) {
                const auto found = input.metadata.find(key);
                return found != input.metadata.end() && found->second == value;
            }))
            metadata[key] = value;
    return metadata;
}

// In place of the seed and offset of a render, also where they are one range still: so a merged image can be merged
// again, and samples that it holds already are found.
void merge_ranges(const std::vector<MergeInput>& inputs, Metadata& metadata) {
    SampleRanges ranges;
    for (const MergeInput& input : inputs)
        ranges = united(ranges, sample_ranges_of(input.metadata, input.name));
    metadata.erase("vkvol/seed");
    metadata.erase("vkvol/sampleOffset");
    metadata[sample_ranges_key] = to_text(ranges);
}

// None if no input has it: an image that does not tell counts as 0, so that what the others tell is kept.
std::optional<std::uint64_t> sum_of(const std::vector<MergeInput>& inputs, const char* key) {
    std::optional<std::uint64_t> sum;
    for (const MergeInput& input : inputs)
        if (const std::optional<std::uint64_t> count = count_of(input.metadata, key, input.name))
            sum = add(sum.value_or(0), *count);
    return sum;
}

void merge_counts(const std::vector<MergeInput>& inputs, Metadata& metadata) {
    for (const char* key : {"vkvol/depthCaps", "vkvol/stepCaps", "vkvol/majorantViolations", "vkvol/queueOverflows",
                            "vkvol/abandonedPaths", "vkvol/nonFiniteSamples"})
        if (const std::optional<std::uint64_t> sum = sum_of(inputs, key))
            metadata[key] = metadata_int(*sum);
    std::optional<std::uint64_t> cleaned; // of the same grids, of which each tells all
    for (const MergeInput& input : inputs)
        cleaned = std::max(cleaned, count_of(input.metadata, "vkvol/cleanedVoxels", input.name));
    if (cleaned)
        metadata["vkvol/cleanedVoxels"] = metadata_int(*cleaned);
    if (const std::optional<std::uint64_t> sum = sum_of(inputs, "vkvol/nullCollisions"))
        metadata["vkvol/nullCollisions"] = std::to_string(*sum); // often beyond 32 bits
    if (const std::optional<std::uint64_t> sum = sum_of(inputs, "vkvol/capsHit"))
        metadata["vkvol/capsHit"] = *sum > 0 ? 1 : 0;
}

// One of vkvol/biased: "3 paths ended at maxDepth" has a count, "the majorant is scaled below the density" has none.
struct Reason {
    std::optional<std::uint64_t> count;
    std::string what;
};

Reason parse_reason(std::string_view text) {
    std::uint64_t count = 0;
    const char* const end = text.data() + text.size();
    const auto [next, error] = std::from_chars(text.data(), end, count);
    if (error != std::errc() || next == end || *next != ' ')
        return {std::nullopt, std::string(text)};
    return {count, std::string(next + 1, end)};
}

void add_reason(const Reason& reason, std::vector<Reason>& reasons) {
    const auto same = std::find_if(reasons.begin(), reasons.end(), [&reason](const Reason& other) {
        return other.what == reason.what && other.count.has_value() == reason.count.has_value();
    });
    if (same == reasons.end())
        reasons.push_back(reason);
    else if (reason.count)
        same->count = add(*same->count, *reason.count);
}

void add_reasons(std::string_view text, std::vector<Reason>& reasons) {
    constexpr std::string_view separator = "; ";
    while (!text.empty()) {
        const std::size_t length = std::min(text.find(separator), text.size());
        if (length > 0)
            add_reason(parse_reason(text.substr(0, length)), reasons);
        text.remove_prefix(std::min(length + separator.size(), text.size()));
    }
}

// A part that is biased makes the whole so.
void merge_bias(const std::vector<MergeInput>& inputs, Metadata& metadata) {
    std::vector<Reason> reasons;
    for (const MergeInput& input : inputs)
        add_reasons(text_of(input.metadata, "vkvol/biased"), reasons);
    std::string text;
    for (const Reason& reason : reasons)
        text += (text.empty() ? "" : "; ") + (reason.count ? fmt::format("{} ", *reason.count) : "") + reason.what;
    if (!text.empty())
        metadata["vkvol/biased"] = text;
}

void merge_times(const std::vector<MergeInput>& inputs, Metadata& metadata) {
    float seconds = 0.0f;
    bool timed = true;
    for (const MergeInput& input : inputs) {
        const auto found = input.metadata.find("renderTimeSeconds");
        const float* value = found == input.metadata.end() ? nullptr : std::get_if<float>(&found->second);
        timed = timed && value;
        seconds += value ? *value : 0.0f;
    }
    if (timed)
        metadata["renderTimeSeconds"] = seconds;
}

} // namespace

Metadata merged_metadata(const std::vector<MergeInput>& inputs, const Film& merged) {
    Metadata metadata = common_metadata(inputs);
    metadata["samplesPerPixel"] = metadata_int(*std::max_element(merged.samples.begin(), merged.samples.end()));
    merge_ranges(inputs, metadata);
    merge_counts(inputs, metadata);
    merge_bias(inputs, metadata);
    merge_times(inputs, metadata);
    record_facts(merged, metadata);
    metadata["vkvol/mergedFrom"] = static_cast<int>(inputs.size());
    return metadata;
}

} // namespace vkvol
