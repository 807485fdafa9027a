#include "one_line.h"

#include <cctype>
#include <fmt/format.h>

namespace vkvol {

std::string one_line(std::string message) {
    constexpr std::size_t longest = 1500;
    if (message.size() > longest)
        message = message.substr(0, longest - 3) + "...";
    std::string line;
    for (const char c : message) {
        const auto byte = static_cast<unsigned char>(c);
        if (std::isspace(byte))
            line += ' ';
        else if (std::iscntrl(byte))
            line += fmt::format("\\x{:02x}", byte);
        else
            line += c;
    }
    return line;
}

} // namespace vkvol
