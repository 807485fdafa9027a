// A file that is whole or not there: it takes its name, and the place of the old file, when all of it is on the disk.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace vkvol {

class AtomicFile {
public:
    // Throws std::system_error if no file can be made in that place. A link stays a link: the file behind it is
    // replaced, by one that the same people may see. A device or pipe is written to, once all is there; of a pipe a
    // reader is waited for, until a signal comes.
    explicit AtomicFile(const std::filesystem::path& name);
    // Without put_in_place nothing of the new file is left.
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    // Does not throw, since it is called from libraries in C. Nothing more is written after a failure.
    bool write(const void* data, std::size_t size, std::int64_t at) noexcept;
    // Throws std::system_error with the reason of the first failure.
    void check() const;
    // The same, and if it cannot be done; the old file is then as it was.
    void put_in_place();

private:
    void open_new();
    void open_in_directory();
    void keep(const char* bytes, std::size_t size, std::size_t at) noexcept;
    void send_kept();
    void wait_for_reader();
    void give_name();

    std::filesystem::path target_, temporary_;
    bool special_ = false; // a device or pipe
    bool interrupted_before_ = false;
    bool named_ = false; // temporary_ is there
    int descriptor_ = -1;
    int error_ = 0;          // errno of the first write that failed
    std::vector<char> kept_; // of a special one, until it is whole
};

// Beside the target, so that it can be renamed, with the target's extension, which names the format. Another each time.
std::filesystem::path temporary_name(const std::filesystem::path& target);

// A device or pipe (/dev/stdout, say): written to, never replaced by a file.
bool is_special(const std::filesystem::path& name);

// By whatever name, through links too: what is said besides would be amid it.
bool is_standard_output(const std::filesystem::path& name);

// The file that a chain of links leads to, whether or not it is there, or the stream of this process; a name that is no
// link leads to itself.
std::filesystem::path behind_links(std::filesystem::path name);

} // namespace vkvol
