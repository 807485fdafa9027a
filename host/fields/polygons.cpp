#include "polygons.h"

#include <algorithm>
#include <fmt/format.h>
#include <fstream>
#include <iterator>

#include "error.h"
#include "file_ending.h"
#include "gzip.h"
#include "input_file.h"
#include "obj_file.h"
#include "ply_file.h"

namespace vkvol {

std::string read_mesh_text(const std::filesystem::path& path) {
    check_input_file(path, "check the path in the scene (it starts from the scene file's directory)");
    std::ifstream stream(path, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(stream), {}};
    if (stream.bad())
        throw InputError(fmt::format("{}: cannot be read; check the disk, or copy the file again", path.string()));
    // Meshes are packed to a fifth or so: no more is unpacked than memory may be asked for by a file of such a size.
    constexpr std::size_t most_times = 100, least = std::size_t{1} << 26u, most = std::size_t{1} << 34u;
    const std::size_t limit = std::clamp(most_times * text.size(), least, most);
    return unpacked(std::move(text), path, limit);
}

Polygons read_polygons(const std::filesystem::path& path) {
    return file_ending(path) == ".ply" || is_packed(path, ".ply") ? read_ply(path) : read_obj(path);
}

} // namespace vkvol
