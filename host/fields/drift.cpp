#include "drift.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <type_traits>
#include <vector>

#include "error.h"
#include "finish_grid.h"
#include "shared/constants.h"

namespace vkvol {

namespace {

constexpr double farthest = 4096.0;               // voxels
constexpr double most_blocks = double(1u << 22u); // of 8^3 voxels, for which a moment takes minutes

glm::dvec3 to_vector(glm::vec3 value) {
    return value;
}

// `at`(voxel) -> glm::dvec3 or double.
template <class At> auto trilinear(glm::dvec3 p, const At& at) {
    p = glm::clamp(p, -0x1p25, 0x1p25); // beyond all grids, and whole numbers still
    const glm::dvec3 base = glm::floor(p), part = p - base;
    const glm::ivec3 i(base);
    auto sum = at(i) * 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 step(corner & 1, corner >> 1 & 1, corner >> 2);
        const glm::dvec3 weight = glm::mix(1.0 - part, part, glm::dvec3(step));
        if (const double w = weight.x * weight.y * weight.z; w > 0.0)
            sum += w * at(i + step);
    }
    return sum;
}

// A box of voxels, from `low` to `high`, both inclusive.
struct VoxelBox {
    glm::ivec3 low, high;
};

glm::ivec3 blocks_of(const VoxelBox& box) {
    return (box.high >> 3) - (box.low >> 3) + 1;
}

class Drifting {
public:
    Drifting(const DensityField& field, const DensityField& velocity, double seconds, bool goes_on)
        : field_(field), velocity_(velocity), goes_on_(goes_on),
          to_velocity_(glm::inverse(velocity.as_authored) * field.as_authored),
          to_voxels_(glm::inverse(glm::dmat3(field.as_authored)) * seconds), reach_(longest_way()), windy_(windy()),
          box_(box()), blocks_(blocks_of(box_)) {
        find_blocks();
    }

    template <class Value> GridBytes build() const;

private:
    // In voxels, how far what is now at a voxel has come.
    glm::dvec3 way(glm::ivec3 voxel) const {
        const glm::dvec3 p = to_velocity_ * glm::dvec4(voxel, 1.0);
        const auto at = [&](glm::ivec3 ijk) { return to_vector(velocity_.color(ijk)); };
        if (!velocity_.is_staggered)
            return to_voxels_ * trilinear(p, at);
        glm::dvec3 v;
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 from = p;
            from[axis] += 0.5;
            v[axis] = trilinear(from, at)[axis];
        }
        return to_voxels_ * v;
    }

    // Along each axis, of any velocity: trilinear ones are no longer.
    glm::ivec3 longest_way() const {
        glm::dvec3 longest(0.0);
        glm::ivec3 b;
        for (b.x = 0; b.x < velocity_.leaf_dims.x; ++b.x)
            for (b.y = 0; b.y < velocity_.leaf_dims.y; ++b.y)
                for (b.z = 0; b.z < velocity_.leaf_dims.z; ++b.z) {
                    const DensityField::Block part = velocity_.block(b);
                    const glm::ivec3 high = part.constant ? part.low : part.high;
                    for (int x = part.low.x; x <= high.x; ++x)
                        for (int y = part.low.y; y <= high.y; ++y)
                            for (int z = part.low.z; z <= high.z; ++z)
                                longest = glm::max(longest, glm::abs(glm::dvec3(velocity_.color({x, y, z}))));
                }
        // A staggered vector has components of several: a box of them bounds each.
        glm::dvec3 reach(0.0);
        for (int axis = 0; axis < 3; ++axis)
            reach += glm::abs(to_voxels_[axis]) * longest[axis];
        const double most = std::max({reach.x, reach.y, reach.z});
        if (!(most <= farthest))
            throw InputError(fmt::format("moves by {:.3g} voxels in the time that light is taken in, and {:g} are the "
                                         "most; velocities are world units per second: raise framesPerSecond, or let "
                                         "<motionBlur> close sooner",
                                         most, farthest));
        return glm::ivec3(glm::ceil(reach)) + 1;
    }

    // Where there are velocities within reach of the grid's voxels; empty if they are all elsewhere.
    VoxelBox windy() const {
        const glm::dmat4 to_voxels = glm::inverse(to_velocity_);
        glm::dvec3 low(1e9), high(-1e9);
        for (int corner = 0; corner < 8; ++corner) {
            const glm::bvec3 side(corner & 1, corner >> 1 & 1, corner >> 2);
            const glm::dvec3 at =
                glm::mix(glm::dvec3(velocity_.voxel_min - 2), glm::dvec3(velocity_.voxel_max + 2), side);
            const glm::dvec3 voxel = to_voxels * glm::dvec4(at, 1.0);
            low = glm::min(low, voxel);
            high = glm::max(high, voxel);
        }
        const glm::dvec3 first = field_.voxel_min - reach_, last = field_.voxel_max + reach_;
        return {glm::ivec3(glm::floor(glm::clamp(low, first, last + 1.0))),
                glm::ivec3(glm::ceil(glm::clamp(high, first - 1.0, last)))};
    }

    // The grid's voxels, and those.
    VoxelBox box() const {
        VoxelBox box{field_.voxel_min, field_.voxel_max};
        if (!goes_on_ && glm::all(glm::lessThanEqual(windy_.low, windy_.high))) {
            box.low = glm::min(box.low, windy_.low);
            box.high = glm::max(box.high, windy_.high);
        }
        const glm::dvec3 blocks = glm::dvec3(blocks_of(box));
        check_blocks(blocks.x * blocks.y * blocks.z, 64.0 * most_blocks);
        return box;
    }

    static void check_blocks(double blocks, double most) {
        if (blocks > most)
            throw InputError(
                fmt::format("moves things within {:.3g} voxels, and {:.3g} are the most; crop the grids, or "
                            "raise framesPerSecond, if velocities are stray",
                            512.0 * blocks, 512.0 * most));
    }

    std::size_t place_of(glm::ivec3 block) const {
        return (std::size_t(block.x) * blocks_.y + block.y) * blocks_.z + block.z;
    }

    // Blocks of 8^3 voxels that may get something: those of the grid that are not 0, and what is within reach of them.
    void find_blocks() {
        wanted_.assign(std::size_t(blocks_.x) * blocks_.y * blocks_.z, 0);
        const glm::ivec3 first = field_.leaf_min - (box_.low >> 3);
        glm::ivec3 b;
        for (b.x = 0; b.x < field_.leaf_dims.x; ++b.x)
            for (b.y = 0; b.y < field_.leaf_dims.y; ++b.y)
                for (b.z = 0; b.z < field_.leaf_dims.z; ++b.z)
                    wanted_[place_of(first + b)] = field_.block(b).constant.value_or(1.0f) > 0.0f;
        const std::vector<char> holds = wanted_;
        for (int axis = 0; axis < 3; ++axis)
            widen(axis, (reach_[axis] + 7) / 8);
        for (b.x = 0; b.x < blocks_.x; ++b.x)
            for (b.y = 0; b.y < blocks_.y; ++b.y)
                for (b.z = 0; b.z < blocks_.z; ++b.z)
                    wanted_[place_of(b)] &= holds[place_of(b)] || meets_wind(b);
        check_blocks(double(std::count(wanted_.begin(), wanted_.end(), 1)), most_blocks);
    }

    bool meets_wind(glm::ivec3 block) const {
        const glm::ivec3 first = ((box_.low >> 3) + block) * 8;
        return glm::all(glm::lessThanEqual(first, windy_.high)) &&
               glm::all(glm::greaterThanEqual(first + 7, windy_.low));
    }

    void widen(int axis, int reach) {
        glm::ivec3 step(0);
        step[axis] = 1;
        glm::ivec3 size = blocks_;
        size[axis] = 1;
        std::vector<char> line(std::size_t(blocks_[axis]));
        glm::ivec3 b;
        for (b.x = 0; b.x < size.x; ++b.x)
            for (b.y = 0; b.y < size.y; ++b.y)
                for (b.z = 0; b.z < size.z; ++b.z) {
                    for (int i = 0; i < blocks_[axis]; ++i)
                        line[std::size_t(i)] = wanted_[place_of(b + i * step)];
                    int last = -reach - 1;
                    for (int i = 0; i < blocks_[axis]; ++i) {
                        last = line[std::size_t(i)] ? i : last;
                        wanted_[place_of(b + i * step)] |= i - last <= reach;
                    }
                    last = blocks_[axis] + reach;
                    for (int i = blocks_[axis] - 1; i >= 0; --i) {
                        last = line[std::size_t(i)] ? i : last;
                        wanted_[place_of(b + i * step)] |= last - i <= reach;
                    }
                }
    }

    template <class Value> Value value_at(glm::ivec3 voxel) const {
        glm::dvec3 from = glm::dvec3(voxel) - way(voxel);
        if (goes_on_)
            from = glm::clamp(from, glm::dvec3(field_.voxel_min), glm::dvec3(field_.voxel_max));
        if constexpr (std::is_same_v<Value, float>) {
            return static_cast<float>(trilinear(from, [&](glm::ivec3 ijk) { return double(field_.value(ijk)); }));
        } else {
            const glm::dvec3 color = trilinear(from, [&](glm::ivec3 ijk) { return to_vector(field_.color(ijk)); });
            return {float(color.x), float(color.y), float(color.z)};
        }
    }

    const DensityField& field_;
    const DensityField& velocity_;
    const bool goes_on_;           // beyond its box as it is at its faces
    const glm::dmat4 to_velocity_; // from voxels of the grid to those of the velocities
    const glm::dmat3 to_voxels_;   // from velocities to ways
    const glm::ivec3 reach_;       // voxels
    const VoxelBox windy_;
    const VoxelBox box_;
    const glm::ivec3 blocks_;
    std::vector<char> wanted_; // of each block of the box, z fastest
};

template <class Value> GridBytes Drifting::build() const {
    const Value nothing(0.0f);
    constexpr bool is_number = std::is_same_v<Value, float>;
    nanovdb::GridBuilder<Value> builder(nothing,
                                        is_number ? nanovdb::GridClass::FogVolume : nanovdb::GridClass::Unknown);
    auto accessor = builder.getAccessor();
    glm::ivec3 b;
    for (b.x = 0; b.x < blocks_.x; ++b.x)
        for (b.y = 0; b.y < blocks_.y; ++b.y)
            for (b.z = 0; b.z < blocks_.z; ++b.z) {
                if (!wanted_[place_of(b)])
                    continue;
                const glm::ivec3 first = ((box_.low >> 3) + b) * 8;
                for (int n = 0; n < 512; ++n) {
                    const glm::ivec3 voxel = first + glm::ivec3(n >> 6, n >> 3 & 7, n & 7);
                    if (voxel != glm::clamp(voxel, box_.low, box_.high))
                        continue;
                    if (const Value value = value_at<Value>(voxel); value != nothing)
                        accessor.setValue({voxel.x, voxel.y, voxel.z}, value);
                }
            }
    for (const glm::ivec3& corner : {field_.voxel_min, field_.voxel_max}) // of the box, which does not shrink
        accessor.setValue({corner.x, corner.y, corner.z}, value_at<Value>(corner));
    return finish_grid(builder, field_.as_authored, "drifted");
}

} // namespace

DensityField drifted(const DensityField& field, const DensityField& velocity, double seconds, bool goes_on) {
    if (field.active_voxels == 0 || velocity.active_voxels == 0 || seconds == 0.0)
        return field;
    const Drifting drifting(field, velocity, seconds, goes_on);
    const bool is_color = field.type == GRID_COLOR;
    DensityField result =
        make_density_field(is_color ? drifting.build<nanovdb::Vec3f>() : drifting.build<float>(), "what drifted",
                           is_color ? GridValues::numbers_or_colors : GridValues::numbers);
    result.as_authored = field.as_authored; // which went through no rounding
    result.index_to_world = field.index_to_world;
    result.cleaned = field.cleaned + velocity.cleaned;
    return result;
}

} // namespace vkvol
