// What --dry-run says: what would be rendered, on what, and which files it would make.
#pragma once

#include "options.h"
#include "session.h"

namespace vkvol {

// `result` is that of a render that was set up and not run.
void print_dry_run(const RenderOptions& options, const Scene& scene, const Device& device, const RenderResult& result);

} // namespace vkvol
