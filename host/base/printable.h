// Text as a terminal may show it: whatever a file is called, its name gives the terminal no orders.
#pragma once

#include <string>
#include <string_view>

namespace vkvol {

// Control characters and bytes that are no UTF-8 become \xNN.
std::string printable(std::string_view text, bool keep_newlines = false);

} // namespace vkvol
