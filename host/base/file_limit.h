// `ulimit -f`: what grows beyond it is an error to report, not a death. Files are not all that grows: software drivers
// may keep device memory in one (lavapipe does since Mesa 24), and map it whether it could grow or not.
#pragma once

namespace vkvol {

// Once, before anything is written.
void install_file_limit_handler();

// Whether the calling thread has met the limit since it asked last.
bool file_limit_met();

} // namespace vkvol
