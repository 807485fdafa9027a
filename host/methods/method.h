// From an integrator's name and the scene's own choices to the estimators that render it: what is meant, made possible.
#pragma once

#include <string>
#include <vector>

#include "scene.h"

namespace vkvol {

// Where the mean of many samples is not the exact value; sums of these. What they depend on is in the scene hash.
enum Bias : unsigned {
    bias_none = 0,
    bias_flight_steps = 1,         // depends on March::step or ::optical_step, and jitter
    bias_shadow_steps = 2,         // depends on March::shadow_step and jitter
    bias_majorant = 4,             // depends on RenderSettings::majorant_scale
    bias_specular_view = 8,        // what smooth mirrors, coats and glass show is missing
    bias_caustics = 16,            // what they throw of lights without extent is
    bias_caustics_in_mirrors = 32, // what they throw of these and show as well is
    bias_single_at_surfaces =
        64 // with single scattering, what they show and throw is, and light of what only paths meet
};

struct Method {
    int paths = 0;                   // PATHS_...
    int scattering = 0;              // SCATTERING_...
    int free_flight = 0;             // FREE_FLIGHT_...
    int transmittance = 0;           // TRANSMITTANCE_...; unused if nee is NEE_NONE
    int nee = 0;                     // NEE_...
    std::optional<int> mis;          // MIS_...; none: balance, but for even skies, see even_sky.h
    std::optional<int> first_flight; // FIRST_FLIGHT_...; none: kernel_constants.cpp chooses by how thin the media are
    std::optional<int> distance;     // DISTANCE_...; none: kernel_constants.cpp chooses by where the lights are
    int emission_at = 0; // EMISSION_AT_...; a march through the medium adds emission step by step in either case
    Filter filter = Filter::stochastic; // of grids
    bool jitter = true;
    bool material_colour = false;      // the mesh's diffuse colour, once loaded, takes the place of Volume::Le
    std::string integrator;            // name and explicit choices, as on the command line
    std::vector<std::string> warnings; // what was chosen explicitly and gave way, and light that is lost
    unsigned biases = bias_none;       // sum of Bias
    std::string biased;                // why, in words; empty if unbiased
    std::string by_chance;             // which light nothing but chance finds; empty: none

    // Any of `traits`, TRAIT_... of shaders/shared/estimators.h. Where no shadow rays are sent they have none.
    bool flights_have(int traits) const;
    bool shadow_rays_have(int traits) const;
    // Lights that flights do not meet by themselves.
    bool uses_lights() const;
};

// A march (or, without scattering, one analytic step) through the whole medium that samples no collision.
bool is_through(const Method& method);

// Expects the scene of with_preset(). Opens grid files where an analytic estimator is asked for, which is possible in
// an empty grid alone. Throws InputError, with the remedy, for what cannot be.
Method choose_method(const Scene& scene);

} // namespace vkvol
