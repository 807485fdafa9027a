#include "overlap_words.h"

#include <cstring>
#include <map>

namespace vkvol {

static_assert(sizeof(shared::MemberRow) == 64 && sizeof(shared::GridRow) == 64, "four texels of four words");
static_assert(sizeof(shared::OverlapParams) == 2 * 4);

namespace {

template <class Row> void append(std::vector<std::uint32_t>& words, const Row& row) {
    constexpr std::size_t count = sizeof row / sizeof(std::uint32_t);
    words.resize(words.size() + count);
    std::memcpy(words.data() + words.size() - count, &row, sizeof row);
}

} // namespace

OverlapWords overlap_words(std::span<const shared::MediumParams> rows, const Superposition& whole) {
    constexpr std::uint32_t texels = sizeof(shared::MemberRow) / 16;
    OverlapWords result{};
    std::map<std::uint32_t, std::uint32_t> grid_rows; // by where the grid is, their first texels
    std::vector<shared::GridRow> grids;
    for (const shared::MediumParams& row : rows) {
        shared::MemberRow member{};
        for (int i = 0; i < 3; ++i)
            member.to_medium[i] = row.to_medium[i];
        member.sigma_t = row.sigma_t;
        member.kinds = static_cast<std::uint32_t>(row.kinds.shape | row.kinds.field << 8 | row.kinds.grid_type << 16 |
                                                  row.kinds.map << 24);
        member.first_knot = row.first_knot;
        if (row.kinds.field == FIELD_GRID && row.kinds.shape != SHAPE_NONE) {
            const auto next = static_cast<std::uint32_t>(texels * (rows.size() + grids.size()));
            const auto [found, is_new] = grid_rows.try_emplace(row.density.first_word, next);
            if (is_new)
                grids.push_back({row.density, {}});
            member.grid = found->second;
        }
        append(result.words, member);
    }
    for (const shared::GridRow& grid : grids)
        append(result.words, grid);
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
    return result;
}

} // namespace vkvol
