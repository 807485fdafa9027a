#pragma once

// The tests are written for Catch2 2, whose one header this is named after. Where there is version 3,
// tests/CMakeLists.txt puts this one in its place: the names of version 2 that the tests use, in terms of version 3.

#include <catch2/catch_all.hpp>

namespace Catch {

inline Matchers::StringContainsMatcher Contains(const std::string& text,
                                                CaseSensitive sensitivity = CaseSensitive::Yes) {
    return Matchers::ContainsSubstring(text, sensitivity);
}

using Matchers::EndsWith;
using Matchers::StartsWith;

} // namespace Catch

using Catch::Approx;
