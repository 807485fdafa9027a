#include "integrators.h"

#include <fmt/format.h>

#include "error.h"
#include "shared/bindings.h"

namespace vkvol {

const std::vector<Integrator>& integrators() {
    static const std::vector<Integrator> table = {
        {"deltaTracking", NEE_NONE, FREE_FLIGHT_DELTA, TRANSMITTANCE_RATIO,
         "analog multiple scattering, lit by the background alone; unbiased"},
        {"ratioTracking", NEE_COLLISIONS, FREE_FLIGHT_DELTA, TRANSMITTANCE_RATIO,
         "the same with a ratio-tracked shadow ray to the light at every collision; unbiased"},
    };
    return table;
}

const Integrator* find_integrator(const std::string& name) {
    for (const Integrator& integrator : integrators())
        if (name == integrator.name)
            return &integrator;
    return nullptr;
}

const Integrator& choose_integrator(const Scene& scene) {
    const std::string name = !scene.settings.integrator.empty() ? scene.settings.integrator
                             : scene.lights.empty()             ? "deltaTracking"
                                                                : "ratioTracking";
    const Integrator* integrator = find_integrator(name);
    if (!integrator)
        throw InputError(fmt::format("unknown integrator \"{}\"", name));
    return *integrator;
}

} // namespace vkvol
