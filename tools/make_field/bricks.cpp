#include "bricks.h"

#include <algorithm>
#include <cstdint>
#include <tbb/parallel_for.h>

namespace vkvol {
namespace {

int floor_to_brick(int i) {
    return i & ~(brick_width - 1);
}

std::vector<glm::ivec3> brick_origins(const IndexBox& box) {
    std::vector<glm::ivec3> origins;
    for (int i = floor_to_brick(box.min.x); i <= box.max.x; i += brick_width)
        for (int j = floor_to_brick(box.min.y); j <= box.max.y; j += brick_width)
            for (int k = floor_to_brick(box.min.z); k <= box.max.z; k += brick_width)
                origins.emplace_back(i, j, k);
    return origins;
}

template <class Visit> void for_each_sample(Brick& brick, Visit visit) {
    for (int i = 0; i < brick_width; ++i)
        for (int j = 0; j < brick_width; ++j)
            for (int k = 0; k < brick_width; ++k)
                visit(brick.origin + glm::ivec3(i, j, k), brick.value[Brick::offset(i, j, k)]);
}

void clear_outside(Brick& brick, const IndexBox& box) {
    for_each_sample(brick, [&](glm::ivec3 index, float& value) {
        if (!contains(box, index))
            value = 0.0f;
    });
}

bool is_zero(const Brick& brick) {
    return std::all_of(brick.value.begin(), brick.value.end(), [](float value) { return value == 0.0f; });
}

IndexBox bounds_of(const std::vector<Brick>& bricks) {
    IndexBox box{bricks.front().origin, bricks.front().origin};
    for (const Brick& brick : bricks) {
        box.min = glm::min(box.min, brick.origin);
        box.max = glm::max(box.max, brick.origin + (brick_width - 1));
    }
    return box;
}

// One byte or label per sample of a box, with a margin of one sample so that neighbours need no test.
class DenseLabels {
public:
    explicit DenseLabels(const IndexBox& box)
        : min_(box.min - 1), size_(box.max - box.min + 3),
          label_(std::size_t(size_.x) * std::size_t(size_.y) * std::size_t(size_.z), outside) {}

    static constexpr std::uint32_t outside = 0, unvisited = 1;

    std::size_t offset(glm::ivec3 index) const {
        const glm::ivec3 p = index - min_;
        return (std::size_t(p.x) * std::size_t(size_.y) + std::size_t(p.y)) * std::size_t(size_.z) + std::size_t(p.z);
    }
    std::uint32_t& operator[](std::size_t offset) { return label_[offset]; }
    std::size_t size() const { return label_.size(); }

    // Gives `label` to all that is connected to `seed`; returns how many samples that is.
    std::size_t flood(std::size_t seed, std::uint32_t label) {
        const std::size_t row = std::size_t(size_.z), slab = row * std::size_t(size_.y);
        std::vector<std::size_t> front{seed};
        label_[seed] = label;
        std::size_t count = 0;
        while (!front.empty()) {
            const std::size_t at = front.back();
            front.pop_back();
            ++count;
            for (const std::size_t next : {at - 1, at + 1, at - row, at + row, at - slab, at + slab})
                if (label_[next] == unvisited) {
                    label_[next] = label;
                    front.push_back(next);
                }
        }
        return count;
    }

private:
    glm::ivec3 min_, size_;
    std::vector<std::uint32_t> label_;
};

} // namespace

bool contains(const IndexBox& box, glm::ivec3 index) {
    return glm::all(glm::greaterThanEqual(index, box.min)) && glm::all(glm::lessThanEqual(index, box.max));
}

void fill_bricks(const IndexBox& box, std::span<FieldGrid> grids, const FillBrick& fill) {
    const std::vector<glm::ivec3> origins = brick_origins(box);
    const std::size_t batch = 512; // bounds the memory that empty bricks hold before they are dropped
    for (std::size_t begin = 0; begin < origins.size(); begin += batch) {
        const std::size_t count = std::min(batch, origins.size() - begin);
        std::vector<Brick> made(count * grids.size());
        tbb::parallel_for(std::size_t(0), count, [&](std::size_t n) {
            const std::span<Brick> channels(&made[n * grids.size()], grids.size());
            for (Brick& brick : channels)
                brick.origin = origins[begin + n];
            fill(channels);
            for (Brick& brick : channels)
                clear_outside(brick, box);
        });
        for (std::size_t n = 0; n < made.size(); ++n)
            if (!is_zero(made[n]))
                grids[n % grids.size()].bricks.push_back(made[n]);
    }
}

FieldGrid grid_of(const IndexBox& box, const std::function<float(glm::ivec3)>& value) {
    FieldGrid grid;
    fill_bricks(box, {&grid, 1}, [&](std::span<Brick> channels) {
        for_each_sample(channels[0], [&](glm::ivec3 index, float& sample) { sample = value(index); });
    });
    return grid;
}

void drop_islands(FieldGrid& grid) {
    if (grid.bricks.empty())
        return;
    DenseLabels labels(bounds_of(grid.bricks));
    for (Brick& brick : grid.bricks)
        for_each_sample(brick, [&](glm::ivec3 index, float value) {
            if (value != 0.0f)
                labels[labels.offset(index)] = DenseLabels::unvisited;
        });
    std::uint32_t label = DenseLabels::unvisited, largest = 0;
    std::size_t largest_count = 0;
    for (std::size_t at = 0; at < labels.size(); ++at) {
        if (labels[at] != DenseLabels::unvisited)
            continue;
        const std::size_t count = labels.flood(at, ++label);
        if (count > largest_count) {
            largest_count = count;
            largest = label;
        }
    }
    for (Brick& brick : grid.bricks)
        for_each_sample(brick, [&](glm::ivec3 index, float& value) {
            if (labels[labels.offset(index)] != largest)
                value = 0.0f;
        });
    std::erase_if(grid.bricks, is_zero);
}

} // namespace vkvol
