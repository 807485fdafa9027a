#include "superposition.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <utility>

#include "empty_space.h"
#include "error.h"
#include "layers.h"
#include "medium_pieces.h"
#include "placement.h"

namespace vkvol {

namespace {

constexpr double most_cells = 1 << 21;        // of all, or of bricks
constexpr double most_coarse_cells = 1 << 18; // beside bricks
constexpr int most_bits = 5;
constexpr std::size_t most_overlaps = std::size_t{1} << 29;

// A box along the axes around a box of another space.
struct AxisBox {
    glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
};

AxisBox around(const glm::dmat4& map, glm::dvec3 middle, glm::dvec3 half) {
    const glm::dvec3 there(map * glm::dvec4(middle, 1.0));
    const glm::dvec3 reach = glm::abs(glm::dvec3(map[0])) * half.x + glm::abs(glm::dvec3(map[1])) * half.y +
                             glm::abs(glm::dvec3(map[2])) * half.z;
    return {there - reach, there + reach};
}

// One of several media, of those that have matter.
struct Member {
    std::uint32_t number; // in the scene
    const Volume& volume;
    const LoadedMedium& loaded;
    glm::dmat4 to_world;
    double sigma_t; // at density 1
    double cell;    // world units, as it has them by itself
};

// Where in the world a volume that is everywhere and has layers has its height: an axis, and the factor and the offset
// that make a height of it. Upright in cells that go on for ever, or these would have no end of it.
struct Upright {
    int axis = 1;
    double factor = 1.0, offset = 0.0; // height = factor * place + offset
};

Upright upright(const Volume& volume) {
    const glm::dmat4 to_unmoved = glm::inverse(volume.transform);
    Upright found;
    double most = 0.0, others = 0.0;
    for (int column = 0; column < 3; ++column) {
        const double part = to_unmoved[column][volume.layers->axis];
        others += std::abs(part);
        if (std::abs(part) > std::abs(most)) {
            most = part;
            found.axis = column;
        }
    }
    if (others - std::abs(most) > 1e-9 * std::abs(most))
        throw InputError(fmt::format("{}<layers> that are <everywhere> beside other volumes stand along an axis of the "
                                     "world; leave the tilt out of their <transform>, or give them a <box>",
                                     volume.place.empty() ? "" : volume.place + ": "));
    found.factor = most;
    found.offset = to_unmoved[3][volume.layers->axis];
    return found;
}

// Cell length of a volume that is everywhere and has layers: as thick as the slabs that bound them, or thicker, as long
// as that adds no more than a null collision for two cells.
double layered_cell(const Volume& volume, double slab, double sigma_t) {
    const Layers& layers = *volume.layers;
    const double of_height = 1.0 / std::abs(upright(volume).factor); // in the world
    const double most = sigma_t * layer_range(volume, layers.bottom, layers.top).most;
    return std::min((layers.top - layers.bottom) * of_height, std::max(slab * of_height, 0.5 / most));
}

std::vector<Member> members_of(const Scene& scene, Media media) {
    std::vector<Member> members;
    for (std::size_t i = 0; i < media.size(); ++i) {
        const Volume& volume = scene.volumes[i];
        const DensityField* field = media[i].field ? &*media[i].field : nullptr;
        if (!has_matter(volume, media[i]))
            continue;
        const double sigma_t = largest(world_sigma_t(volume, field));
        const double cell = usual_cell(volume, media[i]);
        members.push_back({static_cast<std::uint32_t>(i), volume, media[i], medium_to_world(volume, media[i]), sigma_t,
                           is_everywhere(volume) && volume.layers ? layered_cell(volume, cell, sigma_t) : cell});
    }
    return members;
}

AxisBox box_around(const std::vector<Member>& members) {
    AxisBox box;
    for (const Member& member : members) {
        if (is_everywhere(member.volume))
            continue;
        const MediumBounds bounds = medium_bounds(member.loaded);
        const AxisBox other =
            around(member.to_world, 0.5 * (bounds.low + bounds.high), 0.5 * (bounds.high - bounds.low));
        box = {glm::min(box.low, other.low), glm::max(box.high, other.high)};
    }
    return box;
}

// What is everywhere has cells about the camera, if there is nothing else, and all of its layers in them.
void take_in(const std::vector<Member>& members, const glm::dvec3& camera, double wanted, AxisBox& box) {
    if (box.low.x > box.high.x)
        box = {camera - 2.0 * wanted, camera + 2.0 * wanted};
    for (const Member& member : members) {
        const std::optional<Layers>& layers = member.volume.layers;
        if (!is_everywhere(member.volume) || !layers)
            continue;
        const Upright place = upright(member.volume);
        for (const double height : {layers->bottom, layers->top}) {
            const double at = (height - place.offset) / place.factor;
            box.low[place.axis] = std::min(box.low[place.axis], at);
            box.high[place.axis] = std::max(box.high[place.axis], at);
        }
    }
}

// Bounds of the extinction between the faces of cells along that axis. In the outermost there are no layers: see
// empty_cells().
std::vector<double> layers_in_cells(const Volume& volume, const Upright& place, const Superposition& whole,
                                    double sigma_t) {
    std::vector<double> bounds;
    for (int k = 0; k < whole.dims()[place.axis]; ++k) {
        // A point on the device may be as far aside as single precision lets it be.
        const double reach = std::abs(whole.cells.origin[place.axis]) + whole.dims()[place.axis];
        const double margin = (1e-3 + 1e-6 * reach) * whole.edge;
        const double low = whole.origin[place.axis] + whole.edge * (whole.cells.origin[place.axis] + k);
        const double from = low - margin, to = low + whole.edge + margin;
        const auto [a, b] = std::minmax({place.factor * from + place.offset, place.factor * to + place.offset});
        bounds.push_back(sigma_t * layer_range(volume, a, b).most);
    }
    return bounds;
}

// Cells of this edge [world units] over the box, all of them coarse if `bits` is not 0. There are no bricks yet. Where
// walks go on for ever, `has_ring`, so do the outermost cells: then these are beyond the box, and what ends bounds none
// of them. Else walks that left it would meet null collisions without end.
// `origin`: of render space, amid what is to be seen: air above it would have it high up, where single precision is
// coarse.
Superposition empty_cells(const AxisBox& box, const glm::dvec3& origin, double edge, int bits, bool has_ring) {
    Superposition whole;
    whole.origin = origin;
    whole.edge = edge;
    whole.bits = bits;
    const int cell = 1 << bits;
    const glm::dvec3 from = (box.low - origin) / (edge * cell), to = (box.high - origin) / (edge * cell);
    // A little more, for what rounding may do to a box's faces.
    const int ring = has_ring ? 1 : 0;
    const glm::ivec3 low = glm::ivec3(glm::floor(from - 1e-2)) - ring, high = glm::ivec3(glm::ceil(to + 1e-2)) + ring;
    whole.cells.cell = cell;
    whole.cells.origin = low * cell;
    whole.cells.dims = high - low;
    const glm::dvec3 dims(whole.cells.dims);
    whole.cells.bounds.assign(static_cast<std::size_t>(dims.x * dims.y * dims.z), 0.0f);
    if (bits > 0)
        whole.bricks.assign(whole.cells.bounds.size(), 0);
    return whole;
}

// Which entries a medium reaches into, and its bounds there.
class Touch {
public:
    Touch(const Superposition& whole, PieceStore& pieces)
        : whole_(whole), pieces_(pieces), bounds_(whole.entries(), 0.0f),
          to_cells_(glm::scale(glm::dmat4(1.0), glm::dvec3(1.0 / whole.edge)) *
                    glm::translate(glm::dmat4(1.0), -whole.origin)) {}

    // Calls visit(entry, bound) for each of them once. `finest`: of the places that are told apart, world units.
    template <class Visit> void operator()(const Member& member, double finest, const Visit& visit) {
        if (is_everywhere(member.volume))
            raise_everywhere(member);
        else
            raise_pieces(member, finest);
        for (const std::uint32_t entry : touched_) {
            visit(entry, bounds_[entry]);
            bounds_[entry] = 0.0f;
        }
        touched_.clear();
    }

private:
    void raise_pieces(const Member& member, double finest) {
        const Pieces& pieces = pieces_.of(member.volume, member.loaded, finest);
        const glm::dmat4 map = to_cells_ * member.to_world;
        const glm::ivec3 dims = whole_.dims();
        // A grid's pieces are of whole cells, of which some is beyond its voxels.
        const MediumBounds bounds = medium_bounds(member.loaded);
        for (const Pieces::Piece& piece : pieces.parts) {
            const glm::dvec3 from = glm::max(piece.middle - pieces.half, glm::dvec3(bounds.low)),
                             to = glm::min(piece.middle + pieces.half, glm::dvec3(bounds.high));
            if (glm::any(glm::greaterThan(from, to)))
                continue;
            // A point on the device may be as far aside as single precision lets it be.
            const AxisBox box = around(map, 0.5 * (from + to), 0.5 * (to - from));
            // Along any axis, since it may be turned.
            const glm::dvec3 reach = glm::max(glm::abs(box.low), glm::abs(box.high));
            const double margin = 1e-4 + 1e-6 * std::max({reach.x, reach.y, reach.z});
            const glm::ivec3 low =
                glm::clamp(glm::ivec3(glm::floor(box.low - margin)) - whole_.cells.origin, glm::ivec3(0), dims - 1);
            const glm::ivec3 high =
                glm::clamp(glm::ivec3(glm::floor(box.high + margin)) - whole_.cells.origin, glm::ivec3(0), dims - 1);
            raise(low, high, static_cast<float>(member.sigma_t * piece.bound * (1.0 + 1e-6)));
        }
    }

    // All cells, or those in which there are layers.
    void raise_everywhere(const Member& member) {
        const glm::ivec3 last = whole_.dims() - 1;
        const double sigma_t = member.sigma_t * pieces_.scale() * (1.0 + 1e-6);
        if (!member.loaded.is_layered)
            return raise(glm::ivec3(0), last, static_cast<float>(sigma_t));
        const Upright place = upright(member.volume);
        const std::vector<double> bounds = layers_in_cells(member.volume, place, whole_, sigma_t);
        for (int k = 0; k <= last[place.axis]; ++k) {
            glm::ivec3 low(0), high = last;
            low[place.axis] = high[place.axis] = k;
            if (bounds[std::size_t(k)] > 0.0)
                raise(low, high, static_cast<float>(bounds[std::size_t(k)]));
        }
    }

    // All entries of the cells from `low` to `high`.
    void raise(glm::ivec3 low, glm::ivec3 high, float bound) {
        const glm::ivec3 first = low >> whole_.bits, last = high >> whole_.bits;
        for (int x = first.x; x <= last.x; ++x)
            for (int y = first.y; y <= last.y; ++y)
                for (int z = first.z; z <= last.z; ++z) {
                    const std::size_t i = (std::size_t(x) * whole_.cells.dims.y + y) * whole_.cells.dims.z + z;
                    if (whole_.bricks.empty() || whole_.bricks[i] == 0)
                        raise(i, bound);
                    else
                        raise_brick(i, low - (glm::ivec3(x, y, z) << whole_.bits),
                                    high - (glm::ivec3(x, y, z) << whole_.bits), bound);
                }
    }

    // `low`, `high`: counted from the brick's first.
    void raise_brick(std::size_t coarse, glm::ivec3 low, glm::ivec3 high, float bound) {
        const int cells = 1 << whole_.bits;
        const std::size_t first =
            whole_.cells.bounds.size() + (std::size_t{whole_.bricks[coarse] - 1} << (3 * whole_.bits));
        low = glm::max(low, 0);
        high = glm::min(high, cells - 1);
        for (int x = low.x; x <= high.x; ++x)
            for (int y = low.y; y <= high.y; ++y)
                for (int z = low.z; z <= high.z; ++z)
                    raise(first + std::size_t((x * cells + y) * cells + z), bound);
    }

    void raise(std::size_t entry, float bound) {
        if (!(bound > 0.0f)) // a product that underflows
            return;
        if (bounds_[entry] == 0.0f)
            touched_.push_back(static_cast<std::uint32_t>(entry));
        bounds_[entry] = std::max(bounds_[entry], bound);
    }

    const Superposition& whole_;
    PieceStore& pieces_;
    std::vector<float> bounds_; // 0 before and after
    std::vector<std::uint32_t> touched_;
    glm::dmat4 to_cells_;
};

// Makes bricks of the coarse cells in which there are media whose own cells are much finer: their number.
std::size_t make_bricks(const std::vector<Member>& members, PieceStore& pieces, Superposition& whole) {
    const double coarse = whole.edge * whole.cells.cell;
    std::uint32_t count = 0;
    std::vector<std::uint32_t> bricks(whole.bricks.size(), 0);
    Touch touch(whole, pieces);
    for (const Member& member : members)
        if (member.cell < 0.5 * coarse && !is_everywhere(member.volume))
            touch(member, coarse, [&](std::uint32_t entry, float) {
                if (bricks[entry] == 0)
                    bricks[entry] = ++count;
            });
    whole.bricks = std::move(bricks);
    return count;
}

// Places are numbers of 24 bits, from the middle of all volumes. Along each axis of the world they are to tell a
// quarter of a voxel, or of a hundredth of the volume, apart.
void check_places(const Member& member, const glm::dvec3& origin) {
    if (is_everywhere(member.volume))
        return;
    const AxisBox box = box_around({member});
    for (int axis = 0; axis < 3; ++axis) {
        const double size = box.high[axis] - box.low[axis];
        const double far = std::max(std::abs(box.low[axis] - origin[axis]), std::abs(box.high[axis] - origin[axis]));
        double least = 0.01 * size;
        if (member.loaded.field) { // as long as the longest edge of a voxel along the axis
            const glm::dmat4& map = member.loaded.field->index_to_world;
            least = std::max({std::abs(map[0][axis]), std::abs(map[1][axis]), std::abs(map[2][axis])});
        }
        if (far * 0x1p-24 > 0.25 * least)
            throw InputError(
                fmt::format("{}this volume is up to {:.3g} world units from the middle of all, where single "
                            "precision tells no places apart that are nearer than {:.3g}; move the volumes "
                            "together, or leave some out",
                            member.volume.place.empty() ? "" : member.volume.place + ": ", far, far * 0x1p-24));
    }
}

// Cells as small as the smallest that any medium wants, as far as there may be so many: everywhere, or where small
// media are.
Superposition lay_out(const std::vector<Member>& members, const glm::dvec3& camera, PieceStore& pieces) {
    AxisBox box = box_around(members);
    double wanted = std::numeric_limits<double>::infinity();
    for (const Member& member : members)
        wanted = std::min(wanted, member.cell);
    if (!std::isfinite(wanted)) // all are everywhere, and the same there
        wanted = 1.0;
    const glm::dvec3 origin = box.low.x > box.high.x ? camera : 0.5 * (box.low + box.high);
    take_in(members, camera, wanted, box);
    const bool has_ring =
        std::any_of(members.begin(), members.end(), [](const Member& m) { return is_everywhere(m.volume); });
    const glm::dvec3 size = box.high - box.low;
    const double longest = std::max({size.x, size.y, size.z}), volume = size.x * size.y * size.z;
    if (!(longest < 1e6 * 8.0 * wanted))
        throw InputError(
            fmt::format("the volumes reach {:.3g} world units across, more than a million times what the smallest of "
                        "them measures; move them together, leave some out, or lower the top of what has <layers>",
                        longest));
    for (const Member& member : members)
        check_places(member, origin);
    const double alike = std::max({wanted, std::cbrt(volume / most_cells), longest / 1024.0});
    Superposition best = empty_cells(box, origin, std::min(alike, longest / 4.0), 0, has_ring);
    if (alike <= wanted)
        return best;
    const double finest_coarse = std::max(std::cbrt(volume / most_coarse_cells), longest / 512.0);
    for (int step = 0; step < 8; ++step) {
        const double coarse = finest_coarse * std::exp2(0.5 * step);
        Superposition two_levels = empty_cells(box, origin, coarse / (1 << most_bits), most_bits, has_ring);
        const double bricks = double(make_bricks(members, pieces, two_levels));
        int bits = 1;
        while (bits < most_bits && coarse / (1 << bits) > wanted && bricks * (8 << (3 * bits)) <= most_cells)
            ++bits;
        const double edge = coarse / (1 << bits);
        if (bricks == 0.0 || bricks * (1 << (3 * bits)) > most_cells || edge >= 0.9 * best.edge)
            continue;
        best = empty_cells(box, origin, edge, bits, has_ring);
        best.bricks = std::move(two_levels.bricks);
        best.brick_bounds.assign(std::size_t(bricks) << (3 * bits), 0.0f);
    }
    return best;
}

struct Overlap {
    std::uint32_t entry, medium;
};

void list_overlaps(const std::vector<Overlap>& found, Superposition& whole) {
    const std::size_t entries = whole.entries();
    std::vector<std::uint32_t> next(entries, 0);
    for (const Overlap& overlap : found)
        ++next[overlap.entry];
    whole.most_overlaps = *std::max_element(next.begin(), next.end());
    whole.overlaps.resize(entries + 1 + found.size());
    auto place = static_cast<std::uint32_t>(entries + 1);
    for (std::size_t i = 0; i < entries; ++i) {
        whole.overlaps[i] = place;
        place += std::exchange(next[i], place);
    }
    whole.overlaps[entries] = place;
    for (const Overlap& overlap : found)
        whole.overlaps[next[overlap.entry]++] = overlap.medium;
}

void fill(const std::vector<Member>& members, PieceStore& pieces, Superposition& whole) {
    Touch touch(whole, pieces);
    std::vector<Overlap> found;
    std::vector<float> bounds(whole.entries(), 0.0f);
    for (const Member& member : members)
        touch(member, whole.edge, [&](std::uint32_t entry, float bound) {
            // Upwards, by more than the device's sum of the same terms in the same order may be rounded.
            bounds[entry] = std::nextafter(bounds[entry] + bound, std::numeric_limits<float>::infinity());
            if (found.size() == most_overlaps)
                throw InputError("the lists of which volumes are where take more than 2 GiB; leave volumes out, or let "
                                 "fewer lie in one another");
            found.push_back({entry, member.number});
        });
    list_overlaps(found, whole);
    const auto coarse_end = bounds.begin() + std::ptrdiff_t(whole.cells.bounds.size());
    std::copy(bounds.begin(), coarse_end, whole.cells.bounds.begin());
    std::copy(coarse_end, bounds.end(), whole.brick_bounds.begin());
    const std::size_t brick = std::size_t{1} << (3 * whole.bits);
    for (std::size_t i = 0; i < whole.bricks.size(); ++i)
        if (const std::uint32_t number = whole.bricks[i]; number > 0) {
            const auto first = whole.brick_bounds.begin() + std::ptrdiff_t((number - 1) * brick);
            whole.cells.bounds[i] = *std::max_element(first, first + std::ptrdiff_t(brick));
        }
}

// How far around the cells of a brick everything is empty, as walks have it. No further than half a brick.
void append_brick(const Superposition& whole, glm::ivec3 coarse, std::vector<float>& walked) {
    const int cells = 1 << whole.bits, margin = cells / 2;
    MajorantGrid window{1, glm::ivec3(0), glm::ivec3(2 * cells), {}};
    window.bounds.reserve(std::size_t{8} << (3 * whole.bits));
    const glm::ivec3 first = (coarse << whole.bits) - margin;
    for (int x = 0; x < 2 * cells; ++x)
        for (int y = 0; y < 2 * cells; ++y)
            for (int z = 0; z < 2 * cells; ++z) {
                const glm::ivec3 cell = first + glm::ivec3(x, y, z);
                const bool inside = cell == glm::clamp(cell, glm::ivec3(0), whole.dims() - 1);
                window.bounds.push_back(inside ? whole.bound(whole.entry_of(cell)) : 0.0f);
            }
    const std::vector<std::uint8_t> reaches = empty_reaches(window);
    for (int x = margin; x < margin + cells; ++x)
        for (int y = margin; y < margin + cells; ++y)
            for (int z = margin; z < margin + cells; ++z) {
                const auto i = std::size_t((x * 2 * cells + y) * 2 * cells + z);
                walked.push_back(window.bounds[i] > 0.0f ? window.bounds[i]
                                                         : -float(std::min<int>(reaches[i], margin)));
            }
}

} // namespace

std::size_t Superposition::entry_of(glm::ivec3 cell) const {
    const glm::ivec3 coarse = cell >> bits, within = cell & ((1 << bits) - 1);
    const std::size_t i = (std::size_t(coarse.x) * cells.dims.y + coarse.y) * cells.dims.z + coarse.z;
    if (bricks.empty() || bricks[i] == 0)
        return i;
    return cells.bounds.size() + (std::size_t{bricks[i] - 1} << (3 * bits)) +
           std::size_t((((within.x << bits) + within.y) << bits) + within.z);
}

double Superposition::mean_bound() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < cells.bounds.size(); ++i)
        if (bricks.empty() || bricks[i] == 0)
            sum += cells.bounds[i];
    for (const float bound : brick_bounds)
        sum += std::ldexp(bound, -3 * bits);
    return sum / std::max<double>(1.0, double(cells.bounds.size()));
}

Superposition superpose(const Scene& scene, Media media, const Method& method) {
    const std::vector<Member> members = members_of(scene, media);
    if (members.empty())
        return {};
    PieceStore pieces(scene.settings.majorant_scale);
    Superposition whole = lay_out(members, scene.camera.position, pieces);
    whole.unbounded =
        std::any_of(members.begin(), members.end(), [](const Member& m) { return is_everywhere(m.volume); });
    fill(members, pieces, whole);
    // Worth the look at how far they reach where there are some.
    const auto empty = std::count(whole.cells.bounds.begin(), whole.cells.bounds.end(), 0.0f) +
                       std::count(whole.brick_bounds.begin(), whole.brick_bounds.end(), 0.0f);
    whole.cells.leaps = leaps(method) && 8 * std::size_t(empty) > whole.entries();
    return whole;
}

std::vector<float> walked_bounds(const Superposition& whole) {
    std::vector<float> walked = walked_cells(whole.cells);
    if (!whole.cells.leaps)
        walked.insert(walked.end(), whole.brick_bounds.begin(), whole.brick_bounds.end());
    else if (!whole.brick_bounds.empty()) {
        std::vector<glm::ivec3> places(whole.brick_bounds.size() >> (3 * whole.bits)); // in the order of their numbers
        std::size_t i = 0;
        for (int x = 0; x < whole.cells.dims.x; ++x)
            for (int y = 0; y < whole.cells.dims.y; ++y)
                for (int z = 0; z < whole.cells.dims.z; ++z, ++i)
                    if (whole.bricks[i] > 0)
                        places[whole.bricks[i] - 1] = {x, y, z};
        for (const glm::ivec3 place : places)
            append_brick(whole, place, walked);
    }
    return walked;
}

} // namespace vkvol
