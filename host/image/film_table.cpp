#include "film_table.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>

namespace vkvol {

namespace {

// Places are computed from a sensor's middle and directions: what rounding left of a 0 is one.
glm::dvec3 without_dust(const glm::dvec3& place, double size) {
    glm::dvec3 clean = place;
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(place[axis]) < 1e-14 * size)
            clean[axis] = 0.0;
    return clean;
}

} // namespace

std::string film_table(const Film& film) {
    const bool has_places = film.places.size() == film.pixel_count();
    std::string text = has_places ? "column,row,x,y,z," : "column,row,";
    text += "R,G,B,standardError.R,standardError.G,standardError.B,samples\n";
    double size = 0.0;
    for (const glm::dvec3& place : film.places)
        size = std::max(size, glm::length(place));
    const auto out = std::back_inserter(text);
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        const auto width = static_cast<std::size_t>(film.width());
        fmt::format_to(out, "{},{},", film.crop.x0 + int(i % width), film.crop.y0 + int(i / width));
        if (has_places) {
            const glm::dvec3 place = without_dust(film.places[i], size);
            fmt::format_to(out, "{:.15g},{:.15g},{:.15g},", place.x, place.y, place.z);
        }
        const glm::vec3 mean = film.mean[i], error = glm::sqrt(film.variance[i]);
        fmt::format_to(out, "{},{},{},", mean.x, mean.y, mean.z);
        if (film.samples[i] > 1)
            fmt::format_to(out, "{},{},{},", error.x, error.y, error.z);
        else
            text += ",,,";
        fmt::format_to(out, "{}\n", film.samples[i]);
    }
    return text;
}

} // namespace vkvol
