// Programs as a user runs them.
#pragma once

#include <string>

namespace vkvol {

struct Run {
    int code = -1;    // -1: ended by a signal
    std::string text; // standard output and error
};

// By the shell.
Run run(const std::string& command);

} // namespace vkvol
