#include "film.h"

#include <cmath>

namespace vkvol {

const char* FilmLayer::channels() const {
    return name == "depth"                          ? "Z"
           : name == "alpha" || name == "coverage"  ? "A"
           : name == "position" || name == "normal" ? "XYZ"
                                                    : "RGB";
}

const FilmLayer* Film::layer(const std::string& name) const {
    for (const FilmLayer& each : layers)
        if (each.name == name)
            return &each;
    return nullptr;
}

std::string layer_list(const Film& film) {
    std::string names;
    for (const FilmLayer& layer : film.layers)
        names += (names.empty() ? "" : " ") + layer.name;
    return names;
}

std::optional<double> relative_noise(const Film& film) {
    double error = 0.0, signal = 0.0;
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        if (film.samples[i] < 2)
            continue;
        const glm::dvec3 mean(film.mean[i]);
        error += glm::dot(glm::dvec3(film.variance[i]), glm::dvec3(1.0));
        signal += glm::dot(mean, mean);
    }
    return signal > 0.0 ? std::optional(std::sqrt(error / signal)) : std::nullopt;
}

std::optional<glm::dvec3> variance_of_sum(const Film& film) {
    if (film.is_correlated)
        return film.sum_variance;
    glm::dvec3 variance(0.0);
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        if (film.samples[i] == 1)
            return std::nullopt;
        if (film.samples[i] > 1)
            variance += glm::dvec3(film.variance[i]);
    }
    return variance;
}

ImageMean image_mean(const Film& film) {
    glm::dvec3 sum(0.0);
    double counted = 0.0;
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        if (film.samples[i] == 0)
            continue;
        sum += glm::dvec3(film.mean[i]);
        counted += 1.0;
    }
    if (counted == 0.0)
        return {};
    ImageMean mean{sum / counted, variance_of_sum(film)};
    if (mean.standard_error)
        mean.standard_error = glm::sqrt(*mean.standard_error) / counted;
    return mean;
}

} // namespace vkvol
