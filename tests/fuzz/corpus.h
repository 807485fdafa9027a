// Small valid files to begin with.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "nvdb_file.h"

namespace vkvol::fuzz {

// Grids of every type that is read, with noise, tiles, one voxel, a background, nothing.
std::vector<GridBytes> make_grids(const std::string& name);

// Likewise of colours.
std::vector<GridBytes> make_color_grids(const std::string& name);

struct StoredGrid {
    GridBytes bytes;
    std::string name; // in the container
};

// A .nvdb file. `codec`: nanovdb::io::Codec. What the container says of the grids is taken from their bytes.
std::string make_nvdb(const std::vector<StoredGrid>& grids, std::uint16_t codec);

// Where the container's headers end and the first grid's data begins.
std::size_t nvdb_header_size(const std::vector<StoredGrid>& grids);

// cloud.nvdb, fire.nvdb (density, temperature and colour), cloud.vdb, ball.obj, phase.txt: what the scenes of
// scene_target name.
void write_scene_files(const std::filesystem::path& directory);

// .vdb files with every compression, of floats and halves, and of what is not read.
std::vector<std::string> make_vdbs(const std::filesystem::path& scratch);

// .obj texts of closed surfaces, with the material library ball.mtl.
std::vector<std::string> make_objs();
// Such .ply files, of every format.
std::vector<std::string> make_plys();
extern const char* const ball_mtl;

} // namespace vkvol::fuzz
