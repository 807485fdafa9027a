#include "compare.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <limits>
#include <nlohmann/json.hpp>

#include "compare_notes.h"
#include "error.h"
#include "image_io.h"
#include "messages.h"
#include "student_t.h"

namespace vkvol {

namespace {

// |z| that all of `count` independent standard normals stay below with probability 1 - significance (Sidak).
double sidak_bound(double significance, std::size_t count) {
    const double each = -std::expm1(std::log1p(-significance) / double(std::max<std::size_t>(1, count)));
    return normal_upper(0.5 * each);
}

bool finite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool same_bits(const glm::vec3& a, const glm::vec3& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

void check_windows(const Film& a, const Film& b) {
    const auto describe = [](const Film& film) {
        return fmt::format("{}x{} with window {},{},{},{}", film.picture_width, film.picture_height, film.crop.x0,
                           film.crop.x1, film.crop.y0, film.crop.y1);
    };
    if (describe(a) != describe(b))
        throw InputError(fmt::format("the images cannot be compared: one is {}, the other {}; render the same window",
                                     describe(a), describe(b)));
}

// A variance that is a sum of estimates, each of some samples. The sum has about as many degrees of freedom as Welch
// (1947) and Satterthwaite (1946) say.
struct SumOfVariances {
    double variance = 0.0;
    double squares = 0.0; // each over its degrees of freedom

    void add(double of_one, double samples) { // samples: 0 if that is not known; then it counts as exact
        variance += of_one;
        if (samples > 1)
            squares += of_one * of_one / (samples - 1);
    }
    double freedom() const {
        return squares > 0.0 ? variance * variance / squares : std::numeric_limits<double>::infinity();
    }
};

// Running sums over the pixels that are finite in both images.
struct Sums {
    double squared = 0.0, relative = 0.0, peak = 0.0;
    std::size_t values = 0;
    std::array<double, 3> a{}, b{};
    std::array<double, 3> tested_a{}, tested_b{}; // over the pixels of which a variance is known,
    std::array<SumOfVariances, 3> variance;       // and that
};

void add_pixel(const glm::vec3& a, const glm::vec3& b, Sums& sums, Comparison& result) {
    for (int c = 0; c < 3; ++c) {
        const double difference = double(a[c]) - double(b[c]);
        sums.squared += difference * difference;
        sums.relative += difference * difference / (double(b[c]) * b[c] + 0.01);
        sums.peak = std::max(sums.peak, double(b[c]));
        sums.a[c] += a[c];
        sums.b[c] += b[c];
        ++sums.values;
        result.max_abs_difference = std::max(result.max_abs_difference, std::abs(difference));
    }
}

// Standard errors between two values. A relative difference below 1e-5 is what summation in float may do.
double z_of(double a, double b, double variance) {
    const double difference = std::abs(a - b);
    if (difference <= 1e-5 * std::max(std::abs(a), std::abs(b)))
        return 0.0;
    return variance > 0.0 ? difference / std::sqrt(variance) : std::numeric_limits<double>::infinity();
}

// The normal deviate as rare as Student's t with `freedom` degrees (Wallace 1959: within 0.2 % of sigma, but of 3
// degrees up to 4 % too small, and of one 14 %).
double normal_of_t(double t, double freedom) {
    if (!std::isfinite(freedom) || !std::isfinite(t))
        return t;
    return (8 * freedom + 1) / (8 * freedom + 3) * std::sqrt(freedom * std::log1p(t * t / freedom));
}

// Few samples may all miss a rare bright event, and then underestimate mean and variance alike. So both images are
// given the larger of their two variances per sample, and the smaller sample count gives the degrees of freedom: a
// mean of few skewed samples is far from normal, however well the variance is known.
struct Noise {
    double variance = 0.0; // of the difference
    double freedom = std::numeric_limits<double>::infinity();
    bool certain = false; // no variance, and too many samples for that to be chance
};

// How many independent parts its variance is known from: samples, or passes of these.
double parts_of(const Film& film, std::size_t pixel) {
    return film.passes > 0 ? std::min(film.passes, film.samples[pixel]) : film.samples[pixel];
}

Noise noise_of(const Film& a, const Film& b, std::size_t pixel, int channel) {
    Noise noise;
    const double own_a = a.variance[pixel][channel];
    const double own_b = b.variance[pixel][channel];
    const double n_a = a.samples[pixel];
    const double n_b = b.samples[pixel];
    if (n_a < 1 || n_b < 1) { // an image of unknown making, whose values are taken for exact unless it has variances
        if (n_a + n_b == 1)   // the other's is unknown
            return noise;
        noise.variance = own_a + own_b;
        if (n_a + n_b > 0)
            noise.freedom = std::max(1.0, parts_of(a, pixel) + parts_of(b, pixel) - 1);
        return noise;
    }
    const double per_sample = std::max(own_a * n_a, own_b * n_b);
    noise.variance = per_sample * (1 / n_a + 1 / n_b);
    noise.freedom = std::max(1.0, std::min(parts_of(a, pixel), parts_of(b, pixel)) - 1);
    // All of 16 samples in one image and none of 16 in the other: at most 2^-32 by chance.
    noise.certain = per_sample == 0.0 && n_a >= 16 && n_b >= 16;
    return noise;
}

bool knows_samples(const Film& film) { // an image of unknown making has none anywhere
    return std::any_of(film.samples.begin(), film.samples.end(), [](std::uint32_t n) { return n > 0; });
}

// Tells for each pixel whether there is something in both images.
std::vector<bool> sampled_pixels(const Film& a, const Film& b) {
    const bool a_knows = knows_samples(a), b_knows = knows_samples(b);
    std::vector<bool> sampled;
    for (std::size_t i = 0; i < a.pixel_count(); ++i)
        sampled.push_back((a.samples[i] > 0 || !a_knows) && (b.samples[i] > 0 || !b_knows));
    return sampled;
}

// For sums over many pixels: unbiased, where noise_of is cautious. One sample has no variance of its own.
void add_plain_variance(const Film& a, const Film& b, std::size_t pixel, int channel, SumOfVariances& sum) {
    const double own_a = a.variance[pixel][channel];
    const double own_b = b.variance[pixel][channel];
    const double n_a = a.samples[pixel];
    const double n_b = b.samples[pixel];
    if (n_a == 1)
        sum.add(own_b * (n_b + 1), parts_of(b, pixel));
    else
        sum.add(own_a * (n_b == 1 ? n_a + 1 : 1), parts_of(a, pixel));
    if (n_a != 1 && n_b != 1)
        sum.add(own_b, parts_of(b, pixel));
}

// Of a picture's sum, which is known: of what shares samples an estimate by itself, else one for each pixel.
void add_sum(const Film& film, int channel, SumOfVariances& sum) {
    if (film.is_correlated)
        return sum.add((*film.sum_variance)[channel], *std::max_element(film.samples.begin(), film.samples.end()));
    for (std::size_t i = 0; i < film.pixel_count(); ++i)
        sum.add(film.variance[i][channel], parts_of(film, i));
}

SumOfVariances of_sums(const Film& a, const Film& b, int channel) {
    SumOfVariances sum;
    add_sum(a, channel, sum);
    add_sum(b, channel, sum);
    return sum;
}

bool is_tested(const Noise& noise) {
    return noise.variance > 0.0 || noise.certain;
}

void add_z(const Film& a, const Film& b, std::size_t pixel, Comparison& result) {
    for (int c = 0; c < 3; ++c) {
        const Noise noise = noise_of(a, b, pixel, c);
        if (!is_tested(noise))
            continue;
        const double z = normal_of_t(z_of(a.mean[pixel][c], b.mean[pixel][c], noise.variance), noise.freedom);
        ++result.tested;
        ++result.z_histogram[std::size_t(std::min(6.0, z))];
        if (z > result.z_bound)
            ++result.beyond_bound;
    }
}

void judge(const Film& a, const CompareOptions& options, Comparison& result) {
    const std::size_t pixels = a.pixel_count();
    const double mean_bound = sidak_bound(0.5 * options.significance, 3);
    const double worst_mean = *std::max_element(result.mean_z.begin(), result.mean_z.end());
    const auto verdict = [&result](bool different, std::string reason) {
        result.different = different;
        result.reason = std::move(reason);
    };
    if (result.non_finite > 0)
        return verdict(true, fmt::format("{} pixels are not finite", result.non_finite));
    if (result.unsampled == pixels)
        return verdict(true, "no pixel has samples in both images");
    if (options.max_relmse)
        return verdict(result.relmse > *options.max_relmse,
                       fmt::format("relMSE {:.6g} against a limit of {:.6g}", result.relmse, *options.max_relmse));
    if (result.identical_pixels == pixels)
        return verdict(false, "identical");
    if (!result.has_variance)
        return verdict(true, "neither image knows its variance, and they are not identical; --max-relmse sets a limit");
    if (result.has_mean_z && worst_mean > mean_bound)
        return verdict(true, fmt::format("the picture means are {:.2f} standard errors apart, more than {:.2f}",
                                         worst_mean, mean_bound));
    if (result.beyond_bound > 0)
        return verdict(true, fmt::format("{} of {} values differ by more than {:.2f} standard errors",
                                         result.beyond_bound, result.tested, result.z_bound));
    verdict(false, fmt::format("noise explains the difference (significance {:g})", options.significance));
}

} // namespace

Comparison compare_films(const Film& a, const Film& b, const CompareOptions& options) {
    check_windows(a, b);
    Comparison result;
    result.pixels = a.pixel_count();
    const auto variance_of = [&](std::size_t i) { return a.variance[i] + b.variance[i]; };
    std::size_t testable = 0;
    const std::vector<bool> sampled = sampled_pixels(a, b);
    for (std::size_t i = 0; i < result.pixels; ++i)
        for (int c = 0; c < 3; ++c) {
            testable += sampled[i] && is_tested(noise_of(a, b, i, c)) ? 1 : 0;
            result.has_variance = result.has_variance || variance_of(i)[c] > 0.0f;
        }
    result.has_variance = result.has_variance || testable > 0; // or no noise, for certain
    // Half of the significance goes to the pixels, half to the three means.
    result.z_bound = sidak_bound(0.5 * options.significance, testable);
    const bool is_correlated = a.is_correlated || b.is_correlated;
    const std::optional<glm::dvec3> of_a = variance_of_sum(a), of_b = variance_of_sum(b);
    result.has_mean_z = !is_correlated || (of_a && of_b);

    Sums sums;
    for (std::size_t i = 0; i < result.pixels; ++i) {
        if (!finite(a.mean[i]) || !finite(b.mean[i]) || !finite(variance_of(i))) {
            ++result.non_finite;
            continue;
        }
        result.identical_pixels += same_bits(a.mean[i], b.mean[i]) ? 1 : 0;
        if (!sampled[i]) {
            ++result.unsampled;
            continue;
        }
        add_pixel(a.mean[i], b.mean[i], sums, result);
        // The variance of two single samples is not known, nor that of one beside an image of unknown making.
        if (is_correlated || std::max(a.samples[i], b.samples[i]) != 1)
            for (int c = 0; c < 3; ++c) {
                sums.tested_a[c] += a.mean[i][c];
                sums.tested_b[c] += b.mean[i][c];
                add_plain_variance(a, b, i, c, sums.variance[c]);
            }
        add_z(a, b, i, result);
    }
    const double values = std::max(1.0, double(sums.values));
    result.mse = sums.squared / values;
    result.relmse = sums.relative / values;
    result.psnr = result.mse > 0.0 ? 10.0 * std::log10(sums.peak * sums.peak / result.mse)
                                   : std::numeric_limits<double>::infinity();
    for (int c = 0; c < 3; ++c) {
        result.mean_ratio[c] = sums.a[c] == sums.b[c] ? 1.0 : sums.a[c] / sums.b[c];
        const SumOfVariances variance = is_correlated && result.has_mean_z ? of_sums(a, b, c) : sums.variance[c];
        result.mean_z[c] = normal_of_t(z_of(sums.tested_a[c], sums.tested_b[c], variance.variance), variance.freedom());
    }
    judge(a, options, result);
    return result;
}

namespace {

void print_text(const Comparison& result) {
    tell(stdout, "pixels          {} compared, {} identical\n", result.pixels, result.identical_pixels);
    if (result.unsampled > 0)
        tell(stdout, "without samples {} pixels, which are left out\n", result.unsampled);
    tell(stdout, "MSE             {:.6g}\nrelMSE          {:.6g}\nPSNR            {:.2f} dB\n", result.mse,
         result.relmse, result.psnr);
    tell(stdout, "mean ratio      {:.6f} {:.6f} {:.6f}\n", result.mean_ratio[0], result.mean_ratio[1],
         result.mean_ratio[2]);
    tell(stdout, "max difference  {:.6g}\n", result.max_abs_difference);
    if (result.has_variance) {
        if (result.has_mean_z)
            tell(stdout, "mean z          {:.2f} {:.2f} {:.2f}\n", result.mean_z[0], result.mean_z[1],
                 result.mean_z[2]);
        else
            tell(stdout,
                 "mean z          unknown: pixels share moments of what moves, or particles of a single sample\n");
        tell(stdout, "|z| histogram   {} in steps of 1, the last is 6 and more\n", fmt::join(result.z_histogram, " "));
        tell(stdout, "beyond {:5.2f}    {} of {} values\n", result.z_bound, result.beyond_bound, result.tested);
    }
    tell(stdout, "{}: {}\n", result.different ? "DIFFERENT" : "same", result.reason);
}

// Of pictures whose colours are the same.
std::vector<std::string> layer_notes(const Film& a, const Film& b) {
    std::vector<std::string> notes;
    for (const FilmLayer& layer : a.layers)
        if (const FilmLayer* other = b.layer(layer.name))
            if (!std::ranges::equal(layer.mean, other->mean, same_bits))
                notes.push_back(fmt::format("the layer {} differs; what is compared are the colours", layer.name));
    return notes;
}

// JSON has no infinity; null stands for it.
void print_json(const Comparison& result) {
    const auto number = [](double value) { return std::isfinite(value) ? nlohmann::ordered_json(value) : nullptr; };
    nlohmann::ordered_json json;
    json["different"] = result.different;
    json["reason"] = result.reason;
    json["pixels"] = result.pixels;
    json["identicalPixels"] = result.identical_pixels;
    json["unsampledPixels"] = result.unsampled;
    json["nonFinite"] = result.non_finite;
    json["mse"] = number(result.mse);
    json["relMSE"] = number(result.relmse);
    json["psnr"] = number(result.psnr);
    for (const double ratio : result.mean_ratio)
        json["meanRatio"].push_back(number(ratio));
    json["maxAbsDifference"] = number(result.max_abs_difference);
    if (result.has_variance) {
        for (const double z : result.mean_z)
            json["meanZ"].push_back(result.has_mean_z ? number(z) : nullptr);
        json["zHistogram"] = result.z_histogram;
        json["zBound"] = result.z_bound;
        json["beyondBound"] = result.beyond_bound;
        json["tested"] = result.tested;
    }
    put(stdout, json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

} // namespace

int run_compare(const CompareOptions& options) {
    Metadata metadata_a, metadata_b;
    const Film a = read_exr(options.a, &metadata_a);
    const Film b = read_exr(options.b, &metadata_b);
    if (a.has_other_primaries != b.has_other_primaries)
        tell(stderr,
             "vkvol: warning: {}: its primaries are not those of the other image, but its numbers are taken as such\n",
             (a.has_other_primaries ? options.a : options.b).string());
    const Comparison result = compare_films(a, b, options);
    // Of a copy, or a render repeated, nothing is judged by statistics.
    const std::vector<std::string> notes = result.identical_pixels == result.pixels
                                               ? layer_notes(a, b)
                                               : comparison_notes(options, metadata_a, metadata_b);
    for (const std::string& note : notes)
        tell(stderr, "vkvol: note: {}\n", note);
    if (options.json)
        print_json(result);
    else
        print_text(result);
    return result.different ? exit_different : exit_done;
}

} // namespace vkvol
