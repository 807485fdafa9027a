#include "recipes.h"

#include "error.h"

namespace vkvol {

const std::vector<Recipe>& recipes() {
    static const std::vector<Recipe> all{
        {"constant", "a cube of density 1, SIZE samples wide", 16, make_constant},
        {"sphere", "a ball of density 1 with a soft edge, in a cube of SIZE samples", 32, make_sphere},
        {"ramp", "density (i + 1) / SIZE in a cube of SIZE samples: linear in x", 16, make_ramp},
        {"checker", "cubes of 4 samples, alternately 0 and 1, and one tile, SIZE samples wide", 32, make_checker},
        {"voxel", "a single sample of density 1 at a negative, odd index", 0, make_voxel},
        {"spike", "a ball of density 0.05 that hides one sample of 20, in a cube of SIZE samples", 32, make_spike},
        {"tiles", "active tiles of 128^3 and 8^3 samples beside one leaf of samples", 0, make_tiles},
        {"empty", "a grid without active samples", 0, make_empty},
        {"sheared", "a cube of density 1 whose axes are turned, sheared, stretched and mirrored, SIZE samples wide", 16,
         make_sheared},
        {"far", "the cube of density 1, a million units from the origin", 16, make_far},
        {"unclean", "the cube of density 1 with layers that are no density: NaN, infinite and negative", 16,
         make_unclean},
        {"glow", "a cube of density 1 within a larger cube of temperature 1", 16, make_glow},
        {"ramp-fp4", "the ramp in 4 bits a sample", 16, make_ramp, SampleType::fp4},
        {"ramp-fp8", "the ramp in 8 bits a sample", 16, make_ramp, SampleType::fp8},
        {"ramp-440", "the ramp, larger than a storage buffer of Mesa's software driver", 440, make_ramp},
        {"cumulus", "a cumulus cloud, about 60 units wide, in a box SIZE samples wide", 464, make_cumulus},
        {"explosion", "a rising fireball: density and temperature, SIZE samples wide", 160, make_explosion},
        {"broken_cloud", "a layer of broken cloud over haze, SIZE samples wide", 320, make_broken_cloud},
        {"head", "a head as a scanner sees it: skin, skull and brain, SIZE samples tall", 176, make_head},
        {"bunny_cloud", "a cumulus where the thesis' scenes look for a bunny, SIZE samples wide", 256,
         make_bunny_cloud},
        {"fire", "a fireball where the thesis' scenes look for one: density and temperature, SIZE samples wide", 160,
         make_fire},
    };
    return all;
}

const Recipe& find_recipe(std::string_view name) {
    std::string names;
    for (const Recipe& recipe : recipes()) {
        if (recipe.name == name)
            return recipe;
        names += (names.empty() ? "" : ", ") + std::string(recipe.name);
    }
    throw InputError("there is no field '" + std::string(name) + "'; the fields are " + names);
}

} // namespace vkvol
