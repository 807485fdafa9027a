// Numbers as they stand in scenes that people go on with.
#pragma once

#include <string>

namespace vkvol {

// Decimals at which a hundred-thousandth of `size`, above 0, is still told apart.
int decimals_for(double size);

// With so many decimals, but no zeros behind them.
std::string short_text(double value, int decimals);

} // namespace vkvol
