// Numbers that tests share: a file says by `using` which of them it means.
#pragma once

#include <cstdint>
#include <limits>

namespace test_numbers {

constexpr double u = 0x1p-24;   // unit roundoff of float: the largest relative error of one rounding
constexpr double ulp = 0x1p-23; // from 1 to the next float
constexpr double infinity = std::numeric_limits<double>::infinity();

// How test kernels say that a segment ended: EVENT_... of majorants/majorant.glsl.
constexpr std::uint32_t collided = 1, left = 2, opaque = 4;

} // namespace test_numbers
