// Judging random results: running moments and the tail probabilities of the usual tests. A p-value is the probability
// of a result at least as far from what is expected, if nothing is wrong; a test fails when it is below the stated
// significance.
#pragma once

#include <cmath>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

namespace vkvol {

// Welford's running mean and variance (Knuth, TAOCP vol. 2, 4.2.2).
class RunningMean {
public:
    void add(double x);

    double count() const { return count_; }
    double mean() const { return mean_; }
    double variance() const; // unbiased, of one value
    double standard_error() const;

private:
    double count_ = 0.0, mean_ = 0.0, squares_ = 0.0;
};

// Two-sided, of a standard normal z.
double normal_p(double z);

// Two-sided, that `mean` differs from `expected` as much as it does: Student's t-test. Values that are all equal have
// p = 1 if they agree with `expected` within `rounding`, else 0.
double t_test_p(const RunningMean& mean, double expected, double rounding = 0.0);

// The worse of the two; what is no number is worse than all.
template <class T> void worsen(T& worst, std::type_identity_t<T> found) {
    if (!(found <= worst))
        worst = std::isnan(found) ? std::numeric_limits<T>::infinity() : found;
}

// p of a chi-square statistic, upper tail.
double chi_square_p(double statistic, double degrees_of_freedom);

// p of observed against expected counts; neighbouring bins are merged until each expects at least 5.
double chi_square_test_p(std::span<const double> observed, std::span<const double> expected);

// That `uniforms` come from the uniform distribution on [0, 1]: Kolmogorov-Smirnov. Sorts its argument.
double kolmogorov_smirnov_p(std::vector<double> uniforms);

// Significance of each of n independent tests so that all together have significance alpha (Sidak).
double sidak(double alpha, double n);

} // namespace vkvol
