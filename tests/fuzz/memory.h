// What an input has allocated, and the bound of that.
#pragma once

#include <cstdint>

namespace vkvol::fuzz {

// From here on: counts from 0, and allocations that would take the sum of what is live beyond `bound` are noted; those
// by `new` then throw std::bad_alloc, as they would on a machine that is full.
void begin_counting(std::uint64_t bound);
void end_counting();

std::uint64_t peak_bytes();
std::uint64_t refused_bytes(); // the allocation that went beyond the bound; 0: none did

} // namespace vkvol::fuzz
