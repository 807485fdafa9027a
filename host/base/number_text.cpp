#include "number_text.h"

#include <algorithm>
#include <charconv>

namespace vkvol {

namespace {

// Of a number that cannot be held: by the place of its first digit that is not 0, before or behind the point, and its
// exponent.
bool is_small(std::string_view text) {
    const std::size_t behind = std::min(text.find_first_of("eE"), text.size());
    const std::string_view digits = text.substr(0, behind), exponent = text.substr(std::min(behind + 1, text.size()));
    const auto point = static_cast<long long>(std::min(digits.find('.'), digits.size())),
               first = static_cast<long long>(digits.find_first_of("123456789"));
    constexpr long long far = 1'000'000'000;
    long long power = 0;
    const std::string_view unsigned_part = exponent.substr(exponent.starts_with('+') ? 1 : 0);
    if (std::from_chars(unsigned_part.data(), unsigned_part.data() + unsigned_part.size(), power).ec ==
        std::errc::result_out_of_range)
        power = exponent.starts_with('-') ? -far : far;
    return point - first + std::clamp(power, -far, far) < 0;
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

std::from_chars_result read_number_at(const char* begin, const char* end, double& value) {
    std::from_chars_result result = std::from_chars(begin, end, value);
    if (result.ec == std::errc::result_out_of_range && is_small({begin, result.ptr})) {
        value = 0.0;
        result.ec = std::errc();
    }
    return result;
}

} // namespace vkvol
