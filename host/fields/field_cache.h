// Grids that stay in memory between the frames of a sequence, so that each is read once.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "density_field.h"

namespace vkvol {

class FieldCache {
public:
    // The grid that was kept, if its file has not changed since, else as load_density_field. Grids of other files are
    // let go of where this one has to be read: a sequence of files needs one at a time.
    DensityField take(const GridFile& file, GridValues values = GridValues::numbers);
    // Until the next `take` of it.
    void keep(const GridFile& file, DensityField field);

private:
    struct Stamp {
        std::uintmax_t bytes = 0;
        std::filesystem::file_time_type changed;
        bool operator==(const Stamp&) const = default;
    };
    struct Entry {
        GridFile file;
        Stamp stamp;
        std::optional<DensityField> field; // none: taken
    };

    static Stamp stamp_of(const std::filesystem::path& path);

    std::vector<Entry> entries_;
};

} // namespace vkvol
