#include "film_channels.h"

#include <bit>
#include <cstring>

namespace vkvol {

std::string channel_name(const std::string& prefix, const FilmLayer& layer, char letter, bool is_premultiplied) {
    return prefix + (layer.name == "alpha" && is_premultiplied ? "" : layer.name + ".") + letter;
}

std::vector<std::string> channel_names(const Film& film) {
    std::vector<std::string> names = {"R", "G", "B", "variance.R", "variance.G", "variance.B", "samples"};
    for (const FilmLayer& layer : film.layers)
        for (const char* const prefix : {"", "variance."})
            if (*prefix == 0 || !layer.variance.empty())
                for (const char* letter = layer.channels(); *letter != 0; ++letter)
                    names.push_back(channel_name(prefix, layer, *letter, film.is_premultiplied));
    return names;
}

std::vector<std::uint32_t> interleaved_channels(const Film& film) {
    std::vector<std::uint32_t> pixels;
    pixels.reserve(film.pixel_count() * channel_names(film).size());
    const auto push = [&pixels](const glm::vec3& value, int count) {
        for (int c = 0; c < count; ++c)
            pixels.push_back(std::bit_cast<std::uint32_t>(value[c]));
    };
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        push(film.mean[i], 3);
        push(film.variance[i], 3);
        pixels.push_back(film.samples[i]);
        for (const FilmLayer& layer : film.layers) {
            const auto letters = static_cast<int>(std::strlen(layer.channels()));
            push(layer.mean[i], letters);
            if (!layer.variance.empty())
                push(layer.variance[i], letters);
        }
    }
    return pixels;
}

} // namespace vkvol
