// The table of estimators.h, for the host.
#pragma once

#include "shared/estimators.h"

namespace vkvol {

// `trait`: TRAIT_...
constexpr bool flight_has(int free_flight, int trait) {
    return (FREE_FLIGHT_TRAITS(free_flight) & trait) != 0;
}
constexpr bool transmittance_has(int transmittance, int trait) {
    return (TRANSMITTANCE_TRAITS(transmittance) & trait) != 0;
}

} // namespace vkvol
