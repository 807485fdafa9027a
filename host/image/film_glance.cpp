#include "film_glance.h"

#include <algorithm>
#include <cmath>

namespace vkvol {

namespace {

double luminance(const glm::dvec3& color) {
    return glm::dot(color, glm::dvec3(0.2126, 0.7152, 0.0722));
}

} // namespace

FilmGlance first_glance(const Film& film, const glm::dvec3& background, const ToneMapping& mapping) {
    FilmGlance look;
    look.pixels = film.pixel_count();
    const double faintest = faintest_radiance(mapping);
    const double tolerance = std::max({background.x, background.y, background.z}) / 255.0;
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        const glm::dvec3 mean(film.mean[i]);
        const double channel = std::max({mean.x, mean.y, mean.z});
        look.unsampled += film.samples[i] == 0;
        look.shown += channel >= faintest;
        look.apart += glm::any(glm::greaterThan(glm::abs(mean - background), glm::dvec3(tolerance)));
        look.brightest = std::max(look.brightest, channel);
    }
    return look;
}

bool is_without_structure(const Film& film) {
    double mean = 0.0, between = 0.0, within = 0.0;
    for (const glm::vec3& pixel : film.mean)
        mean += luminance(pixel) / double(film.pixel_count());
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        const double difference = luminance(film.mean[i]) - mean;
        // Channels of one pixel vary together: the standard deviations add, not the variances.
        const double deviation = luminance(glm::sqrt(glm::dvec3(film.variance[i])));
        between += difference * difference;
        within += deviation * deviation;
    }
    const double rounding = 1e-6 * mean;
    return between <= 1.5 * within + rounding * rounding * double(film.pixel_count());
}

} // namespace vkvol
