// Writes fields as OpenVDB or NanoVDB files. The only part of make_field that sees OpenVDB.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "bricks.h"

namespace vkvol {

enum class Codec { none, zip, blosc };
enum class SampleType { float32, half, fp4, fp8, fp16, fpn };

// What was written, for people: measured on the finished trees, not taken from the recipe.
struct GridSummary {
    std::string name;
    IndexBox box; // of the active samples; meaningless if there are none
    std::uint64_t active = 0;
    float lowest = 0.0f, highest = 0.0f; // of the active samples
};

struct FileSummary {
    std::vector<GridSummary> grids;
    std::uint64_t bytes = 0;
};

// The file appears whole or not at all. `.nvdb` holds float or fp samples, `.vdb` float or half.
// The same field gives the same bytes. Throws InputError if the file cannot be written.
FileSummary write_field(const Field& field, const std::filesystem::path& path, Codec codec, SampleType type);

} // namespace vkvol
