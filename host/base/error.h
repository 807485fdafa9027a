// The kinds of failure a user can meet. main() turns them into exit codes; others catch them only to add where it was,
// or to save what there is.
#pragma once

#include <stdexcept>

namespace vkvol {

enum ExitCode {
    exit_done = 0,
    exit_render_failed = 1,
    exit_bad_input = 2, // command line, scene or asset
    exit_no_device = 3, // no usable device
    exit_different = 4, // compare found a difference
    exit_caps_hit = 5,  // finished, but caps were hit or samples were not finite, under --strict
    exit_interrupted = 130
};

// The command line, the scene or an asset is wrong. The message names the place and the remedy, in one line.
struct InputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// No Vulkan device can be used. The message lists every device with the reason for its rejection.
struct DeviceError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// The render, or the writing of its result, failed.
struct RenderError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

} // namespace vkvol
