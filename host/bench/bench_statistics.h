// What a bench makes of its runs. Pure functions; an interval holds the true value with probability 95 % unless
// another is given.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "film.h"

namespace vkvol {

// A figure with its 95 % confidence interval.
struct Interval {
    double value = 0.0, low = 0.0, high = 0.0;
};

// One measured render.
struct BenchRun {
    std::uint32_t samples = 0; // per pixel
    std::uint32_t seed = 0;
    double seconds = 0.0;
    double relmse = 0.0;
    std::optional<double> relmse_from_variance; // what its own variance predicts; one sample has none
    std::optional<double> noise = std::nullopt; // see film.h
};

// All runs of one count of samples.
struct BenchPoint {
    std::uint32_t samples = 0;
    std::size_t runs = 0;
    double seconds = 0.0, seconds_low = 0.0, seconds_high = 0.0; // median, least, most
    double relmse = 0.0;                                         // mean
    std::optional<double> relmse_error;                          // its standard error s / sqrt(runs), from two runs on
    std::optional<double> relmse_from_variance;                  // mean
};

// Mean over pixels and channels of ((I - R)^2 - var_R) / (R^2 + 0.01), I the image, R the reference and var_R the
// variance of its mean: since E[(I - R)^2] = E[(I - mu)^2] + var_R, the error is that against the true mean mu. It may
// come out below 0. Pixels that the reference has no two samples of, and values that are not finite, are left out;
// a reference without samples and variance is taken for exact. Both films show the same window.
double relative_mse(const Film& image, const Film& reference);

// Mean of var_I / (R^2 + 0.01) over the same pixels: what relative_mse is to come to, by the image's own variance.
double relative_variance(const Film& image, const Film& reference);

// Standard error of the offset that a reference's noise, the same in every run, leaves in relative_mse: the mean of
// ((R - mu)^2 - var_R) / (R^2 + 0.01) has expectation 0, and variance sum over pixels of 2 r^2 / count^2 with r the
// pixel's var_R / (R^2 + 0.01), its channels varying as one.
double reference_offset_error(const Film& reference);

// In order of samples.
std::vector<BenchPoint> points_of(std::span<const BenchRun> runs);

// The most samples of any run; 0 without runs.
std::uint32_t largest_count(std::span<const BenchRun> runs);

double median(std::vector<double> values); // of at least one

// The figures below are nothing where they have no meaning: too few runs or counts, or, where logarithms are taken, a
// run whose relMSE is not positive, for then the reference is no better than what it is to judge.

// s in relMSE = c seconds^s: least squares of log relMSE on the logarithm of the count's median seconds, each run with
// its samples as weight; Student's t with n - 2 degrees of freedom on the weighted residuals. Logarithms, since relMSE
// scatters in proportion to itself and is skewed to the right. Samples as weights, since as long as rare bright paths
// make the scatter, its relative variance falls as 1 / samples; where it falls no more, the interval is too wide.
std::optional<Interval> error_slope(std::span<const BenchRun> runs);

// b in E[relMSE] = b + E[relMSE from variance], the error that more samples would not remove: the mean of the runs'
// differences. The variance of a picture's mean is estimated without bias, so with n samples of errors e_1 ... e_n the
// difference is, pixel by pixel, the sum of e_k e_l over k != l, over n (n - 1): its expectation is the squared bias,
// and without bias its variance is in proportion to 1 / (n (n - 1)), which gives the weights, whatever the tails of e.
// Student's t with runs - 1 degrees of freedom on the weighted scatter; beside a floor the variance is not in
// proportion to the weights, and the interval is no narrower than one that does not ask for that. `offset_error`, of
// the reference, is added in quadrature. Runs of one sample do not count. May come out below 0 by chance. The interval
// holds the true value with `probability`.
std::optional<Interval> bias_floor(std::span<const BenchRun> runs, double offset_error, double probability = 0.95);

// What each of `count` intervals must hold its value with, for all together to do so with 95 % (Sidak): of many floors
// of 0, one would else seem to be more.
double probability_of_each(std::size_t count);

// 1 / (relMSE seconds), as a mean over all runs of its logarithm, weighted by seconds: short runs pay for starting up,
// and it is long ones that are waited for. So it is a geometric mean: where few runs meet rare bright samples, what
// most of them have. `offset_error`, of the reference, is the same in all runs, and added in quadrature. Student's t on
// the weighted scatter of the logarithms, with as many degrees of freedom as there are effective runs, (sum w)^2 / sum
// w^2, less one. Not a bootstrap, whose intervals are too narrow at the five or ten runs there are; and the logarithm
// makes the heavy right tail of relMSE a light one.
std::optional<Interval> efficiency(std::span<const BenchRun> runs, double offset_error = 0.0);

// efficiency(runs) / efficiency(base): Welch's t on the logarithms. The interval holds the true value with
// `probability`.
std::optional<Interval> efficiency_ratio(std::span<const BenchRun> runs, std::span<const BenchRun> base,
                                         double offset_error = 0.0, double probability = 0.95);

// How many times as long a bench would have to be for the efficiency to be fit to compare: 1 if it is. Fit it is from
// four effective runs on, with an interval from a third to thrice its value at most: what is measured so differs by
// less than the estimators that are worth telling apart, and a t of fewer runs is a guess. From longer benches, with
// five runs and errors in proportion to 1 / sqrt(seconds), t * error is to be log 3.
double times_to_judge(std::span<const BenchRun> runs);

// Until the picture's noise is `target`: noise^2 seconds / target^2, the median over the runs of the most samples,
// since noise^2 falls as 1 / seconds. Nothing if that is not known, as of single samples.
std::optional<double> seconds_to_noise(double target, std::span<const BenchRun> runs);

} // namespace vkvol
