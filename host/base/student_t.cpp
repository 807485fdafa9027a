#include "student_t.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

namespace vkvol {

double student_two_sided(double freedom, double probability) {
    const boost::math::students_t distribution(std::max(freedom, 1.0));
    return quantile(complement(distribution, 0.5 * (1.0 - probability)));
}

double normal_upper(double tail) {
    return quantile(complement(boost::math::normal(), tail));
}

} // namespace vkvol
