// Damage that knows nothing of the format: bytes flipped, inserted, removed, exchanged.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "random.h"

namespace vkvol::fuzz {

// A few random changes; `other` is what parts are spliced in from.
void mutate_bytes(std::string& bytes, Random& random, const std::string& other);

// One value that is interesting as a count, an offset, a size, a float or a double, in place of 4 or 8 bytes at `at`,
// which must lie within `bytes`.
void put_interesting(std::span<std::byte> bytes, std::size_t at, Random& random);

// Replaces one number, name or quoted value of a text by one of `values`.
void replace_token(std::string& text, Random& random, std::span<const char* const> values);

// Removes, repeats or exchanges lines.
void shuffle_lines(std::string& text, Random& random);

} // namespace vkvol::fuzz
