#include "shown_layer.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace vkvol {

namespace {

// Values as they are, 0 black and 1 white.
std::vector<std::uint8_t> linear(const std::vector<glm::vec3>& values) {
    std::vector<std::uint8_t> rgba;
    rgba.reserve(values.size() * 4);
    for (const glm::vec3& value : values) {
        for (int c = 0; c < 3; ++c)
            rgba.push_back(static_cast<std::uint8_t>(
                std::isfinite(value[c]) ? std::lround(255.0f * std::clamp(value[c], 0.0f, 1.0f)) : 0));
        rgba.push_back(255);
    }
    return rgba;
}

double brightness(const glm::vec3& v) {
    return (double(v.x) + double(v.y) + double(v.z)) / 3.0;
}

// The standard error of a pixel over its mean; over a fiftieth of the picture's mean where that is more, since of what
// is nearly black nobody sees the noise.
ShownLayer noise_of(const Film& film) {
    double mean = 0.0;
    for (const glm::vec3& value : film.mean)
        mean += brightness(value) / double(std::max<std::size_t>(film.pixel_count(), 1));
    std::vector<glm::vec3> shown;
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        const double error = std::sqrt(std::max(brightness(film.variance[i]), 0.0));
        const double signal = std::max(brightness(film.mean[i]), 0.02 * mean);
        const bool known = film.samples[i] > 1 && signal > 0.0;
        shown.emplace_back(known ? float(error / signal / whitest_noise) : 0.0f);
    }
    ShownLayer layer;
    layer.rgba = linear(shown);
    layer.scale = fmt::format("black: no noise; white: {:.0f} % and more", 100.0 * whitest_noise);
    return layer;
}

// Stretched over the values that there are.
ShownLayer stretched(const std::vector<glm::vec3>& values, bool is_single) {
    glm::vec3 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
    for (const glm::vec3& value : values)
        if (value != glm::vec3(0.0f)) { // nothing is there
            low = glm::min(low, value);
            high = glm::max(high, value);
        }
    std::vector<glm::vec3> shown;
    for (const glm::vec3& value : values) {
        const glm::vec3 part = (value - low) / glm::max(high - low, glm::vec3(1e-20f));
        shown.push_back(value == glm::vec3(0.0f) ? glm::vec3(0.0f) : is_single ? 1.0f - 0.9f * part : part);
    }
    ShownLayer layer;
    layer.rgba = linear(shown);
    if (low.x <= high.x && is_single)
        layer.scale = fmt::format("white: {:.4g}; dark: {:.4g}; black: nothing", low.x, high.x);
    else if (low.x <= high.x)
        layer.scale = fmt::format("from {:.3g}, {:.3g}, {:.3g} to {:.3g}, {:.3g}, {:.3g}", low.x, low.y, low.z, high.x,
                                  high.y, high.z);
    return layer;
}

std::vector<glm::vec3> over_sketch(const Film& film, const Film& sketch) {
    std::vector<glm::vec3> mean = film.mean;
    for (int y = 0; y < film.height(); ++y)
        for (int x = 0; x < film.width(); ++x) {
            const std::size_t i = std::size_t(y) * film.width() + x;
            const int u = int(std::int64_t{x} * sketch.width() / film.width()),
                      v = int(std::int64_t{y} * sketch.height() / film.height());
            if (film.samples[i] == 0)
                mean[i] = sketch.mean[std::size_t(v) * sketch.width() + u];
        }
    return mean;
}

} // namespace

ShownLayer show_layer(const Film& film, const Film* sketch, const std::string& layer, const ToneRequest& tone,
                      const Metadata& metadata) {
    if (layer == "noise")
        return noise_of(film);
    const FilmLayer* const found = film.layer(layer);
    if (layer != "picture" && !found)
        return {};
    if (found && found->is_of_collisions())
        return stretched(found->mean, *found->channels() == 'Z');
    ShownLayer shown;
    if (layer == "normal") {
        std::vector<glm::vec3> halves;
        for (const glm::vec3& normal : found->mean)
            halves.push_back(0.5f + 0.5f * normal);
        shown.rgba = linear(halves);
        shown.scale = "grey: 0; x, y, z as red, green, blue";
        return shown;
    }
    if (layer == "albedo" || layer == "transmittance" || layer == "alpha" || layer == "coverage") {
        shown.rgba = linear(found->mean);
        shown.scale = "black: 0; white: 1";
        return shown;
    }
    Film sketched;
    if (sketch)
        sketched.mean = over_sketch(film, *sketch);
    const Film& whole = sketch ? sketched : film;
    const std::vector<glm::vec3>& radiance = found ? found->mean : whole.mean;
    const Tone chosen = choose_tone(tone, whole, metadata); // of the whole picture, so that its parts compare
    shown.mapping = chosen.mapping;
    shown.clipped = chosen.clipped;
    shown.rgba = tone_map_opaque(radiance, chosen.mapping, whole.mean);
    return shown;
}

} // namespace vkvol
