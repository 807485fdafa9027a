// How many lanes Mesa's software driver works with.
#pragma once

#include <string>

namespace vkvol {

// Sixteen where the processor has AVX-512, of which the driver by itself uses half: see tools/results/README.md. By the
// environment, which is the driver's only way to be told, and only what nobody has set there. Before there are threads.
void take_all_lanes();

// A device's name, alike for eight lanes and sixteen, which compute the same bits: what begins with one may go on with
// the other.
std::string name_by_bits(std::string device_name);

} // namespace vkvol
