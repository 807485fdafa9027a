// Limits of Student's t and of the normal distribution, for confidence intervals and tests.
#pragma once

namespace vkvol {

// x with P(|T| <= x) = `probability`, below 1; `freedom` >= 1 degrees of freedom, not necessarily whole.
double student_two_sided(double freedom, double probability);

inline double student_t95(double freedom) {
    return student_two_sided(freedom, 0.95);
}

// x with P(Z > x) = `tail` in (0, 1).
double normal_upper(double tail);

// x with P(|Z| <= x) = `probability`.
inline double normal_two_sided(double probability) {
    return normal_upper(0.5 * (1.0 - probability));
}

} // namespace vkvol
