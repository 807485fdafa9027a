// What a grid is read for.
#pragma once

namespace vkvol {

enum class GridValues { numbers, numbers_or_colors };

} // namespace vkvol
