// Integrators by name: each is a preset of choices along the axes free flight, transmittance and next-event estimation.
#pragma once

#include <string>
#include <vector>

#include "scene.h"

namespace vkvol {

// One row per integrator; host, help and scene files all read this table.
struct Integrator {
    const char* name;
    int nee;           // NEE_...
    int free_flight;   // FREE_FLIGHT_... in a grid
    int transmittance; // TRANSMITTANCE_... in a grid
    const char* summary;
};

const std::vector<Integrator>& integrators();

// Null if there is none of that name.
const Integrator* find_integrator(const std::string& name);

// The scene's own, or, if it names none, the best unbiased choice: next-event estimation if there is a light to see.
// Throws InputError for an unknown name.
const Integrator& choose_integrator(const Scene& scene);

} // namespace vkvol
