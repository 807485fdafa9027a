#pragma once

#include <cstdint>

namespace vkvol {

// Bytes that programs of this machine may still take, as the system estimates; 0 where it does not say.
std::uint64_t memory_left();

} // namespace vkvol
