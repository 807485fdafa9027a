// Ctrl-C, SIGTERM and a lost terminal end a render early but in order: what was rendered so far is written.
#pragma once

#include <functional>
#include <stdexcept>

namespace vkvol {

// A signal ended a wait before there was anything to write. Exit code 130.
struct Interrupted : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// The first signal sets the flag below; a Ctrl-C after it ends the process at once with exit code 130.
void install_interrupt_handler();

// Asked by the render loop between batches, and by whatever waits.
bool interrupted();

// Where signals are handled elsewhere, as Python's are: as long as it lives, `interrupted` on this thread asks this as
// well.
class InterruptQuestion {
public:
    explicit InterruptQuestion(std::function<bool()> asked);
    ~InterruptQuestion();
    InterruptQuestion(const InterruptQuestion&) = delete;
    InterruptQuestion& operator=(const InterruptQuestion&) = delete;

private:
    friend bool interrupted();
    const std::function<bool()> asked_;
    const InterruptQuestion* const before_;
};

} // namespace vkvol
