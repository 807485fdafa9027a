// What a render tells its user on the way. When nobody can hear it (a pipe closed, a terminal gone, a log on a full
// disk), the render goes on: fmt::print would throw.
#pragma once

#include <cstdio>
#include <fmt/format.h>
#include <string>
#include <utility>

namespace vkvol {

template <class... Arguments>
void tell(std::FILE* out, fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    const std::string text = fmt::format(format, std::forward<Arguments>(arguments)...);
    std::fwrite(text.data(), 1, text.size(), out);
}

} // namespace vkvol
