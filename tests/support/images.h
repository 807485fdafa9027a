// Rendering on the shared device and by the reference, and judging whether two films show the same picture.
//
// Significance: all image comparisons together may fail by chance with probability 1 %. Each one is given its share of
// that by Sidak's formula over `most_comparisons`, and each of its pixels and channels their share of it. Seeds are
// fixed, so on one device a comparison passes always or never.
#pragma once

#include <catch2/catch.hpp>
#include <string>

#include "session.h"

namespace vkvol {

// The scene's samples per pixel with `seed`. The crop of `job` may be left empty: the whole picture. Checks that no
// step was capped, no majorant violated, no sample lost; and, on software drivers, of every fourteenth render, that
// both schedules give the same bits, where `job` chooses none and lets the render come to its end.
RenderResult render_here(const Scene& scene, std::uint32_t seed, RenderJob job = {});

Film render_reference(const Scene& scene, std::uint32_t seed);

struct Agreement {
    bool ok = false;
    std::string report; // the numbers
};

#define CHECK_AGREEMENT(expression)                                                                                    \
    do {                                                                                                               \
        const Agreement agreement = (expression);                                                                      \
        INFO(agreement.report);                                                                                        \
        CHECK(agreement.ok);                                                                                           \
    } while (false)

// Two estimates of one picture, made with different seeds. Per pixel and channel, z = difference / standard error of
// the difference; the mean over the picture likewise. Equal numbers of samples make the difference symmetric however
// skewed the radiance is, so that the normal limit is soon reached. If they disagree, both films and z are left as EXR
// files named after `name`.
Agreement agree(const Film& film, const Film& other, const std::string& name);

// That a render here and one by the reference agree.
void check_against_reference(const Scene& scene, const std::string& name);

// An estimate against exact values per pixel; the samples of a pixel must be many enough for the normal limit.
Agreement agree_with_means(const Film& film, const std::vector<Rgb>& means, const std::string& name);

// That a render here has the mean `expected` in every pixel and channel.
void check_means(const Scene& scene, double expected, const std::string& name);

// Samples that are `if_escaped` with probability p[pixel], else `otherwise`. The number of escapes is binomial, and
// P(|k/n - p| as large) <= 2 exp(-n KL(k/n || p)) for any n (Chernoff); the mean over the picture is judged as normal.
Agreement agree_with_escapes(const Film& film, const std::vector<double>& p, const Rgb& if_escaped,
                             const Rgb& otherwise, const std::string& name);

// The layer of this name (no string: compilers would take the layer for a part of it), which has to be there; and a
// film of its means and variances.
const FilmLayer& layer_of(const Film& film, const char* name);
Film as_film(Film film, const std::string& name);

// That all three channels' means over the picture are the same, but for chance. Of estimates that find in some pixels
// once in thousands of samples what makes them bright.
void check_same_mean(const Film& a, const Film& b, const std::string& name);

// Every mean, variance and count has the same bits, those of layers too.
bool same_bits(const Film& a, const Film& b);

// Mean over pixels and channels.
double mean_of(const Film& film);

} // namespace vkvol
