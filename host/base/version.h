#pragma once

namespace vkvol {

inline constexpr const char* version = VKVOL_VERSION;

} // namespace vkvol
