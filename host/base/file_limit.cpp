#include "file_limit.h"

#include <csignal>

namespace vkvol {

namespace {

// The kernel signals the thread whose call would have exceeded the limit, within that call.
thread_local volatile std::sig_atomic_t limit_met = 0;

} // namespace

void install_file_limit_handler() {
    struct sigaction action {};
    action.sa_handler = [](int) { limit_met = 1; };
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(SIGXFSZ, &action, nullptr);
}

bool file_limit_met() {
    const bool met = limit_met != 0;
    limit_met = 0;
    return met;
}

} // namespace vkvol
