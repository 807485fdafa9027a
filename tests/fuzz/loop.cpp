#include "loop.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "error.h"
#include "memory.h"

namespace vkvol::fuzz {

namespace {

using Clock = std::chrono::steady_clock;
// Seconds that an input may take, of processor time, so that a busy machine makes no findings, and by the clock, since
// what waits for ever takes no time.
#if defined(__SANITIZE_ADDRESS__)
constexpr double patience = 30.0; // it is five times as slow
#else
constexpr double patience = 5.0;
#endif
constexpr double long_patience = 120.0;
constexpr int finding_status = 86; // of a worker that met a broken promise

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

double cpu_seconds(clockid_t clock) {
    timespec t{};
    clock_gettime(clock, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// What worker and watchdog both see.
struct Shared {
    std::atomic<std::uint64_t> next;     // the input at work
    std::atomic<std::uint64_t> finished; // inputs, by this worker and those before it
    std::atomic<std::uint64_t> accepted; // of them: read without an error
    std::atomic<bool> ready;             // the corpus is made
    double slowest;
    std::uint64_t slowest_input, peak_bytes;
    char reason[2000];
};

void check_message(const std::string& message) {
    expect(!message.empty() && message.size() <= 4000, "an error message is empty or longer than 4000 bytes");
    for (const char c : message)
        expect(static_cast<unsigned char>(c) >= 0x20 && c != 0x7f, "an error message holds control characters");
}

// True if the input was read without an error.
bool use(Target& target, const std::string& input, Random& random) {
    begin_counting((target.mebibytes << 20) + target.times * input.size());
    bool accepted = false;
    try {
        target.use(input, random);
        accepted = true;
    } catch (const InputError& error) {
        end_counting();
        check_message(error.what());
    }
    end_counting();
    if (refused_bytes() > 0)
        throw Finding(fmt::format("allocates more than {} MiB + {} times the input's {} bytes: {} bytes at once",
                                  target.mebibytes, target.times, input.size(), refused_bytes()));
    return accepted;
}

[[noreturn]] void work(Target& target, const Range& range, const std::filesystem::path& directory, Shared& shared) {
    // What is printed on standard output (vkvol info) is part of what is tested, not of what is shown.
    if (!std::freopen("/dev/null", "w", stdout))
        _exit(1);
    target.prepare(directory);
    shared.ready = true;
    for (std::uint64_t k = shared.next; k < range.first + range.runs; shared.next = ++k) {
        Random random(target.name, range.seed, k);
        const std::string input = target.make(random);
        const double start = cpu_seconds(CLOCK_PROCESS_CPUTIME_ID);
        try {
            shared.accepted += use(target, input, random);
        } catch (const std::exception& error) {
            end_counting();
            std::snprintf(shared.reason, sizeof shared.reason, "%s", error.what());
            _exit(finding_status);
        }
        if (const double seconds = cpu_seconds(CLOCK_PROCESS_CPUTIME_ID) - start; seconds > shared.slowest) {
            shared.slowest = seconds;
            shared.slowest_input = k;
        }
        shared.peak_bytes = std::max(shared.peak_bytes, peak_bytes());
        ++shared.finished;
    }
    _exit(0);
}

// Waits for the worker; empty if it came to its end, else what went wrong with the input at work.
std::string watch(pid_t worker, Shared& shared) {
    std::uint64_t last = shared.next;
    Clock::time_point since = Clock::now();
    clockid_t clock{};
    clock_getcpuclockid(worker, &clock);
    double cpu_since = 0.0;
    for (;;) {
        int status = 0;
        if (waitpid(worker, &status, WNOHANG) == worker) {
            if (WIFEXITED(status) && WEXITSTATUS(status) == 0)
                return "";
            if (WIFEXITED(status) && WEXITSTATUS(status) == finding_status)
                return shared.reason;
            return WIFSIGNALED(status)
                       ? fmt::format("killed by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)))
                       : fmt::format("ended with status {}", WEXITSTATUS(status));
        }
        if (const std::uint64_t now = shared.next; now != last || !shared.ready) {
            last = now;
            since = Clock::now();
            cpu_since = cpu_seconds(clock);
        } else if (cpu_seconds(clock) - cpu_since > patience || seconds_since(since) > long_patience) {
            kill(worker, SIGKILL);
            waitpid(worker, &status, 0);
            return fmt::format("takes more than {} seconds of processor time, or {} in all", patience, long_patience);
        }
        usleep(20'000);
    }
}

// In a process of its own as well: making an input may start threads, which a fork must not follow.
void save_input(Target& target, const Range& range, std::uint64_t k, const std::filesystem::path& directory,
                const std::filesystem::path& file) {
    const pid_t child = fork();
    if (child == 0) {
        target.prepare(directory);
        Random random(target.name, range.seed, k);
        write_file(file, target.make(random));
        _exit(0);
    }
    waitpid(child, nullptr, 0);
}

// Removed with all that is in it. Three folders deep: what inputs call "../../density_fields" is to be here, and not
// there by chance.
struct Scratch {
    std::filesystem::path own =
        std::filesystem::temp_directory_path() / fmt::format("vkvol_fuzz_{}", static_cast<long>(getpid()));
    std::filesystem::path path = own / "inputs" / "scenes";
    Scratch() { std::filesystem::create_directories(path); }
    ~Scratch() {
        std::error_code ignored;
        std::filesystem::remove_all(own, ignored);
    }
};

} // namespace

Tally run_inputs(Target& target, const Range& range, const std::filesystem::path& out) {
    const Scratch scratch;
    void* memory = mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED)
        throw std::runtime_error("no shared memory");
    Shared& shared = *new (memory) Shared{};
    shared.next = range.first;
    const Clock::time_point start = Clock::now();
    Tally tally;
    while (shared.next < range.first + range.runs) {
        shared.ready = false;
        const pid_t worker = fork();
        if (worker == 0)
            work(target, range, scratch.path, shared);
        const std::string wrong = watch(worker, shared);
        if (wrong.empty())
            break;
        if (!shared.ready)
            throw std::runtime_error("the corpus cannot be made: " + wrong);
        const std::uint64_t k = shared.next++;
        const std::filesystem::path file =
            out / fmt::format("finding-{}-{}-{}{}", target.name, range.seed, k, target.extension);
        save_input(target, range, k, scratch.path, file);
        fmt::print(stderr, "finding: {}\n  input  {}\n  replay vkvol_fuzz {} --seed {} --only {}\n", wrong,
                   file.string(), target.name, range.seed, k);
        ++tally.findings;
        ++shared.finished;
    }
    tally.seconds = seconds_since(start);
    tally.runs = shared.finished;
    tally.accepted = shared.accepted;
    tally.slowest = shared.slowest;
    tally.slowest_input = shared.slowest_input;
    tally.peak_bytes = shared.peak_bytes;
    munmap(memory, sizeof(Shared));
    return tally;
}

} // namespace vkvol::fuzz
