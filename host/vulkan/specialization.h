// Specialization constants, and kernels that have theirs built in.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "shared/constants.h"

namespace vkvol {

// Value of every specialization constant, by SPEC_ number. Kernels take what they declare.
using Specialization = std::array<std::int32_t, SPEC_COUNT>;

// The kernel as these values leave it: what they make unreachable is gone, and nothing is left to specialise. Drivers
// could do that themselves, but pay for the whole kernel first: half of llvmpipe's start-up, and minutes in
// SwiftShader.
std::vector<std::uint32_t> specialized(std::span<const std::uint32_t> spirv, const Specialization& specialization);

} // namespace vkvol
