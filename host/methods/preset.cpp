#include "preset.h"

#include <fmt/format.h>
#include <set>

#include "estimator_traits.h"
#include "glow_lights.h"
#include "scene_facts.h"
#include "shared/constants.h"
#include "surface_lamps.h"

namespace vkvol {

int scattering_of(const RenderSettings& settings, const Integrator& integrator) {
    const int scattering = settings.choices.scattering.value_or(integrator.scattering);
    return scattering == SCATTERING_SINGLE && settings.max_depth == 0u ? SCATTERING_NONE : scattering;
}

Scene with_steady_integrator(Scene scene) {
    if (!scene.motion_blur || !scene.settings.integrator.empty())
        return scene;
    std::set<std::string> names{choose_integrator(scene).name};
    for (const double time : telling_times(*scene.motion_blur))
        names.insert(choose_integrator(scene_of_time(scene, time)).name);
    // What is dark at these may be lit at others, and what is lit dark, where particles have nothing to begin with.
    const bool is_dark_at_times = names.erase("deltaTracking") > 0;
    const bool has_one = names.size() == 1 && !(is_dark_at_times && names.contains("lightTracing"));
    scene.settings.integrator = has_one ? *names.begin() : "ratioTracking";
    return scene;
}

namespace {

// Whether shadow rays of this kind go through all that there is, and have no bias, or would be refused.
bool sees_through(const Scene& scene, int transmittance) {
    if (scene.settings.choices.transmittance && sees_at_once(scene))
        return true;
    const int unfit = TRAIT_CLOSED | TRAIT_INEXACT | (has_chromatic_extinction(scene) ? TRAIT_MARCH : 0);
    return !is_superposition(scene) || !transmittance_has(transmittance, unfit);
}

} // namespace

Scene with_preset(Scene scene) {
    const Integrator& integrator = choose_integrator(scene);
    const auto adjusts = [&](Adjustment adjustment) { return (integrator.adjustments & adjustment) != 0; };
    const auto warn = [&](const char* message) {
        scene.warnings.push_back(fmt::format("{}: {}", integrator.name, message));
    };
    const int scattering = scene.settings.choices.scattering.value_or(integrator.scattering);
    const bool glows = emits(scene);
    for (Volume& volume : scene.volumes) {
        if (adjusts(adjust_no_scattering) && scattering == SCATTERING_NONE && !volume.map.is_transfer) // which has all
            volume.sigma_s = Rgb(0.0);
        if (adjusts(adjust_isotropic) && (volume.g != 0.0 || volume.phase != PhaseFunction::henyey_greenstein)) {
            warn("scatters isotropically and leaves heyneygreenstein_g and phase out; homogeneousRayMarcherImproved "
                 "honours them");
            volume.g = 0.0;
            volume.phase = PhaseFunction::henyey_greenstein;
        }
        if (adjusts(adjust_default_noise) && !volume.noise) {
            if (std::holds_alternative<GridFile>(volume.shape))
                warn("the density is the grid's, not noise, which fills spheres, boxes and models");
            else if (is_everywhere(volume) || volume.layers)
                warn("what is everywhere, or has layers, has no noise, which fills spheres, boxes and models");
            else
                volume.noise = Noise{};
        }
        if (adjusts(adjust_no_emission)) {
            volume.Le = volume.temperature.color = Rgb(0.0);
            for (MapPoint& point : volume.map.points)
                point.emission = Rgb(0.0);
        }
    }
    if (adjusts(adjust_no_emission) && glows)
        warn("leaves emission out; nanoVDBEmission renders it");
    // A march with single scattering looks for light unless told not to: see choose_nee.
    const AxisChoices& choices = scene.settings.choices;
    const int scatters = scattering_of(scene.settings, integrator);
    const bool marches = scatters == SCATTERING_SINGLE &&
                         flight_has(choices.free_flight.value_or(integrator.free_flight), TRAIT_MARCH) &&
                         !any_medium(scene, is_everywhere); // in which flights do not march
    const bool has_particles = choices.paths.value_or(integrator.paths) != PATHS_CAMERA; // which are looked at
    const bool looks = choices.nee ? *choices.nee != NEE_NONE : integrator.nee != NEE_NONE || marches || has_particles;
    const bool scatters_or_reads = scatters != SCATTERING_NONE || reads_flux(scene.camera);
    if (!looks || !scatters_or_reads)
        return scene;
    scene = with_lamps_of_surfaces(std::move(scene));
    const bool meets_glow = !has_particles && scatters != SCATTERING_SINGLE; // where it may be looked for as well
    const int transmittance = choices.transmittance.value_or(integrator.transmittance);
    return meets_glow && sees_through(scene, transmittance) ? with_lights_of_glow(std::move(scene)) : scene;
}

} // namespace vkvol
