// Specialised kernels as files, for later runs: what SPIRV-Tools needs 0.1 to 0.8 s for is read in a millisecond.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <utility>
#include <vector>

#include "specialization.h"

namespace vkvol {

class KernelStore {
public:
    // The files are in `directory`, which need not exist; an empty one: nothing is kept. Of more than `most_bytes` the
    // files go that were not used for longest, until half are left. Any number of processes may share a directory.
    explicit KernelStore(std::filesystem::path directory, std::uintmax_t most_bytes = std::uintmax_t(64) << 20)
        : directory_(std::move(directory)), most_bytes_(most_bytes) {}

    // What specialized() returns. A damaged file is made again; failure to write is no error, only a slower next start.
    std::vector<std::uint32_t> get(std::span<const std::uint32_t> spirv, const Specialization& specialization) const;

private:
    void put(const std::filesystem::path& path, const std::vector<std::uint32_t>& kernel) const;
    void trim() const;

    std::filesystem::path directory_;
    std::uintmax_t most_bytes_;
};

} // namespace vkvol
