// What a grid is read for.
#pragma once

namespace vkvol {

// Vectors may be negative, as colours may not.
enum class GridValues { numbers, numbers_or_colors, vectors };

} // namespace vkvol
