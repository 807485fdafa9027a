// Where in the device's buffers what media are made of lies: grids, their tables of leaves, tables of phase functions,
// maps of values and black bodies, one behind the other, and each once, however many media have it.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "loaded_medium.h"

namespace vkvol {

class UploadLayout {
public:
    using Parts = std::vector<std::span<const std::byte>>; // one after another

    // `media` outlive what is in `parts`.
    explicit UploadLayout(Media media);

    const Parts& grids() const { return grids_; }
    const Parts& leaf_tables() const { return leaf_tables_; }
    const Parts& phases() const { return phases_.parts; }
    const Parts& maps() const { return maps_.parts; }
    const Parts& blackbodies() const { return blackbodies_.parts; }

    // Place of a grid that one of the media has.
    struct GridPlace {
        std::uint32_t first_word, first_entry; // of the grid and of its leaf table
    };
    GridPlace place_of(const DensityField& grid) const { return grid_places_.at(grid.bytes.data()); }
    // First entries of tables; 0 without one.
    std::uint32_t first_node(const LoadedMedium& medium) const { return phases_.first(medium.phase_nodes); }
    std::uint32_t first_knot(const LoadedMedium& medium) const { return maps_.first(medium.map_knots); }
    std::uint32_t first_color(const LoadedMedium& medium) const { return blackbodies_.first(medium.blackbody); }

private:
    // Tables of one kind.
    struct Tables {
        Parts parts;
        std::map<const void*, std::uint32_t> places;
        std::uint32_t size = 0;

        template <class T> void add(const SharedArray<T>& table);
        template <class T> std::uint32_t first(const SharedArray<T>& table) const {
            return table.empty() ? 0u : places.at(table.data());
        }
    };

    Parts grids_, leaf_tables_;
    std::map<const std::byte*, GridPlace> grid_places_;
    Tables phases_, maps_, blackbodies_;
};

} // namespace vkvol
