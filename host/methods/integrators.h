// Integrators by name: each is a preset of choices along the axes scattering, free flight, transmittance and next-event
// estimation. Names of the choices and of the presets live here; method.h decides what they come to in a scene.
#pragma once

#include <string>
#include <vector>

#include "scene.h"
#include "shared/constants.h"

namespace vkvol {

// One axis of choice: its name, and the names of its choices in the order of their ids in shaders/shared/constants.h.
struct Axis {
    const char* name;
    std::optional<int> AxisChoices::*choice;
    std::vector<std::string> names;
};

const std::vector<Axis>& axes();
std::vector<std::string> axis_names();

// Throw InputError (without a place) with the nearest known name.
const Axis& find_axis(const std::string& name);
int find_choice(const Axis& axis, const std::string& name);

// What an integrator changes in the scene; sums of these.
enum Adjustment : unsigned {
    adjust_nothing = 0,
    adjust_no_jitter = 1,       // sample points in the middle of their steps
    adjust_isotropic = 2,       // g = 0
    adjust_no_scattering = 4,   // sigma_s = 0
    adjust_material_colour = 8, // the medium glows in the diffuse colour of the model's material
    adjust_default_noise = 16,  // the density is noise even if the scene names none
    adjust_no_emission = 32     // nothing glows
};

// One row per integrator; host, help and scene files all read this table.
struct Integrator {
    const char* name;
    int scattering;    // SCATTERING_...
    int free_flight;   // FREE_FLIGHT_...
    int transmittance; // TRANSMITTANCE_...
    int nee;           // NEE_...
    unsigned adjustments;
    enum class Origin { own, thesis_models, thesis_grids } origin; // of the name: new here, or the original's, for what
    const char* biased;     // why its mean differs from the exact one of its kind of scattering; empty: it does not
    const char* parameters; // scene elements that steer it, beyond medium, light and picture
    const char* summary;
    const char* source;
    int paths = PATHS_CAMERA; // PATHS_...
};

const std::vector<Integrator>& integrators();
std::vector<std::string> integrator_names();

// Null if there is none of that name.
const Integrator* find_integrator(const std::string& name);

// Throws InputError (its message has no place) unless `name` is one of integrator_names().
void check_integrator(const std::string& name);

// The scene's own, or, if it names none, the best unbiased choice: next-event estimation if there is a light to see, or
// particles where a sensor of flux has most of them.
// Throws InputError for an unknown name.
const Integrator& choose_integrator(const Scene& scene);

// An integrator with what is to differ from it, as on the command line: NAME:axis=choice:axis=choice. An empty NAME
// leaves the integrator to choose_integrator().
struct IntegratorRequest {
    std::string name;
    AxisChoices choices;
};

// Throws InputError (without a place).
IntegratorRequest parse_integrator(const std::string& text);
std::string integrator_text(const IntegratorRequest& request);

} // namespace vkvol
