// Values that change between keys, for animations: places that ascend, with a value each.
#pragma once

#include <vector>

namespace vkvol {

// `numbers`: where, and then place, value, place, value, ... Before the first key and behind the last its own value
// holds. NaN if places do not ascend, or one lacks its value.

// Straight from key to key.
double linear_keys(const std::vector<double>& numbers);

// Smoothly through the keys: a cubic between two, whose slope at a key is that from the key before to the one behind
// (Catmull and Rom, "A Class of Local Interpolating Splines", 1974), at the first and last that to their neighbour.
double spline_keys(const std::vector<double>& numbers);

} // namespace vkvol
