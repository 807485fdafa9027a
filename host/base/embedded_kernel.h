#pragma once

#include <cstdint>

// The SPIR-V words of a kernel within this program; converts to a span. Its end is known when the program is linked.
struct EmbeddedKernel {
    const std::uint32_t* first;
    const std::uint32_t* last;
    const std::uint32_t* begin() const { return first; }
    const std::uint32_t* end() const { return last; }
};
