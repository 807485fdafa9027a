// How much of what they could combine tests take.
#pragma once

#include <cstdlib>
#include <string>
#include <vector>

namespace vkvol {

// All of it: VKVOL_THOROUGH=1, as tools/validate.sh sets it. Else a share, and of another scene another: what tests
// cost is the compiling of kernels, of which nearly every combination has its own.
inline bool thorough() {
    const char* value = std::getenv("VKVOL_THOROUGH");
    return value && value == std::string("1");
}

// Every fourteenth time; of what is thorough, always.
inline bool has_its_turn() {
    static unsigned asked = 0;
    return asked++ % 14 == 0 || thorough();
}

// These, or the third of them whose turn it is, or another part.
template <class T> std::vector<T> in_turn(const std::vector<T>& all, std::size_t turn, std::size_t parts = 3) {
    std::vector<T> chosen;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (thorough() || i % parts == turn % parts)
            chosen.push_back(all[i]);
    return chosen;
}

} // namespace vkvol
