// The radiance of black bodies between two wavelengths, for thermal bands in scene values.
#pragma once

#include <vector>

namespace vkvol {

// In W / (m^2 sr), of arguments kelvin > 0 and the wavelengths 0 <= from < to in micrometres; not a number if they are
// not so. Within 1e-9 of the whole spectrum's, sigma T^4 / pi.
double planck_band(const std::vector<double>& arguments);

} // namespace vkvol
