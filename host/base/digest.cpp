#include "digest.h"

#include <fmt/format.h>

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

} // namespace vkvol
