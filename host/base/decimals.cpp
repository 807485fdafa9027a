#include "decimals.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace vkvol {

int decimals_for(double size) {
    return std::clamp(5 - int(std::floor(std::log10(size))), 0, 30);
}

std::string short_text(double value, int decimals) {
    std::string text = fmt::format("{:.{}f}", value, decimals);
    if (text.find('.') != std::string::npos) {
        text.erase(text.find_last_not_of('0') + 1);
        if (text.back() == '.')
            text.pop_back();
    }
    return text == "-0" ? "0" : text;
}

} // namespace vkvol
