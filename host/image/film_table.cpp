#include "film_table.h"

#include <cmath>
#include <fmt/format.h>
#include <iterator>

namespace vkvol {

std::string film_table(const Film& film) {
    const bool has_places = film.places.size() == film.pixel_count();
    std::string text = has_places ? "column,row,x,y,z," : "column,row,";
    text += "R,G,B,standardError.R,standardError.G,standardError.B,samples\n";
    const auto out = std::back_inserter(text);
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        const auto width = static_cast<std::size_t>(film.width());
        fmt::format_to(out, "{},{},", film.crop.x0 + int(i % width), film.crop.y0 + int(i / width));
        if (has_places)
            fmt::format_to(out, "{},{},{},", film.places[i].x, film.places[i].y, film.places[i].z);
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
