// A small generator whose numbers are the same everywhere: an input is known by its target, seed and number alone.
#pragma once

#include <cstdint>
#include <string_view>

namespace vkvol::fuzz {

// SplitMix64 (Steele, Lea, Flood, "Fast Splittable Pseudorandom Number Generators", 2014).
class Random {
public:
    explicit Random(std::uint64_t state) : state_(state) {}
    Random(std::string_view target, std::uint64_t seed, std::uint64_t input) : state_(seed) {
        for (const char c : target)
            state_ = next() ^ static_cast<unsigned char>(c);
        state_ = next() ^ input;
    }

    std::uint64_t next() {
        std::uint64_t z = state_ += 0x9E3779B97F4A7C15ull;
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
        return z ^ (z >> 31);
    }
    // In [0, n), n > 0.
    std::uint64_t below(std::uint64_t n) { return next() % n; }
    bool one_in(std::uint64_t n) { return below(n) == 0; }
    double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
    template <class List> const auto& pick(const List& list) { return list[below(std::size(list))]; }

private:
    std::uint64_t state_;
};

} // namespace vkvol::fuzz
