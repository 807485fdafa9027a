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

// Bits of what a kernel is compiled with only where a scene has it: FORM_FLAGS of shaders/CMakeLists.txt. A table of a
// kernel's forms is indexed by their sum.
inline constexpr unsigned form_chromatic = 1, form_windows = 2, form_full = 4, form_several = 8, form_surfaces = 16,
                          form_ray_query = 32;

// These values, with zero for the constants that the kernel does not declare: where two are equal, so are its codes.
Specialization declared_of(std::span<const std::uint32_t> spirv, const Specialization& specialization);

// The kernel as these values leave it: what they make unreachable is gone, and nothing is left to specialise. Drivers
// could do that themselves, but pay for the whole kernel first: half of llvmpipe's start-up, and minutes in
// SwiftShader.
std::vector<std::uint32_t> specialized(std::span<const std::uint32_t> spirv, const Specialization& specialization);

// What specialized() does, by a name that changes with it, for who keeps what it returned.
extern const char* const specialization_method;

// The kernel with a plea to keep the loops that it asks to have written out. SwiftShader's compiler needs minutes and
// tens of gigabytes for some kernels with them written out (walks of four steps through voxels between their centres,
// looks from along such flights), and 1 to 3 s as loops.
std::vector<std::uint32_t> loops_kept(std::vector<std::uint32_t> spirv);

} // namespace vkvol
