// The fields that make_field knows. Each is a pure function of (size, seed).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "field.h"
#include "field_file.h"

namespace vkvol {

struct Recipe {
    std::string_view name;
    std::string_view what; // one line
    int default_size;      // samples along an edge, see `what`; 0: the field has one size only
    Field (*make)(int size, std::uint32_t seed);
    SampleType type = SampleType::float32; // of its file, unless another is asked for
};

const std::vector<Recipe>& recipes();

// The recipe of that name; InputError with the list of names if there is none.
const Recipe& find_recipe(std::string_view name);

// Fields whose every value follows from a formula, for tests.
Field make_constant(int size, std::uint32_t seed);
Field make_sphere(int size, std::uint32_t seed);
Field make_ramp(int size, std::uint32_t seed);
Field make_checker(int size, std::uint32_t seed);
Field make_voxel(int size, std::uint32_t seed);
Field make_spike(int size, std::uint32_t seed);
Field make_tiles(int size, std::uint32_t seed);
Field make_empty(int size, std::uint32_t seed);
Field make_sheared(int size, std::uint32_t seed);
Field make_far(int size, std::uint32_t seed);
Field make_unclean(int size, std::uint32_t seed);
Field make_glow(int size, std::uint32_t seed);

// Fields to look at.
Field make_cumulus(int size, std::uint32_t seed);
Field make_explosion(int size, std::uint32_t seed);
Field make_broken_cloud(int size, std::uint32_t seed);
Field make_head(int size, std::uint32_t seed);

// Stand-ins for the two grids of the thesis' scenes, which are not ours to pass on.
Field make_bunny_cloud(int size, std::uint32_t seed);
Field make_fire(int size, std::uint32_t seed);

} // namespace vkvol
