// Grids in memory, so that each is read once, however many media of a scene and frames of a sequence have it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <future>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "density_field.h"

namespace vkvol {

class FieldCache {
public:
    // The grid in memory, with what is large in it shared, if its file has not changed since; else as
    // load_density_field.
    DensityField take(const GridFile& file, GridValues values = GridValues::numbers);
    // Begins to read those that are not here, beside other work, in place of any that were foreseen before and not
    // taken since. What is wrong with one is told when it is taken.
    void foresee(const std::vector<GridFile>& files);
    // As has_grid, whose answer is kept likewise.
    bool has(const GridFile& file);
    // Lets go of all others but foreseen ones. A sequence of files needs one at a time, and the next.
    void retain(const std::vector<GridFile>& files);

private:
    using Key = std::pair<std::string, std::string>; // file, grid
    struct Stamp {
        std::uintmax_t bytes = 0;
        std::filesystem::file_time_type changed;
        std::shared_ptr<const MemoryGrids> memory;
        bool operator==(const Stamp&) const = default;
    };
    template <class T> struct Stamped {
        Stamp stamp;
        T value;
    };

    static Key key_of(const GridFile& file) { return {file.path.native(), file.grid}; }
    static Stamp stamp_of(const GridFile& file);
    bool is_here(const GridFile& file) const;
    DensityField load(const GridFile& file, const Stamp& stamp, GridValues values);

    std::map<Key, Stamped<DensityField>> fields_;
    std::map<Key, Stamped<std::future<DensityField>>> coming_;
    std::map<Key, Stamped<bool>> there_;
};

} // namespace vkvol
