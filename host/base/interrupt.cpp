#include "interrupt.h"

#include <csignal>
#include <unistd.h>
#include <utility>

#include "error.h"

namespace vkvol {

namespace {

// Lock-free and async-signal-safe, unlike most else.
volatile std::sig_atomic_t signals_seen = 0;

thread_local const InterruptQuestion* question = nullptr;

// A terminal that is closed sends more than one signal, and nobody is out of patience.
void on_signal(int signal) {
    if (signals_seen && signal == SIGINT)
        _exit(exit_interrupted);
    signals_seen = 1;
}

} // namespace

void install_interrupt_handler() {
    signals_seen = 0;
    struct sigaction action {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART; // reads and writes under way go on
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    if (std::signal(SIGHUP, SIG_IGN) != SIG_IGN) // nohup stays in force
        sigaction(SIGHUP, &action, nullptr);
    std::signal(SIGPIPE, SIG_IGN); // a reader of messages that is gone is no reason to end
}

bool interrupted() {
    return signals_seen != 0 || (question && question->asked_());
}

InterruptQuestion::InterruptQuestion(std::function<bool()> asked) : asked_(std::move(asked)), before_(question) {
    question = this;
}

InterruptQuestion::~InterruptQuestion() {
    question = before_;
}

} // namespace vkvol
