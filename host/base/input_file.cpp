#include "input_file.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <memory>
#include <poll.h>
#include <string_view>
#include <unistd.h>

#include "atomic_file.h"
#include "error.h"
#include "interrupt.h"

namespace vkvol {

namespace {

using std::filesystem::path;

std::string with_hint(const std::string& hint) {
    return hint.empty() ? "" : "; " + hint;
}

[[noreturn]] void fail_to_open(const path& file, int error, const std::string& hint) {
    switch (error) {
    case ENOENT:
    case ENOTDIR:
        throw InputError(fmt::format("{}: no such file{}", file.string(), with_hint(hint)));
    case EACCES:
    case EPERM:
        throw InputError(fmt::format("{}: cannot be opened: {}; check the permissions of the file and of the folders "
                                     "it lies in",
                                     file.string(), std::strerror(error)));
    case EMFILE:
    case ENFILE:
        throw InputError(fmt::format("{}: cannot be opened: {}; close some, or raise `ulimit -n`", file.string(),
                                     std::strerror(error)));
    default:
        throw InputError(fmt::format("{}: cannot be opened: {}", file.string(), std::strerror(error)));
    }
}

class Descriptor {
public:
    // O_NONBLOCK: to open a pipe without a writer would wait for one.
    Descriptor(const path& file, const std::string& hint)
        : number_(open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
        if (number_ < 0)
            fail_to_open(file, errno, hint);
    }
    ~Descriptor() { close(number_); }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    int number() const { return number_; }

private:
    int number_;
};

// Until there is something to read, or nobody left to write it.
void wait_for(int descriptor, const path& file) {
    constexpr int milliseconds = 100; // between two looks: a signal may come just before the wait
    pollfd wanted{descriptor, POLLIN, 0};
    while (!interrupted())
        if (poll(&wanted, 1, milliseconds) > 0)
            return;
    throw Interrupted(fmt::format("{}: interrupted while waiting for what comes through this pipe", file.string()));
}

} // namespace

void check_input_file(const path& file, const std::string& hint) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(file, error);
    if (std::filesystem::is_directory(status))
        throw InputError(fmt::format("{}: is a directory; name a file in it", file.string()));
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
        throw InputError(
            fmt::format("{}: is a pipe or device, and no regular file; copy what it gives into one", file.string()));
    const Descriptor test(file, hint);
}

void check_read_again(const path& file, const std::string& reader) {
    if (is_special(file))
        throw InputError(fmt::format("{}: a pipe is read once, but {}; write it to a file", file.string(), reader));
}

std::string read_input_text(const path& file, std::size_t longest, const std::string& hint) {
    const Descriptor descriptor(file, hint);
    std::error_code error;
    if (std::filesystem::is_directory(file, error))
        throw InputError(fmt::format("{}: is a directory; name a file in it", file.string()));
    const bool is_pipe = std::filesystem::is_fifo(file, error);
    std::string text;
    const auto buffer = std::make_unique<char[]>(1 << 16);
    while (text.size() <= longest) {
        if (is_pipe)
            wait_for(descriptor.number(), file);
        const ssize_t size = read(descriptor.number(), buffer.get(), 1 << 16);
        if (size == 0)
            break;
        if (size > 0)
            text.append(buffer.get(), static_cast<std::size_t>(size));
        else if (errno != EINTR && errno != EAGAIN)
            throw InputError(fmt::format("{}: cannot be read: {}", file.string(), std::strerror(errno)));
    }
    if (constexpr std::string_view mark = "\xef\xbb\xbf"; text.starts_with(mark)) // that it is UTF-8
        text.erase(0, mark.size());
    return text;
}

} // namespace vkvol
