// Are two renders estimates of the same picture? Error figures and a statistical verdict.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "film.h"
#include "options.h"

namespace vkvol {

struct Comparison {
    double mse = 0.0;                   // mean over pixels and channels of (a - b)^2
    double relmse = 0.0;                // mean of (a - b)^2 / (b^2 + 0.01), b the reference
    double psnr = 0.0;                  // dB, peak = the largest value of b; infinite for equal images
    std::array<double, 3> mean_ratio{}; // mean of a over mean of b per channel; 1 where both are 0
    double max_abs_difference = 0.0;    // over pixels and channels
    std::size_t identical_pixels = 0;   // bit for bit
    std::size_t pixels = 0;             // compared
    std::size_t non_finite = 0;         // values that are not finite, in either image; left out of everything else
    bool has_variance = false;          // either image knows its variance: the figures below have a meaning
    std::size_t tested = 0;             // values (pixel and channel) with a variance
    double z_bound = 0.0;               // two-sided normal quantile for the significance, Sidak-corrected
    std::size_t beyond_bound = 0;       // values with |z| > z_bound
    std::array<std::size_t, 7> z_histogram{}; // |z| in [0,1) [1,2) ... [5,6) [6,inf)
    std::array<double, 3> mean_z{};           // z of the difference of the picture means per channel,
    std::size_t unsampled = 0;                // pixels, in one image or both: they are left out
    bool has_mean_z = true;                   // if it is known: not of what moves, and of particles with their sum's
    bool different = false;
    std::string reason; // one line: why the verdict is what it is
};

// `a` against the reference `b`. Throws InputError when sizes or windows differ.
Comparison compare_films(const Film& a, const Film& b, const CompareOptions& options);

// The `compare` command: reads, prints to standard output, returns the exit code.
int run_compare(const CompareOptions& options);

} // namespace vkvol
