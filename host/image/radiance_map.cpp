#include "radiance_map.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <memory>

#include "error.h"
#include "file_ending.h"
#include "image_input.h"
#include "input_file.h"

namespace vkvol {

namespace {

// IEC 61966-2-1.
float from_srgb(float x) {
    return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
}

} // namespace

RadianceMap read_radiance_map(const std::filesystem::path& file) {
    check_input_file(file, "");
    const std::string ending = file_ending(file);
    const std::vector<std::string> known = {".exr", ".hdr", ".png", ".jpg", ".jpeg", ".tif", ".tiff"};
    if (std::find(known.begin(), known.end(), ending) == known.end())
        throw InputError(
            fmt::format("{}: unknown kind of map '{}'; expected .exr, .hdr or .png", file.string(), ending));
    const std::unique_ptr<PictureReader> reader = open_image(file);
    const PictureHeader& header = reader->header();
    const std::size_t channels = header.channels.size();
    std::vector<float> values(std::size_t(header.width) * header.height * channels);
    if (!reader->read(values.data()))
        fail_to_read(file, *reader);
    constexpr std::size_t most_beyond = 64; // times the pixels that there are
    if (std::size_t(header.full_width) * header.full_height > most_beyond * header.width * header.height)
        throw InputError(
            fmt::format("{}: has {}x{} pixels of a display window of {}x{}, which is hardly meant; crop it",
                        file.string(), header.width, header.height, header.full_width, header.full_height));
    RadianceMap map{header.full_width, header.full_height, {}, 0};
    map.texels.resize(std::size_t(map.width) * map.height); // black where the file has no pixels
    for (std::size_t i = 0; i < values.size(); i += channels) {
        const int x = header.x - header.full_x + int(i / channels % header.width),
                  y = header.y - header.full_y + int(i / channels / header.width);
        if (x < 0 || y < 0 || x >= map.width || y >= map.height)
            continue;
        glm::vec3 texel = channels < 3 ? glm::vec3(values[i]) : glm::vec3(values[i], values[i + 1], values[i + 2]);
        bool fine = true;
        for (int c = 0; c < 3; ++c) {
            const bool good = std::isfinite(texel[c]) && texel[c] >= 0.0f;
            fine = fine && good;
            texel[c] = !good ? 0.0f : header.is_whole_numbers ? from_srgb(texel[c]) : texel[c];
        }
        map.mended += fine ? 0 : 1;
        map.texels[std::size_t(y) * map.width + x] = texel;
    }
    return map;
}

} // namespace vkvol
