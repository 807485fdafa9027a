#include "upload_layout.h"

namespace vkvol {

template <class T> void UploadLayout::Tables::add(const SharedArray<T>& table) {
    if (table.empty() || !places.try_emplace(table.data(), size).second)
        return;
    parts.push_back(std::as_bytes(std::span<const T>(table)));
    size += static_cast<std::uint32_t>(table.size());
}

UploadLayout::UploadLayout(Media media) {
    GridPlace next{0, 0};
    for (const DensityField* grid : distinct_grids(media)) {
        grid_places_.emplace(grid->bytes.data(), next);
        grids_.push_back(grid->bytes.words());
        leaf_tables_.push_back(std::as_bytes(std::span<const std::uint32_t>(grid->leaf_table)));
        next.first_word += static_cast<std::uint32_t>(grid->bytes.words().size() / 4);
        next.first_entry += static_cast<std::uint32_t>(grid->leaf_table.size());
    }
    for (const LoadedMedium& medium : media) {
        phases_.add(medium.phase_nodes);
        maps_.add(medium.map_knots);
        blackbodies_.add(medium.blackbody);
    }
}

} // namespace vkvol
