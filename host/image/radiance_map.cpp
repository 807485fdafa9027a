#include "radiance_map.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <memory>
#include <optional>

#include "error.h"
#include "file_ending.h"
#include "image_input.h"
#include "input_file.h"
#include "metadata.h"
#include "number_text.h"
#include "one_line.h"

namespace vkvol {

namespace {

// IEC 61966-2-1.
float from_srgb(float x) {
    return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
}

// Red, green and blue of a layer, as far as they are found: places in a pixel.
struct LayerColors {
    std::string layer;
    std::array<std::size_t, 3> at{};
    std::array<bool, 3> has{};
};

// By the names that programs give: R, r, red, Combined.R, diffuse.red, ...; the picture's own come before those of
// layers.
std::vector<LayerColors> layers_of(const std::vector<std::string>& channels) {
    std::vector<LayerColors> layers;
    for (std::size_t i = 0; i < channels.size(); ++i) {
        const std::size_t dot = channels[i].rfind('.');
        const std::string layer = dot == std::string::npos ? "" : channels[i].substr(0, dot);
        std::string name = channels[i].substr(dot == std::string::npos ? 0 : dot + 1);
        std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
        const int color = name == "r" || name == "red"     ? 0
                          : name == "g" || name == "green" ? 1
                          : name == "b" || name == "blue"  ? 2
                                                           : -1;
        if (color < 0)
            continue;
        auto found = std::find_if(layers.begin(), layers.end(), [&](const LayerColors& l) { return l.layer == layer; });
        if (found == layers.end())
            found = layers.insert(layers.end(), LayerColors{layer});
        found->at[color] = i;
        found->has[color] = true;
    }
    std::erase_if(layers, [](const LayerColors& l) { return !(l.has[0] && l.has[1] && l.has[2]); });
    return layers;
}

// What is grey beside alpha and depth, if that is all there is.
std::optional<std::size_t> grey_channel(const std::vector<std::string>& channels) {
    std::optional<std::size_t> grey;
    for (std::size_t i = 0; i < channels.size(); ++i) {
        if (channels.size() > 1 && (channels[i] == "A" || channels[i] == "Z"))
            continue;
        if (grey)
            return std::nullopt;
        grey = i;
    }
    return grey;
}

// Places of red, green and blue in a pixel.
std::array<std::size_t, 3> color_channels(const PictureHeader& header, const std::filesystem::path& file) {
    const std::vector<LayerColors> layers = layers_of(header.channels);
    const auto own = std::find_if(layers.begin(), layers.end(), [](const LayerColors& l) { return l.layer.empty(); });
    if (own != layers.end())
        return own->at;
    if (layers.size() == 1)
        return layers.front().at;
    std::vector<std::string> names = header.channels;
    if (!layers.empty()) {
        names.clear();
        for (const LayerColors& l : layers)
            names.push_back(l.layer);
    }
    const std::string list = one_line(fmt::format("{}", fmt::join(names, ", ")).substr(0, 200));
    if (!layers.empty())
        throw InputError(fmt::format("{}: has colours in several layers ({}); save the one that is meant by itself",
                                     file.string(), list));
    const std::optional<std::size_t> grey = grey_channel(header.channels);
    if (!grey)
        throw InputError(fmt::format("{}: has no channels R, G and B, nor one that is grey, but {}; save it as RGB",
                                     file.string(), list));
    return {*grey, *grey, *grey};
}

// EXIF's numbers: 1 is as pictures are looked at.
void check_orientation(const PictureHeader& header, const std::filesystem::path& file) {
    const std::string orientation = text_of(header.attributes, "Orientation");
    if (orientation.size() == 1 && orientation > "1" && orientation < "9") // others mean nothing
        throw InputError(fmt::format("{}: is stored turned or mirrored (orientation {}); save it upright",
                                     file.string(), orientation));
}

double number_of(const Metadata& metadata, const std::string& key, double fallback) {
    const NumberText found = read_number_text(text_of(metadata, key));
    return found.is_number && found.value > 0.0 && std::isfinite(found.value) ? found.value : fallback;
}

// As its library says, of whichever version.
bool is_linear(const PictureHeader& header) {
    const std::string space = text_of(header.attributes, "oiio:ColorSpace");
    return space == "linear" || space == "Linear" || space.starts_with("lin_");
}

// What the file says of its numbers beyond them, where they are taken otherwise.
std::vector<std::string> warnings_of(const PictureHeader& header, const std::filesystem::path& file) {
    std::vector<std::string> warnings;
    const auto warn = [&](const std::string& what) { warnings.push_back(fmt::format("{}: {}", file.string(), what)); };
    if (!is_rec709(header))
        warn("its primaries are not those of Rec.709 (sRGB), but its numbers are taken as such; convert it to linear "
             "Rec.709");
    if (header.is_whole_numbers && text_of(header.attributes, "ICCProfile") == "another")
        warn("its ICC profile is not sRGB's, but its numbers are taken as such; convert it to sRGB");
    const double gamma = is_linear(header) ? 1.0 : number_of(header.attributes, "oiio:Gamma", 2.2);
    if (header.is_whole_numbers && (gamma < 1.8 || gamma > 2.6))
        warn(fmt::format("its numbers are of gamma {:g}, but taken as sRGB; save it as sRGB, or as .exr", gamma));
    if (const double exposure = number_of(header.attributes, "hdr:exposure", 1.0); exposure != 1.0)
        warn(fmt::format(
            "the last EXPOSURE of its header is {:g}: its numbers are so many times the radiance, and taken as "
            "they are; a factor of {:g} undoes that",
            exposure, 1.0 / exposure));
    return warnings;
}

} // namespace

RadianceMap read_radiance_map(const std::filesystem::path& file) {
    check_input_file(file, "");
    const std::string ending = file_ending(file);
    const std::vector<std::string> known = {".exr",  ".hdr", ".png", ".jpg", ".jpeg", ".tif",
                                            ".tiff", ".tga", ".bmp", ".gif", ".psd",  ".pfm"};
    if (std::find(known.begin(), known.end(), ending) == known.end())
        throw InputError(fmt::format("{}: unknown kind of map '{}'; expected .exr, .hdr, .png, .jpg or .tga, say",
                                     file.string(), ending));
    const std::unique_ptr<PictureReader> reader = open_image(file);
    const PictureHeader& header = reader->header();
    check_orientation(header, file);
    const std::size_t channels = header.channels.size();
    const std::array<std::size_t, 3> colors = ending == ".exr" ? color_channels(header, file)
                                              : channels < 3   ? std::array<std::size_t, 3>{0, 0, 0}
                                                               : std::array<std::size_t, 3>{0, 1, 2};
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
        glm::vec3 texel(values[i + colors[0]], values[i + colors[1]], values[i + colors[2]]);
        bool fine = true;
        for (int c = 0; c < 3; ++c) {
            const bool good = std::isfinite(texel[c]) && texel[c] >= 0.0f;
            fine = fine && good;
            texel[c] = !good ? 0.0f : header.is_whole_numbers ? from_srgb(texel[c]) : texel[c];
        }
        map.mended += fine ? 0 : 1;
        map.texels[std::size_t(y) * map.width + x] = texel;
    }
    if (map.mended > 0)
        map.warnings.push_back(
            fmt::format("{}: {} texels were negative or not finite, and count as 0", file.string(), map.mended));
    for (const std::string& warning : warnings_of(header, file))
        map.warnings.push_back(warning);
    return map;
}

} // namespace vkvol
