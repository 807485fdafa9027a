// Student's t distribution, for confidence intervals.
#pragma once

namespace vkvol {

// x with P(|T| <= x) = 0.95; `freedom` >= 1 degrees of freedom, not necessarily whole.
double student_t95(double freedom);

} // namespace vkvol
