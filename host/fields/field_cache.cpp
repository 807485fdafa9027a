#include "field_cache.h"

#include <set>

#include "shared/constants.h"

namespace vkvol {

FieldCache::Stamp FieldCache::stamp_of(const GridFile& file) {
    if (file.memory)
        return {0, {}, file.memory};
    std::error_code ignored;
    return {std::filesystem::file_size(file.path, ignored), std::filesystem::last_write_time(file.path, ignored), {}};
}

DensityField FieldCache::take(const GridFile& file, GridValues values) {
    const Stamp stamp = stamp_of(file);
    const Key key = key_of(file);
    const auto is_of = [&](const DensityField& field) {
        return values == GridValues::numbers_or_colors || field.type != GRID_COLOR;
    };
    if (const auto found = fields_.find(key);
        found != fields_.end() && found->second.stamp == stamp && is_of(found->second.value))
        return found->second.value;
    fields_.erase(key);
    return fields_.insert_or_assign(key, Stamped<DensityField>{stamp, load_density_field(file, values)})
        .first->second.value;
}

bool FieldCache::has(const GridFile& file) {
    const Stamp stamp = stamp_of(file);
    const Key key = key_of(file);
    if (const auto found = there_.find(key); found != there_.end() && found->second.stamp == stamp)
        return found->second.value;
    return there_.insert_or_assign(key, Stamped<bool>{stamp, has_grid(file)}).first->second.value;
}

void FieldCache::retain(const std::vector<GridFile>& files) {
    std::set<Key> kept;
    for (const GridFile& file : files)
        kept.insert(key_of(file));
    const auto is_left = [&](const auto& entry) { return kept.count(entry.first) == 0; };
    std::erase_if(fields_, is_left);
    std::erase_if(there_, is_left);
}

} // namespace vkvol
