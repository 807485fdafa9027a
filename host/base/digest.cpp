#include "digest.h"

#include <algorithm>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <mutex>
#include <vector>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace vkvol {

struct Digest::State {
    XXH3_state_t xxh;
};

Digest::Digest() : state_(std::make_unique<State>()) {
    XXH3_64bits_reset(&state_->xxh);
}

Digest::~Digest() = default;

void Digest::add(std::span<const std::byte> bytes) {
    XXH3_64bits_update(&state_->xxh, bytes.data(), bytes.size());
}

std::uint64_t Digest::value() const {
    return XXH3_64bits_digest(&state_->xxh);
}

std::string Digest::text() const {
    return fmt::format("{:016x}", value());
}

std::string digest_text(std::string_view bytes) {
    return fmt::format("{:016x}", XXH3_64bits(bytes.data(), bytes.size()));
}

namespace {

constexpr std::uint64_t whole = 64u << 20, part = 64u << 10,
                        parts = 512; // bytes; a file's first and last are among them

std::string read_digest(const std::filesystem::path& file, std::uint64_t size) {
    std::ifstream stream(file, std::ios::binary);
    const std::uint64_t each = size > whole ? part : 1u << 20;
    const std::uint64_t count = size > whole ? parts : (size + each - 1) / each;
    std::vector<char> bytes(each);
    Digest digest;
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint64_t at = size > whole ? (size - part) * i / (parts - 1) : each * i;
        const std::uint64_t length = std::min(each, size - at);
        stream.seekg(static_cast<std::streamoff>(at));
        if (!stream.read(bytes.data(), static_cast<std::streamsize>(length)))
            return "";
        digest.add(std::as_bytes(std::span(bytes.data(), length)));
    }
    return digest.text();
}

} // namespace

std::string digest_of_file(const std::filesystem::path& file) {
    struct Known {
        std::uint64_t size;
        std::filesystem::file_time_type time;
        std::string text;
    };
    static std::map<std::filesystem::path, Known> all;
    static std::mutex mutex;
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error))
        return "";
    const std::filesystem::path name = std::filesystem::absolute(file, error);
    const std::uint64_t size = std::filesystem::file_size(file, error);
    const auto time = std::filesystem::last_write_time(file, error);
    if (error)
        return "";
    const std::scoped_lock lock(mutex);
    const auto known = all.find(name);
    if (known != all.end() && known->second.size == size && known->second.time == time)
        return known->second.text;
    return all.insert_or_assign(name, Known{size, time, read_digest(file, size)}).first->second.text;
}

} // namespace vkvol
