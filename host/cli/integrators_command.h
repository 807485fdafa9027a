// The `integrators` command: which estimators there are.
#pragma once

namespace vkvol {

// A table, or JSON, on standard output. Returns the exit code.
int run_integrators(bool json);

} // namespace vkvol
