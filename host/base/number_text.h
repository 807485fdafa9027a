// Numbers as people write them in scenes and tables: the same whatever the locale.
#pragma once

#include <charconv>
#include <string_view>

namespace vkvol {

struct NumberText {
    double value = 0.0;
    bool is_number = false;    // all of the text; also what is too large to be held
    bool is_too_large = false; // what is too small to be held is 0
};

// A plus before it is passed over; spaces are not. Also inf and nan, in any case.
NumberText read_number_text(std::string_view text);

// std::from_chars, but that what is too small to be held is 0.
std::from_chars_result read_number_at(const char* begin, const char* end, double& value);

} // namespace vkvol
