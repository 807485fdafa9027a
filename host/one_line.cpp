#include "one_line.h"

#include <cctype>

namespace vkvol {

std::string one_line(std::string message) {
    constexpr std::size_t longest = 1500;
    if (message.size() > longest)
        message = message.substr(0, longest - 3) + "...";
    for (char& c : message)
        if (std::iscntrl(static_cast<unsigned char>(c)))
            c = ' ';
    return message;
}

} // namespace vkvol
