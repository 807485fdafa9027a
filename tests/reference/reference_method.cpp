#include "reference_method.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "cells.h"
#include "free_flight.h"
#include "shaders/shared/constants.h"

namespace reference {

using vkvol::Rgb;

namespace {

struct Preset {
    const char* name;
    int scattering, free_flight, transmittance, nee;
};

constexpr int none = SCATTERING_NONE, single = SCATTERING_SINGLE, multiple = SCATTERING_MULTIPLE;
constexpr std::array<Preset, 19> presets{{
    {"densitySampling", none, FREE_FLIGHT_ANALYTIC, TRANSMITTANCE_ANALYTIC, NEE_NONE},
    {"homogeneousRayMarcherNEE", single, FREE_FLIGHT_MARCH, TRANSMITTANCE_ANALYTIC, NEE_TENTATIVE},
    {"homogeneousRayMarcherImproved", single, FREE_FLIGHT_MARCH, TRANSMITTANCE_ANALYTIC, NEE_TENTATIVE},
    {"heterogeneousPerlinNoise", single, FREE_FLIGHT_MARCH, TRANSMITTANCE_MARCH, NEE_TENTATIVE},
    {"nanoVDBSimple", single, FREE_FLIGHT_MARCH, TRANSMITTANCE_MARCH, NEE_TENTATIVE},
    {"nanoVDBEmission", single, FREE_FLIGHT_MARCH, TRANSMITTANCE_MARCH, NEE_TENTATIVE},
    {"deltaTracking", multiple, FREE_FLIGHT_DELTA, TRANSMITTANCE_RATIO, NEE_NONE},
    {"ratioTracking", multiple, FREE_FLIGHT_DELTA, TRANSMITTANCE_RATIO, NEE_COLLISIONS},
    {"cachedRatioTracking", multiple, FREE_FLIGHT_DELTA, TRANSMITTANCE_RATIO, NEE_CACHED},
    {"ratioNEE", multiple, FREE_FLIGHT_DELTA, TRANSMITTANCE_RATIO, NEE_TENTATIVE},
    {"deltaTrackingNEE", multiple, FREE_FLIGHT_DELTA, TRANSMITTANCE_DELTA, NEE_COLLISIONS},
    {"regularTracking", multiple, FREE_FLIGHT_REGULAR, TRANSMITTANCE_REGULAR, NEE_COLLISIONS},
    {"rayMarching", multiple, FREE_FLIGHT_MARCH, TRANSMITTANCE_MARCH, NEE_COLLISIONS},
    {"adaptiveRayMarching", multiple, FREE_FLIGHT_ADAPTIVE, TRANSMITTANCE_MARCH, NEE_COLLISIONS},
    {"weightedTracking", multiple, FREE_FLIGHT_WEIGHTED, TRANSMITTANCE_RATIO, NEE_COLLISIONS},
    {"decompositionTracking", multiple, FREE_FLIGHT_DECOMPOSITION, TRANSMITTANCE_RESIDUAL, NEE_COLLISIONS},
    {"spectralTracking", multiple, FREE_FLIGHT_SPECTRAL, TRANSMITTANCE_RATIO, NEE_COLLISIONS},
    {"residualRatioTracking", multiple, FREE_FLIGHT_DELTA, TRANSMITTANCE_RESIDUAL, NEE_COLLISIONS},
    {"unbiasedRayMarching", multiple, FREE_FLIGHT_DELTA, TRANSMITTANCE_TELESCOPING, NEE_COLLISIONS},
}};

const Preset& find_preset(const std::string& name) {
    for (const Preset& preset : presets)
        if (name == preset.name)
            return preset;
    throw std::runtime_error("the reference knows no integrator " + name);
}

bool delta_like(int free_flight) {
    return !depth_sampled(free_flight);
}

void resolve_homogeneous(Method& method, const vkvol::AxisChoices& choices) {
    const bool to_analytic = delta_like(method.free_flight) && !choices.free_flight;
    if (to_analytic || method.free_flight == FREE_FLIGHT_REGULAR)
        method.free_flight = FREE_FLIGHT_ANALYTIC;
    if (!choices.transmittance || method.transmittance == TRANSMITTANCE_REGULAR)
        method.transmittance = TRANSMITTANCE_ANALYTIC;
}

void check(const Method& method, const Medium& medium) {
    const auto require = [](bool allowed, const char* why) {
        if (!allowed)
            throw std::runtime_error(why);
    };
    if (!medium.homogeneous() && !medium.fades()) {
        require(method.free_flight != FREE_FLIGHT_ANALYTIC, "analytic flights are for homogeneous media");
        require(method.transmittance != TRANSMITTANCE_ANALYTIC || method.nee == NEE_NONE,
                "analytic transmittance is for homogeneous media");
    }
    if (medium.noise) {
        require(method.free_flight != FREE_FLIGHT_REGULAR, "regular flights are for grids");
        require(method.transmittance != TRANSMITTANCE_REGULAR || method.nee == NEE_NONE,
                "regular transmittance is for grids");
    }
}

} // namespace

vkvol::Volume preset_volume(const std::string& integrator, vkvol::Volume volume) {
    if (integrator == "homogeneousRayMarcherNEE") {
        volume.g = 0.0;
        volume.phase = vkvol::PhaseFunction::henyey_greenstein;
    }
    if (integrator == "heterogeneousPerlinNoise" && !volume.noise)
        volume.noise = vkvol::Noise{};
    if (integrator == "nanoVDBSimple") {
        volume.Le = Rgb(0.0);
        volume.temperature.color = Rgb(0.0);
    }
    return volume;
}

Method resolve_method(const vkvol::Scene& scene, Medium& medium) {
    const vkvol::RenderSettings& settings = scene.settings;
    const vkvol::AxisChoices& choices = settings.choices;
    const bool cached = !scene.lights.empty() && !medium.homogeneous() && !medium.fades() && !medium.unbounded() &&
                        !medium.periodic && !std::holds_alternative<Mesh>(medium.shape);
    const bool far = std::none_of(scene.lights.begin(), scene.lights.end(), vkvol::has_place);
    const std::string best = scene.lights.empty() ? "deltaTracking"
                             : cached && far      ? "cachedRatioTracking"
                                                  : "ratioTracking";
    const Preset& preset = find_preset(settings.integrator.empty() ? best : settings.integrator);
    Method method{preset.name,
                  choices.scattering.value_or(preset.scattering),
                  choices.free_flight.value_or(preset.free_flight),
                  choices.transmittance.value_or(preset.transmittance),
                  choices.nee.value_or(preset.nee),
                  choices.emission.value_or(EMISSION_AT_COLLISIONS),
                  resolve_march(settings.march, medium)};
    if (method.name == "homogeneousRayMarcherNEE")
        method.march.jitter = false;
    if (const auto* mesh = std::get_if<Mesh>(&medium.shape);
        method.name == "densitySampling" && mesh && mesh->diffuse) {
        medium.emission.constant = *mesh->diffuse; // the surface's colour glows, and sigma_s = 0
        medium.sigma_t *= 1.0 - medium.albedo;
        medium.albedo = Rgb(0.0);
    }
    if (medium.homogeneous() || medium.fades())
        resolve_homogeneous(method, choices);
    if (!medium.grey() && (method.free_flight == FREE_FLIGHT_DELTA || method.free_flight == FREE_FLIGHT_WEIGHTED ||
                           method.free_flight == FREE_FLIGHT_DECOMPOSITION))
        method.free_flight = FREE_FLIGHT_SPECTRAL;
    const bool lamps = std::any_of(scene.lights.begin(), scene.lights.end(), vkvol::is_lamp);
    if (scene.lights.empty() || (method.scattering == SCATTERING_NONE && !lamps))
        method.nee = NEE_NONE;
    if (method.nee != NEE_NONE && method.scattering == SCATTERING_NONE)
        method.nee = NEE_COLLISIONS;
    if (method.nee == NEE_TENTATIVE && depth_sampled(method.free_flight))
        method.nee = NEE_COLLISIONS;
    if (method.nee == NEE_CACHED && !cached)
        method.nee = NEE_COLLISIONS;
    if (depth_sampled(method.free_flight) && !medium.grey())
        method.emission = EMISSION_AT_COLLISIONS;
    check(method, medium);
    return method;
}

} // namespace reference
