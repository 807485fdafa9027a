// Ctrl-C, SIGTERM and a lost terminal end a render early but in order: what was rendered so far is written.
#pragma once

#include <stdexcept>

namespace vkvol {

// A signal ended a wait before there was anything to write. Exit code 130.
struct Interrupted : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// The first signal sets the flag below; the second ends the process at once with exit code 130.
void install_interrupt_handler();

// Asked by the render loop between batches.
bool interrupted();

} // namespace vkvol
