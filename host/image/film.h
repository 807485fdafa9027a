// The developed image on the host: what a render returns and what image files hold.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "crop.h"

namespace vkvol {

// One more image of the same samples, by its name in an EXR: "direct", "group.key", "depth". Of layers of a single
// channel all three are the same.
struct FilmLayer {
    std::string name;
    std::vector<glm::vec3> mean;     // of depth and position over the samples that collide; else over all
    std::vector<glm::vec3> variance; // of the mean; empty where none is known

    const char* channels() const;                                                   // a letter each, "RGB"
    bool is_of_collisions() const { return name == "depth" || name == "position"; } // weighted by "coverage"
};

// Pixels of the crop window, rows top to bottom. A pixel without samples has mean and variance 0.
struct Film {
    int picture_width = 0; // the whole picture (EXR display window)
    int picture_height = 0;
    Crop crop;                          // the part held here (EXR data window)
    std::vector<glm::vec3> mean;        // radiance, linear Rec.709
    std::vector<glm::vec3> variance;    // of the mean: s^2 / n with the unbiased s^2; 0 if n < 2
    std::vector<std::uint32_t> samples; // per pixel
    std::vector<FilmLayer> layers;      // those asked for
    std::vector<glm::dvec3> places;     // where a sensor of flux reads each, its patch's middle, world; else none
    std::uint32_t passes = 0;           // the variance is known from so many means of several samples; 0: from samples
    bool has_other_primaries = false;   // than Rec.709's, of a file from elsewhere
    bool is_premultiplied = false; // what is behind the media is left out, and the layer `alpha` says how much of it
    // Errors of pixels go together: what moves has the same moments in all of them, particles are parts of several.
    bool is_correlated = false;
    // Then, of the sum of all pixels' means, if it is known. Else their variances add.
    std::optional<glm::dvec3> sum_variance = {};

    int width() const { return crop.x1 - crop.x0; }
    int height() const { return crop.y1 - crop.y0; }
    std::size_t pixel_count() const { return mean.size(); }
    const FilmLayer* layer(const std::string& name) const; // null if there is none
};

// The picture's noise: its root mean square error over its root mean square signal, sqrt(sum of the variances / sum of
// the squared means), over all channels of the pixels that have two samples. One sum over another and not a mean of
// quotients, which is whatever the darkest pixels make it: a pixel that is nearly black, and of which nobody sees the
// error, would count for more than all others. A factor on the picture cancels, black pixels change nothing, and it
// falls as 1 / sqrt(samples). Since squared means hold their own variance it never exceeds 1, unless samples are below
// 0. Unknown if no pixel has two samples, or none has light.
std::optional<double> relative_noise(const Film& film);

// Metadata by which an image's layers are found: their names, between spaces.
inline constexpr const char* layers_key = "vkvol/layers";
std::string layer_list(const Film& film);

// Mean of the picture over the pixels that have samples. Of independent pixels variances add; of one with a single
// sample none is known, nor then of the picture, and of pixels whose errors go together only their sum's.
struct ImageMean {
    glm::dvec3 value{0.0};
    std::optional<glm::dvec3> standard_error;
};
ImageMean image_mean(const Film& film);

// Variance of the sum of all pixels' means; none where it is not known, as above.
std::optional<glm::dvec3> variance_of_sum(const Film& film);

// Key "vkvol/seed" etc. -> value; written into EXR headers, read back by merge and compare.
using Metadata = std::map<std::string, std::variant<int, float, std::string>>;

} // namespace vkvol
