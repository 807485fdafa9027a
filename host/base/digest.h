// Fingerprints of bytes, by which files, scenes and renders are told apart: equal by accident once in 10^19.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace vkvol {

// XXH3, 64 bit (xxhash.com): no defence against somebody who wants two to be equal.
class Digest {
public:
    Digest();
    ~Digest();
    void add(std::span<const std::byte> bytes);
    template <class T> void add_all(const T& values) { add(std::as_bytes(std::span(values))); }

    // Digest of all that was added so far.
    std::uint64_t value() const;
    std::string text() const; // 16 hexadecimal digits

private:
    struct State;
    std::unique_ptr<State> state_;
};

std::string digest_text(std::string_view bytes);

// Digest of a regular file: of all of it up to 64 MiB, of larger ones of parts evenly apart that come to half as much.
// Read once as long as its size and time are the same. Empty if it cannot be read.
std::string digest_of_file(const std::filesystem::path& file);

} // namespace vkvol
