// The container format of .nvdb files: segments of compressed grids with metadata. Read here rather than by NanoVDB's
// own reader because that one allocates what a damaged file asks for and ignores failed decompression.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "shared_array.h"

namespace vkvol {

// The bytes of one NanoVDB grid, aligned as NanoVDB requires. Copies share them.
class GridBytes {
public:
    GridBytes() = default;
    explicit GridBytes(std::size_t size) : blocks_((size + 31) / 32), size_(size) {}

    // For writing: this copy becomes its own.
    std::byte* edit() { return reinterpret_cast<std::byte*>(blocks_.edit()); }
    const std::byte* data() const { return reinterpret_cast<const std::byte*>(blocks_.data()); }
    std::size_t size() const { return size_; }
    std::span<const std::byte> span() const { return {data(), size_}; }
    // The same as kernels know it: behind the last byte are zeros, to the end of the word.
    std::span<const std::byte> words() const { return {data(), (size_ + 3) / 4 * 4}; }

private:
    struct alignas(32) Block {
        std::byte bytes[32];
    };
    SharedArray<Block> blocks_;
    std::size_t size_ = 0;
};

// What a file's header says of one grid.
struct GridEntry {
    std::string name;
    std::uint32_t type = 0;       // nanovdb::GridType
    std::uint32_t grid_class = 0; // nanovdb::GridClass
    std::uint64_t memory = 0;     // bytes, uncompressed
    std::uint64_t file_bytes = 0;
    std::uint64_t file_offset = 0;
    std::uint16_t codec = 0;
    std::string version; // of NanoVDB, "32.4.2"
};

const char* grid_type_name(std::uint32_t type);
const char* grid_class_name(std::uint32_t grid_class);
const char* codec_name(std::uint16_t codec);

// All functions throw InputError naming the file, what is wrong, and the remedy.
std::vector<GridEntry> read_nvdb_entries(const std::filesystem::path& file);
GridBytes read_nvdb_grid(const std::filesystem::path& file, const GridEntry& entry);

} // namespace vkvol
