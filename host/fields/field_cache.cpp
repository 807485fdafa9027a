#include "field_cache.h"

#include <algorithm>
#include <utility>

#include "shared/constants.h"

namespace vkvol {

FieldCache::Stamp FieldCache::stamp_of(const std::filesystem::path& path) {
    std::error_code ignored;
    return {std::filesystem::file_size(path, ignored), std::filesystem::last_write_time(path, ignored)};
}

DensityField FieldCache::take(const GridFile& file, GridValues values) {
    const Stamp stamp = stamp_of(file.path);
    const auto is_this = [&](const Entry& entry) {
        return entry.file.path == file.path && entry.file.grid == file.grid;
    };
    const auto entry = std::find_if(entries_.begin(), entries_.end(), is_this);
    const auto is_of = [&](const DensityField& field) {
        return values == GridValues::numbers_or_colors || field.type != GRID_COLOR;
    };
    if (entry != entries_.end() && entry->field && entry->stamp == stamp && is_of(*entry->field))
        return *std::exchange(entry->field, std::nullopt);
    std::erase_if(entries_, [&](const Entry& other) { return is_this(other) || other.file.path != file.path; });
    DensityField field = load_density_field(file, values);
    entries_.push_back({file, stamp, std::nullopt});
    return field;
}

void FieldCache::keep(const GridFile& file, DensityField field) {
    for (Entry& entry : entries_)
        if (entry.file.path == file.path && entry.file.grid == file.grid)
            entry.field = std::move(field);
}

} // namespace vkvol
