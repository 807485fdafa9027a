#include "memory_left.h"

#include <fstream>
#include <string>

namespace vkvol {

std::uint64_t memory_left() {
    std::ifstream lines("/proc/meminfo");
    std::string name;
    std::uint64_t kilobytes = 0;
    for (std::string unit; lines >> name >> kilobytes; std::getline(lines, unit))
        if (name == "MemAvailable:")
            return kilobytes * 1024;
    return 0;
}

} // namespace vkvol
