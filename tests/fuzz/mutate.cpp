#include "mutate.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <limits>
#include <vector>

namespace vkvol::fuzz {

namespace {

constexpr std::array<std::uint64_t, 26> interesting_words = {
    0,          1,          2,          3,           7,          8,          16,         31,    32,
    64,         96,         127,        128,         255,        4095,       4096,       65535, 65536,
    0x7fffffff, 0x80000000, 0xffffffff, 0x100000000, 1ull << 40, 1ull << 62, ~0ull >> 1, ~0ull};

constexpr std::array<float, 10> interesting_floats = {0.0f,
                                                      -0.0f,
                                                      1.0f,
                                                      -1.0f,
                                                      1e-40f,
                                                      1e-30f,
                                                      1e30f,
                                                      3e38f,
                                                      std::numeric_limits<float>::infinity(),
                                                      std::numeric_limits<float>::quiet_NaN()};

template <class T> void put(std::span<std::byte> bytes, std::size_t at, T value) {
    std::memcpy(bytes.data() + at, &value, std::min(sizeof value, bytes.size() - at));
}

template <class T> T get(std::span<std::byte> bytes, std::size_t at) {
    T value{};
    std::memcpy(&value, bytes.data() + at, std::min(sizeof value, bytes.size() - at));
    return value;
}

void mutate_once(std::string& bytes, Random& random, const std::string& other) {
    if (bytes.empty()) {
        bytes = other.substr(0, random.below(64));
        return;
    }
    const std::size_t at = random.below(bytes.size());
    const std::size_t length = std::min<std::size_t>(1 + random.below(random.one_in(4) ? 256 : 8), bytes.size() - at);
    switch (random.below(9)) {
    case 0:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.below(8)));
        break;
    case 1:
        bytes[at] = static_cast<char>(random.next());
        break;
    case 2:
        bytes.insert(at, length, static_cast<char>(random.next()));
        break;
    case 3:
        bytes.erase(at, length);
        break;
    case 4:
        bytes.insert(at, bytes.substr(random.below(bytes.size()), length));
        break;
    case 5:
        if (!other.empty())
            bytes.replace(at, length, other, random.below(other.size()), length);
        break;
    case 6:
        if (random.one_in(4))
            bytes.resize(at);
        break;
    default:
        put_interesting(std::as_writable_bytes(std::span(bytes)), at, random);
    }
}

struct TokenRange {
    std::size_t begin, end;
};

bool in_token(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '-' || c == '+' || c == '_' || c == '$';
}

std::vector<TokenRange> tokens_of(const std::string& text) {
    std::vector<TokenRange> tokens;
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t begin = i;
        while (i < text.size() && in_token(text[i]))
            ++i;
        if (i > begin)
            tokens.push_back({begin, i});
        else
            ++i;
    }
    return tokens;
}

} // namespace

void put_interesting(std::span<std::byte> bytes, std::size_t at, Random& random) {
    switch (random.below(8)) {
    case 0:
        return put(bytes, at, static_cast<std::uint32_t>(random.pick(interesting_words)));
    case 1:
        return put(bytes, at, random.pick(interesting_words));
    case 2:
        return put(bytes, at, static_cast<std::uint64_t>(-static_cast<std::int64_t>(random.pick(interesting_words))));
    case 3:
        return put(bytes, at, random.pick(interesting_floats));
    case 4:
        return put(bytes, at, static_cast<double>(random.pick(interesting_floats)));
    case 5: // a little more or less
        return put(bytes, at, get<std::uint32_t>(bytes, at) + static_cast<std::uint32_t>(random.below(65)) - 32u);
    case 6: // an offset within the whole, aligned as nodes are
        return put(bytes, at,
                   static_cast<std::int64_t>(random.below(bytes.size())) / 32 * 32 * (random.one_in(2) ? 1 : -1));
    default:
        return put(bytes, at, static_cast<std::uint32_t>(random.next()));
    }
}

void mutate_bytes(std::string& bytes, Random& random, const std::string& other) {
    for (std::uint64_t n = 1 + random.below(random.one_in(4) ? 16 : 3); n > 0; --n)
        mutate_once(bytes, random, other);
}

void replace_token(std::string& text, Random& random, std::span<const char* const> values) {
    const std::vector<TokenRange> tokens = tokens_of(text);
    if (tokens.empty())
        return;
    const TokenRange token = random.pick(tokens);
    text.replace(token.begin, token.end - token.begin, random.pick(values));
}

void shuffle_lines(std::string& text, Random& random) {
    std::vector<std::string> lines;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
        lines.push_back(text.substr(begin, end - begin));
        begin = end;
    }
    if (lines.empty())
        return;
    const std::size_t a = random.below(lines.size()), b = random.below(lines.size());
    switch (random.below(3)) {
    case 0:
        lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(a));
        break;
    case 1:
        lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(b), std::string(lines[a]));
        break;
    default:
        std::swap(lines[a], lines[b]);
    }
    text.clear();
    for (const std::string& line : lines)
        text += line;
}

} // namespace vkvol::fuzz
