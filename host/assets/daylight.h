// A clear or hazy sky by day, by the height of the sun: Preetham, Shirley and Smits, "A Practical Analytic Model for
// Daylight", SIGGRAPH 1999. In photometric units: radiances have luminances in kcd/m^2, irradiances illuminances in
// klx.
#pragma once

#include "lights.h"
#include "radiance_map.h"

namespace vkvol {

// Radiance of the sky without the sun's disc. The model has none below the horizon: there is the light that a ground of
// `ground`'s albedo gives back.
RadianceMap make_daylight(const Daylight& daylight);

// Irradiance of the sun on a plane that faces it: a black body of 5778 kelvin and 133 klx beyond the atmosphere, seen
// through air, haze and ozone at three wavelengths.
Rgb sun_irradiance(const Daylight& daylight);

} // namespace vkvol
