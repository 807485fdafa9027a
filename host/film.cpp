#include "film.h"

#include <algorithm>
#include <cmath>

namespace vkvol {

std::optional<double> relative_noise(const Film& film) {
    if (std::all_of(film.samples.begin(), film.samples.end(), [](std::uint32_t n) { return n < 2; }))
        return std::nullopt;
    double sum = 0.0;
    std::size_t counted = 0;
    const glm::dvec3 luminance(0.2126, 0.7152, 0.0722);
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        const double mean = glm::dot(luminance, glm::dvec3(film.mean[i]));
        // Channels of one pixel vary together: the standard deviations add, not the variances.
        const double deviation = glm::dot(luminance, glm::sqrt(glm::dvec3(film.variance[i])));
        if (film.samples[i] < 2 || mean <= 1e-6)
            continue;
        sum += deviation * deviation / (mean * mean);
        ++counted;
    }
    return counted > 0 ? std::sqrt(sum / static_cast<double>(counted)) : 0.0;
}

ImageMean image_mean(const Film& film) {
    glm::dvec3 sum(0.0), variance(0.0);
    double counted = 0.0;
    bool known = true;
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        if (film.samples[i] == 0)
            continue;
        known = known && film.samples[i] > 1;
        sum += glm::dvec3(film.mean[i]);
        variance += glm::dvec3(film.variance[i]);
        counted += 1.0;
    }
    if (counted == 0.0)
        return {};
    return {sum / counted, known ? std::optional(glm::sqrt(variance) / counted) : std::nullopt};
}

} // namespace vkvol
