// Hints for misspelt names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vkvol {

// Insertions, deletions, substitutions and swaps of neighbours, case ignored.
std::size_t edit_distance(std::string_view a, std::string_view b);

// The known name nearest to `name`; empty when none is near enough to be what was meant.
std::string nearest_name(std::string_view name, const std::vector<std::string>& known);

// "; did you mean X?", or "; known are X, Y, Z" when nothing is near.
std::string name_hint(std::string_view name, const std::vector<std::string>& known);

} // namespace vkvol
