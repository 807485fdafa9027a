#include "atomic_file.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <fcntl.h>
#include <fmt/format.h>
#include <new>
#include <optional>
#include <poll.h>
#include <random>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

#include "interrupt.h"

namespace vkvol {

namespace {

using std::filesystem::path;

[[noreturn]] void fail(int error) {
    throw std::system_error(error, std::generic_category());
}

// A stream of this process, even if it ends in a file: who sent it there wants it gone on with.
std::optional<int> stream_of(const path& target) {
    const std::string name = target.lexically_normal().string();
    if (name == "/dev/stdout" || name == "/dev/stderr")
        return name == "/dev/stdout" ? STDOUT_FILENO : STDERR_FILENO;
    for (const std::string folder : {"/dev/fd/", "/proc/self/fd/"})
        if (int number = -1; name.starts_with(folder)) {
            const auto [end, error] = std::from_chars(name.data() + folder.size(), name.data() + name.size(), number);
            if (error == std::errc() && end == name.data() + name.size())
                return number;
        }
    return std::nullopt;
}

// Behind what was written to it so far, and before what comes: where it stands is one with the stream's own place.
int open_stream(int stream) {
    std::fflush(nullptr);
    return fcntl(stream, F_DUPFD_CLOEXEC, 0);
}

// To open a pipe waits for its reader, and no signal would end that.
int open_special(const path& target) {
    constexpr int milliseconds = 50;
    constexpr int flags = O_WRONLY | O_CLOEXEC;
    if (const std::optional<int> stream = stream_of(target))
        return open_stream(*stream);
    std::error_code error;
    if (!std::filesystem::is_fifo(target, error))
        return open(target.c_str(), flags);
    while (true) {
        const int descriptor = open(target.c_str(), flags | O_NONBLOCK);
        if (descriptor >= 0 || errno != ENXIO)
            return descriptor;
        if (interrupted()) {
            errno = EINTR;
            return -1;
        }
        poll(nullptr, 0, milliseconds);
    }
}

path name_of(int descriptor) {
    return fmt::format("/proc/self/fd/{}", descriptor);
}

} // namespace

path behind_links(path name) {
    constexpr int most = 40; // as many as Linux follows
    std::error_code error;
    for (int i = 0; i < most && !stream_of(name) && std::filesystem::is_symlink(name, error); ++i) {
        const path next = name.parent_path() / std::filesystem::read_symlink(name, error);
        if (!std::filesystem::exists(std::filesystem::symlink_status(next, error)) &&
            std::filesystem::exists(name, error))
            break; // a pipe that another process has open: what its link says is no name
        name = next;
    }
    return name;
}

path temporary_name(const path& target) {
    constexpr std::size_t most_of_stem = 64; // file systems have names of 143 bytes at least
    std::random_device random;               // processes in containers may have the same number
    path name = target;
    name.replace_filename(fmt::format(".{}.{}-{:08x}{:08x}.tmp{}", target.stem().string().substr(0, most_of_stem),
                                      getpid(), random(), random(), target.extension().string()));
    return name;
}

bool is_standard_output(const path& name) {
    return stream_of(behind_links(name)) == STDOUT_FILENO;
}

bool is_special(const path& name) {
    const path target = behind_links(name);
    if (stream_of(target))
        return true;
    std::error_code ignored;
    const std::filesystem::file_status status = std::filesystem::status(target, ignored);
    return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
           !std::filesystem::is_directory(status);
}

AtomicFile::AtomicFile(const path& name)
    : target_(behind_links(name)), temporary_(temporary_name(target_)), special_(is_special(target_)),
      interrupted_before_(interrupted()) {
    if (special_)
        descriptor_ = open_special(target_);
    else
        open_new();
    if (descriptor_ < 0)
        fail(errno);
}

void AtomicFile::open_new() {
    open_in_directory();
    struct stat before {};
    if (descriptor_ < 0 || stat(target_.c_str(), &before) != 0)
        return;
    // Whoever may see what is there still may, and nobody else: if it cannot be given back, its group is another.
    const bool has_group = fchown(descriptor_, before.st_uid, before.st_gid) == 0 ||
                           fchown(descriptor_, static_cast<uid_t>(-1), before.st_gid) == 0;
    fchmod(descriptor_, before.st_mode & (has_group ? 0777 : 0707));
}

// Without a name, so that the file goes with the process, however that ends; with one where there is nothing better.
void AtomicFile::open_in_directory() {
    const path directory = target_.has_parent_path() ? target_.parent_path() : path(".");
    if (access("/proc/self/fd", X_OK) == 0)
        descriptor_ = open(directory.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
    if (descriptor_ >= 0)
        return;
    descriptor_ = open(temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    named_ = descriptor_ >= 0;
}

AtomicFile::~AtomicFile() {
    if (descriptor_ >= 0)
        close(descriptor_);
    if (named_)
        unlink(temporary_.c_str());
}

// What was interrupted before is written all the same, as long as it is read.
void AtomicFile::wait_for_reader() {
    constexpr int milliseconds = 100;
    pollfd wanted{descriptor_, POLLOUT, 0};
    if (poll(&wanted, 1, milliseconds) <= 0 && interrupted() && !interrupted_before_)
        error_ = EINTR;
}

// What is for a pipe is kept until it is whole: writers go back to fill in where things are.
bool AtomicFile::write(const void* data, std::size_t size, std::int64_t at) noexcept {
    const char* bytes = static_cast<const char*>(data);
    if (special_ && !error_)
        keep(bytes, size, static_cast<std::size_t>(at));
    while (size > 0 && !special_ && !error_) {
        const ssize_t written = pwrite(descriptor_, bytes, size, at);
        if (written < 0 && errno != EINTR)
            error_ = errno;
        else if (written > 0) {
            bytes += written;
            size -= static_cast<std::size_t>(written);
            at += written;
        }
    }
    return !error_;
}

void AtomicFile::keep(const char* bytes, std::size_t size, std::size_t at) noexcept {
    try {
        kept_.resize(std::max(kept_.size(), at + size));
        std::copy_n(bytes, size, kept_.begin() + static_cast<std::ptrdiff_t>(at));
    } catch (const std::bad_alloc&) {
        error_ = ENOMEM;
    }
}

void AtomicFile::send_kept() {
    for (std::size_t sent = 0; sent < kept_.size() && !error_;) {
        const ssize_t written = ::write(descriptor_, kept_.data() + sent, kept_.size() - sent);
        if (written < 0 && errno == EAGAIN)
            wait_for_reader();
        else if (written < 0 && errno != EINTR)
            error_ = errno;
        else if (written > 0)
            sent += static_cast<std::size_t>(written);
    }
}

// Some file systems know files without a name, but cannot give them one.
void AtomicFile::give_name() {
    if (linkat(AT_FDCWD, name_of(descriptor_).c_str(), AT_FDCWD, temporary_.c_str(), AT_SYMLINK_FOLLOW) == 0) {
        named_ = true;
        return;
    }
    named_ = true;
    std::filesystem::copy_file(name_of(descriptor_), temporary_);
    const int copy = open(temporary_.c_str(), O_RDONLY | O_CLOEXEC);
    const bool is_kept = copy >= 0 && fsync(copy) == 0;
    const int reason = errno;
    if (copy >= 0)
        close(copy);
    if (!is_kept)
        fail(reason);
}

void AtomicFile::check() const {
    if (error_)
        fail(error_);
}

void AtomicFile::put_in_place() {
    check();
    if (special_) {
        send_kept();
        check();
        return;
    }
    if (fsync(descriptor_) != 0) // else a power cut could leave the new name on no bytes
        fail(errno);
    if (!named_)
        give_name();
    if (rename(temporary_.c_str(), target_.c_str()) != 0)
        fail(errno);
    named_ = false;
}

} // namespace vkvol
