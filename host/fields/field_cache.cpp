#include "field_cache.h"

#include <set>
#include <system_error>

#include "shared/constants.h"

namespace vkvol {

namespace {

bool is_of(const DensityField& field, GridValues values) {
    return field.is_signed == (values == GridValues::vectors) &&
           (values != GridValues::numbers || field.type != GRID_COLOR);
}

} // namespace

FieldCache::Stamp FieldCache::stamp_of(const GridFile& file) {
    if (file.memory)
        return {0, {}, file.memory};
    std::error_code ignored;
    return {std::filesystem::file_size(file.path, ignored), std::filesystem::last_write_time(file.path, ignored), {}};
}

bool FieldCache::is_here(const GridFile& file) const {
    const auto found = fields_.find(key_of(file));
    return found != fields_.end() && found->second.stamp == stamp_of(file);
}

DensityField FieldCache::take(const GridFile& file, GridValues values) {
    const Key key = key_of(file);
    if (is_here(file) && is_of(fields_.at(key).value, values))
        return fields_.at(key).value;
    fields_.erase(key);
    const Stamp stamp = stamp_of(file);
    return fields_.insert_or_assign(key, Stamped<DensityField>{stamp, load(file, stamp, values)}).first->second.value;
}

// As it was foreseen, if that is the same. What went wrong then, for want of memory, say, is tried again.
DensityField FieldCache::load(const GridFile& file, const Stamp& stamp, GridValues values) {
    auto coming = coming_.extract(key_of(file));
    if (!coming.empty() && coming.mapped().stamp == stamp)
        try {
            if (DensityField field = coming.mapped().value.get(); is_of(field, values))
                return field;
        } catch (const std::exception&) {
        }
    return load_density_field(file, values);
}

void FieldCache::foresee(const std::vector<GridFile>& files) {
    std::map<Key, Stamped<std::future<DensityField>>> coming;
    for (const GridFile& file : files) {
        if (file.grid.empty() || is_here(file) || coming.count(key_of(file)) > 0)
            continue;
        const Stamp stamp = stamp_of(file);
        auto begun = coming_.extract(key_of(file));
        if (!begun.empty() && begun.mapped().stamp == stamp)
            coming.insert(std::move(begun));
        else
            try {
                coming[key_of(file)] = {stamp, std::async(std::launch::async, [file] {
                                            return load_density_field(file, GridValues::numbers_or_colors);
                                        })};
            } catch (const std::system_error&) { // no thread to be had: it is read when it is needed
                coming.erase(key_of(file));
            }
    }
    coming_ = std::move(coming);
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
