#include "overlap_words.h"

#include <cstring>
#include <map>

namespace vkvol {

static_assert(sizeof(shared::MemberRow) == 64 && sizeof(shared::GridRow) == 64, "four texels of four words");
static_assert(sizeof(shared::OverlapParams) == 3 * 4);

namespace {

template <class Row> void append(std::vector<std::uint32_t>& words, const Row& row) {
    constexpr std::size_t count = sizeof row / sizeof(std::uint32_t);
    words.resize(words.size() + count);
    std::memcpy(words.data() + words.size() - count, &row, sizeof row);
}

bool has_grid(const shared::MediumParams& row) {
    return row.kinds.field == FIELD_GRID && row.kinds.shape != SHAPE_NONE;
}

} // namespace

OverlapWords overlap_words(std::span<const shared::MediumParams> rows, Media media, const Superposition& whole) {
    constexpr std::uint32_t texels = sizeof(shared::MemberRow) / 16;
    OverlapWords result{};
    std::map<std::uint32_t, std::uint32_t> grid_rows; // by where the grid is, their first texels
    std::vector<shared::GridRow> grids;
    for (const shared::MediumParams& row : rows)
        if (has_grid(row) &&
            grid_rows.try_emplace(row.density.first_word, texels * (rows.size() + grids.size())).second)
            grids.push_back({row.density, {}});
    std::vector<std::uint32_t> meshes;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const shared::MediumParams& row = rows[i];
        shared::MemberRow member{};
        for (int k = 0; k < 3; ++k)
            member.to_medium[k] = row.to_medium[k];
        member.sigma_t = row.sigma_t;
        member.kinds = static_cast<std::uint32_t>(row.kinds.shape | row.kinds.field << 8 | row.kinds.grid_type << 16 |
                                                  row.kinds.map << 24);
        member.first_knot = row.first_knot;
        if (has_grid(row))
            member.grid = grid_rows.at(row.density.first_word);
        if (row.kinds.shape == SHAPE_MESH) {
            member.grid = static_cast<std::uint32_t>(4 * texels * (rows.size() + grids.size()) + meshes.size());
            const std::vector<std::uint32_t>& words = media[i].inside->words;
            meshes.insert(meshes.end(), words.begin(), words.end());
        }
        append(result.words, member);
    }
    for (const shared::GridRow& grid : grids)
        append(result.words, grid);
    result.words.insert(result.words.end(), meshes.begin(), meshes.end());
    if (!grids.empty())
        result.grid = grids.front().grid;
    result.places.bricks = static_cast<std::uint32_t>(result.words.size());
    result.words.insert(result.words.end(), whole.bricks.begin(), whole.bricks.end());
    const auto lists = result.places.lists = static_cast<std::uint32_t>(result.words.size());
    result.words.insert(result.words.end(), whole.overlaps.begin(), whole.overlaps.end());
    for (std::size_t i = 0; i < whole.entries(); ++i) {
        const bool empty = whole.overlaps[i] == whole.overlaps[i + 1];
        result.words[lists + i] = empty ? 0 : lists + whole.overlaps[i];
        if (!empty)
            result.words[lists + whole.overlaps[i + 1] - 1] |= LAST_OF_LIST;
    }
    result.places.all = static_cast<std::uint32_t>(result.words.size());
    for (std::uint32_t i = 0; i < rows.size(); ++i)
        result.words.push_back(i);
    result.words.back() |= LAST_OF_LIST;
    return result;
}

} // namespace vkvol
