// Pictures that are read as light.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace vkvol {

struct RadianceMap {
    int width = 0;
    int height = 0;
    std::vector<glm::vec3> texels;          // linear Rec.709, >= 0, rows top to bottom
    std::size_t mended = 0;                 // texels that had a channel which was negative or not finite, now 0
    std::vector<std::string> warnings = {}; // with the file's name
};

// Reads .exr and .hdr as they are, and .png, .jpg and .tif of whole numbers as sRGB. One channel, beside alpha and
// depth, is grey; alpha is left out; of an .exr with layers that one which has R, G and B. Throws InputError for what
// is no such picture, is too large, is stored turned or mirrored, or has colours in several layers or none.
RadianceMap read_radiance_map(const std::filesystem::path& file);

} // namespace vkvol
