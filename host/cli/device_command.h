// The `devices` command: what there is to render on.
#pragma once

namespace vkvol {

// A table, or JSON, on standard output. Returns the exit code: no usable device is one.
int run_devices(bool json);

} // namespace vkvol
