#include "number_text.h"

#include <charconv>

namespace vkvol {

namespace {

// Of a number that cannot be held: by the sign of its exponent, or by whether it has digits before its point.
bool is_small(std::string_view text) {
    const std::size_t exponent = text.find_first_of("eE");
    if (exponent != std::string_view::npos)
        return text.substr(exponent + 1).starts_with('-');
    return text.find_first_of("123456789") > text.find('.');
}

} // namespace

NumberText read_number_text(std::string_view text) {
    if (text.starts_with('+') && !text.starts_with("+-"))
        text.remove_prefix(1);
    NumberText read;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), read.value);
    read.is_number = error != std::errc::invalid_argument && end == text.data() + text.size();
    if (error == std::errc::result_out_of_range) {
        read.value = 0.0;
        read.is_too_large = read.is_number && !is_small(text);
    }
    return read;
}

} // namespace vkvol
