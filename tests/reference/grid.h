// A density field on voxels. Voxel (i, j, k) has its centre at the integer index coordinates (i, j, k).
// The field is the voxel's value inside the box of active voxels and 0 outside it, interpolated in between, so that it
// reaches one voxel beyond the box on every side.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "shapes.h"

namespace reference {

struct Grid {
    // Voxels [lower, lower + size - 1]: the box of active voxels and a border of zeros, one voxel wide.
    glm::ivec3 lower{0};
    glm::ivec3 size{0}; // 0: no voxels at all
    std::vector<float> values;

    // world = linear * index + translation
    glm::dmat3 linear{1.0};
    glm::dvec3 translation{0.0};

    // Cells of cell^3 index units from `lower` on, x fastest: upper and lower bounds of the interpolated field.
    int cell = 0;
    glm::ivec3 cells{0};
    std::vector<float> majorants, minorants;

    bool empty() const { return values.empty(); }
    void move(const glm::dmat4& transform); // in world space
    double voxel_length() const;            // |det linear|^(1/3), world units
    Ray to_index(const Ray& ray) const;
    glm::dvec3 to_index(const glm::dvec3& world) const;
    Interval support(const Ray& index_ray) const; // where the field can be other than 0

    double voxel(const glm::ivec3& index) const;
    double nearest(const glm::dvec3& index) const;
    double trilinear(const glm::dvec3& index) const;
    double looked_up(const glm::dvec3& index, bool nearest_voxel) const;
};

// Voxels [first, last]; values that are negative or not finite become 0.
Grid make_grid(const glm::ivec3& first, const glm::ivec3& last, const std::function<double(glm::ivec3)>& value,
               const glm::dmat3& linear = glm::dmat3(1.0), const glm::dvec3& translation = glm::dvec3(0.0));

bool has_grid(const std::filesystem::path& path, const std::string& name);

// Channels by themselves, as a scalar grid each.
struct ColorGrid {
    Grid channels[3];

    bool empty() const { return channels[0].empty(); }
    void move(const glm::dmat4& transform);
    vkvol::Rgb looked_up(const glm::dvec3& world, bool nearest_voxel) const; // in world space
    vkvol::Rgb clamped(const glm::dvec3& world,
                       bool nearest_voxel) const; // likewise, going on outside of the box of active voxels
};

bool has_colors(const std::filesystem::path& path, const std::string& name);

// Loads a grid of colours, or of numbers, which become grey.
ColorGrid load_color_grid(const std::filesystem::path& path, const std::string& name);

// The grid `name` of a .nvdb file: float, Fp4, Fp8, Fp16 or FpN. Throws std::runtime_error.
Grid load_grid(const std::filesystem::path& path, const std::string& name);

constexpr int one_cell = 0; // a single, global majorant

// make_grid and load_grid have done this with cells of 8 voxels.
void build_majorants(Grid& grid, int cell);

// The cells that a ray passes, in order.
struct MajorantSegment {
    double t0, t1;
    double majorant; // >= the field anywhere on the segment
    double minorant; // <= it
};

class MajorantWalk {
public:
    MajorantWalk(const Grid& grid, const Ray& index_ray, const Interval& interval);
    bool next(MajorantSegment& segment);

private:
    const Grid& grid_;
    Ray ray_;
    double t_, end_;
    glm::ivec3 cell_;
};

} // namespace reference
