// Student's t distribution, for confidence intervals.
#pragma once

namespace vkvol {

// x with P(|T| <= x) = `probability`, below 1; `freedom` >= 1 degrees of freedom, not necessarily whole.
double student_t(double freedom, double probability);

inline double student_t95(double freedom) {
    return student_t(freedom, 0.95);
}

// Of the normal distribution.
inline double normal_quantile(double probability) {
    return student_t(1e7, probability);
}

} // namespace vkvol
