// What a render tells its user on the way. When nobody can hear it (a pipe closed, a terminal gone, a log on a full
// disk), the render goes on: fmt::print would throw.
#pragma once

#include <cstdio>
#include <fmt/format.h>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "printable.h"

namespace vkvol {

// A finished text, as it is.
inline void put(std::FILE* out, std::string_view text) {
    std::fwrite(text.data(), 1, text.size(), out);
}

// An argument as it is shown: names of files and what files hold may be anything. A text that ends its line is a text
// of ours, and may have several.
template <class T> decltype(auto) shown(const T& argument) {
    if constexpr (std::is_convertible_v<const T&, std::string_view>)
        return printable(argument, std::string_view(argument).ends_with('\n'));
    else
        return argument;
}

template <class... Shown> std::string format_shown(fmt::string_view format, const Shown&... arguments) {
    return fmt::vformat(format, fmt::make_format_args(arguments...));
}

template <class T> using ShownType = std::remove_cvref_t<decltype(shown(std::declval<const T&>()))>;

template <class... Arguments>
void tell(std::FILE* out, fmt::format_string<ShownType<Arguments>...> format, const Arguments&... arguments) {
    put(out, format_shown(format, shown(arguments)...));
}

} // namespace vkvol
