#include "integrators.h"

#include <algorithm>
#include <fmt/format.h>

#include "error.h"
#include "glow_lights.h"
#include "method.h"
#include "nearest_name.h"
#include "particle_scenes.h"
#include "scene_facts.h"
#include "shared/constants.h"
#include "surface_lamps.h"

namespace vkvol {

namespace {

using enum Integrator::Origin;

constexpr const char* step_bias = "takes the density of one point for that of a whole step";
constexpr const char* light_bias = "takes the light of one point for that of a whole step";

const std::vector<Integrator> table = {
    {"deltaTracking", SCATTERING_MULTIPLE, FREE_FLIGHT_DELTA, TRANSMITTANCE_RATIO, NEE_NONE, adjust_nothing,
     thesis_grids, "", "maxDepth, filter, majorant, russianRoulette",
     "analog multiple scattering, lit by the background and the medium alone", "Woodcock et al. 1965"},
    {"ratioTracking", SCATTERING_MULTIPLE, FREE_FLIGHT_DELTA, TRANSMITTANCE_RATIO, NEE_COLLISIONS, adjust_nothing,
     thesis_grids, "", "maxDepth, filter, majorant, russianRoulette",
     "analog multiple scattering with a ratio-tracked shadow ray from every collision", "Novak et al. 2014"},
    {"cachedRatioTracking", SCATTERING_MULTIPLE, FREE_FLIGHT_DELTA, TRANSMITTANCE_RATIO, NEE_CACHED, adjust_nothing,
     own, "", "maxDepth, filter, majorant, russianRoulette",
     "ratioTracking with few shadow rays: they correct, by chance, what a coarse table of transmittances says",
     "Novak et al. 2014; Glynn and Szechtman 2002"},
    {"ratioNEE", SCATTERING_MULTIPLE, FREE_FLIGHT_DELTA, TRANSMITTANCE_RATIO, NEE_TENTATIVE, adjust_nothing, own, "",
     "maxDepth, filter, majorant, russianRoulette",
     "ratioTracking with shadow rays from every tentative collision, null ones too: dearer, less noise in thin "
     "media",
     "Miller et al. 2019"},
    {"deltaTrackingNEE", SCATTERING_MULTIPLE, FREE_FLIGHT_DELTA, TRANSMITTANCE_DELTA, NEE_COLLISIONS, adjust_nothing,
     own, "", "maxDepth, filter, majorant, russianRoulette",
     "ratioTracking whose shadow rays pass or do not, by delta tracking: the noisiest", "Raab et al. 2008"},
    {"residualRatioTracking", SCATTERING_MULTIPLE, FREE_FLIGHT_DELTA, TRANSMITTANCE_RESIDUAL, NEE_COLLISIONS,
     adjust_nothing, own, "", "maxDepth, filter, majorant, russianRoulette",
     "ratioTracking whose shadow rays track only what differs from a control density per cell", "Novak et al. 2014"},
    {"weightedTracking", SCATTERING_MULTIPLE, FREE_FLIGHT_WEIGHTED, TRANSMITTANCE_RATIO, NEE_COLLISIONS, adjust_nothing,
     own, "", "maxDepth, filter, majorant, russianRoulette",
     "ratioTracking with weighted flights, unbiased even where the density exceeds the majorant",
     "Galtier et al. 2013"},
    {"decompositionTracking", SCATTERING_MULTIPLE, FREE_FLIGHT_DECOMPOSITION, TRANSMITTANCE_RESIDUAL, NEE_COLLISIONS,
     adjust_nothing, own, "", "maxDepth, filter, majorant, russianRoulette",
     "residualRatioTracking with flights that save look-ups by a control density per cell", "Kutz et al. 2017"},
    {"spectralTracking", SCATTERING_MULTIPLE, FREE_FLIGHT_SPECTRAL, TRANSMITTANCE_RATIO, NEE_COLLISIONS, adjust_nothing,
     own, "", "maxDepth, filter, majorant, russianRoulette",
     "ratioTracking with paths that carry all channels of a medium whose extinction differs between them",
     "Kutz et al. 2017"},
    {"unbiasedRayMarching", SCATTERING_MULTIPLE, FREE_FLIGHT_DELTA, TRANSMITTANCE_TELESCOPING, NEE_COLLISIONS,
     adjust_nothing, own, "", "maxDepth, filter, majorant, russianRoulette, march@shadowStep",
     "ratioTracking with marched shadow rays, their bias removed by a telescoping series of ever finer steps",
     "Misso et al. 2022"},
    {"regularTracking", SCATTERING_MULTIPLE, FREE_FLIGHT_REGULAR, TRANSMITTANCE_REGULAR, NEE_COLLISIONS, adjust_nothing,
     own, "", "maxDepth, filter, russianRoulette",
     "flights and shadow rays voxel by voxel, their optical depth exact: no null collisions", "Sutton et al. 1999"},
    {"rayMarching", SCATTERING_MULTIPLE, FREE_FLIGHT_MARCH, TRANSMITTANCE_MARCH, NEE_COLLISIONS, adjust_nothing, own,
     step_bias, "maxDepth, filter, russianRoulette, march",
     "multiple scattering with flights and shadow rays in equal steps", "Perlin and Hoffert 1989"},
    {"adaptiveRayMarching", SCATTERING_MULTIPLE, FREE_FLIGHT_ADAPTIVE, TRANSMITTANCE_MARCH, NEE_COLLISIONS,
     adjust_nothing, own, step_bias, "maxDepth, filter, majorant, russianRoulette, march",
     "rayMarching with flights in steps of equal optical depth of the majorant", "Perlin and Hoffert 1989"},
    {"densitySampling", SCATTERING_NONE, FREE_FLIGHT_ANALYTIC, TRANSMITTANCE_ANALYTIC, NEE_NONE,
     adjust_no_scattering | adjust_material_colour, thesis_models, "", "none",
     "homogeneous fog that absorbs (sigma_a) and glows in its model's colour; exact", "Luna 2024"},
    {"homogeneousRayMarcherNEE", SCATTERING_SINGLE, FREE_FLIGHT_MARCH, TRANSMITTANCE_ANALYTIC, NEE_TENTATIVE,
     adjust_no_jitter | adjust_isotropic, thesis_models, light_bias, "march@step",
     "single isotropic scattering in a homogeneous medium, sampled in the middle of equal steps", "Luna 2024"},
    {"homogeneousRayMarcherImproved", SCATTERING_SINGLE, FREE_FLIGHT_MARCH, TRANSMITTANCE_ANALYTIC, NEE_TENTATIVE,
     adjust_nothing, thesis_models, light_bias, "march@step, march@jitter",
     "single scattering in a homogeneous medium, sampled at random in equal steps", "Luna 2024"},
    {"heterogeneousPerlinNoise", SCATTERING_SINGLE, FREE_FLIGHT_MARCH, TRANSMITTANCE_MARCH, NEE_TENTATIVE,
     adjust_default_noise, thesis_models, step_bias, "march, noise",
     "single scattering in noise, flights and shadow rays in equal steps", "Luna 2024"},
    {"nanoVDBSimple", SCATTERING_SINGLE, FREE_FLIGHT_MARCH, TRANSMITTANCE_MARCH, NEE_TENTATIVE, adjust_no_emission,
     thesis_grids, step_bias, "march, filter",
     "single scattering in a grid, flights and shadow rays in equal steps; leaves emission out", "Luna 2024"},
    {"nanoVDBEmission", SCATTERING_SINGLE, FREE_FLIGHT_MARCH, TRANSMITTANCE_MARCH, NEE_TENTATIVE, adjust_nothing,
     thesis_grids, step_bias, "march, filter",
     "single scattering and emission in a grid, flights and shadow rays in equal steps", "Luna 2024"},
    {"lightTracing", SCATTERING_MULTIPLE, FREE_FLIGHT_DELTA, TRANSMITTANCE_RATIO, NEE_COLLISIONS, adjust_nothing, own,
     "", "maxDepth, filter, majorant, russianRoulette",
     "particles from the lights, whose vertices look toward the camera: for light that paths from there seldom find; "
     "without what smooth mirrors, coats and glass show",
     "Dutre et al. 1993", PATHS_LIGHT},
    {"bidirectional", SCATTERING_MULTIPLE, FREE_FLIGHT_DELTA, TRANSMITTANCE_RATIO, NEE_COLLISIONS, adjust_nothing, own,
     "", "maxDepth, filter, majorant, russianRoulette",
     "ratioTracking and lightTracing at once, weighted: small lights in the depths, and light through glass",
     "Veach and Guibas 1994", PATHS_BOTH},
};

} // namespace

const std::vector<Axis>& axes() {
    static const std::vector<Axis> table = {
        {"scattering", &AxisChoices::scattering, {"none", "single", "multiple"}},
        {"flight",
         &AxisChoices::free_flight,
         {"analytic", "regular", "march", "adaptive", "delta", "weighted", "decomposition", "spectral"}},
        {"transmittance",
         &AxisChoices::transmittance,
         {"analytic", "regular", "delta", "ratio", "residual", "march", "telescoping", "jackknife"}},
        {"nee", &AxisChoices::nee, {"none", "collisions", "tentative", "cached"}},
        {"emission", &AxisChoices::emission, {"collisions", "steps"}},
        {"mis", &AxisChoices::mis, {"balance", "power", "light", "phase"}},
        {"distance", &AxisChoices::distance, {"flights", "mixed"}},
        {"paths", &AxisChoices::paths, {"camera", "light", "both"}},
        {"firstFlight", &AxisChoices::first_flight, {"drawn", "split"}},
    };
    return table;
}

std::vector<std::string> axis_names() {
    std::vector<std::string> names;
    for (const Axis& axis : axes())
        names.push_back(axis.name);
    return names;
}

const Axis& find_axis(const std::string& name) {
    for (const Axis& axis : axes())
        if (name == axis.name)
            return axis;
    throw InputError(fmt::format("unknown axis '{}'{}", name, name_hint(name, axis_names())));
}

int find_choice(const Axis& axis, const std::string& name) {
    const auto found = std::find(axis.names.begin(), axis.names.end(), name);
    if (found == axis.names.end())
        throw InputError(fmt::format("unknown {} '{}'{}", axis.name, name, name_hint(name, axis.names)));
    return static_cast<int>(found - axis.names.begin());
}

const std::vector<Integrator>& integrators() {
    return table;
}

std::vector<std::string> integrator_names() {
    std::vector<std::string> names;
    for (const Integrator& integrator : integrators())
        names.push_back(integrator.name);
    return names;
}

const Integrator* find_integrator(const std::string& name) {
    for (const Integrator& integrator : integrators())
        if (name == integrator.name)
            return &integrator;
    return nullptr;
}

void check_integrator(const std::string& name) {
    if (!find_integrator(name))
        throw InputError(fmt::format("unknown integrator '{}'{}", name, name_hint(name, integrator_names())));
}

namespace {

// Towards a light that is near, transmittances are differences of what is cached, and take as long as shadow rays do:
// see tools/results/README.md.
bool gains_by_cache(const Scene& scene) {
    const auto is_cached = [](const Light& light) { return !is_met_on_the_way(light); };
    const auto is_near = [](const Light& light) { return place_of(light).has_value(); };
    return can_cache_light(scene) && !are_even_together(scene) &&
           std::any_of(scene.lights.begin(), scene.lights.end(), is_cached) &&
           std::none_of(scene.lights.begin(), scene.lights.end(), is_near);
}

} // namespace

const Integrator& choose_integrator(const Scene& scene) {
    const bool is_dark = scene.lights.empty() && !has_lamps_of_surfaces(scene) && !has_lights_of_glow(scene);
    const std::string name = !scene.settings.integrator.empty() ? scene.settings.integrator
                             : gains_by_particles(scene)        ? "lightTracing"
                             : is_dark                          ? "deltaTracking"
                             : !gains_by_cache(scene)           ? "ratioTracking"
                                                                : "cachedRatioTracking";
    check_integrator(name);
    return *find_integrator(name);
}

IntegratorRequest parse_integrator(const std::string& text) {
    IntegratorRequest request;
    std::size_t end = std::min(text.find(':'), text.size());
    request.name = text.substr(0, end);
    if (!request.name.empty())
        check_integrator(request.name);
    while (end < text.size()) {
        const std::size_t begin = end + 1;
        end = std::min(text.find(':', begin), text.size());
        const std::string part = text.substr(begin, end - begin);
        const std::size_t equals = part.find('=');
        if (equals == std::string::npos)
            throw InputError(
                fmt::format("'{}' is not of the form axis=choice; e.g. ratioTracking:flight=weighted", part));
        const std::string name = part.substr(0, equals);
        const Axis& axis = find_axis(name);
        std::optional<int>& choice = request.choices.*axis.choice;
        if (choice)
            throw InputError(fmt::format("{} given twice", axis.name));
        choice = find_choice(axis, part.substr(equals + 1));
    }
    return request;
}

std::string integrator_text(const IntegratorRequest& request) {
    std::string text = request.name;
    for (const Axis& axis : axes())
        if (const std::optional<int> choice = request.choices.*axis.choice)
            text += fmt::format(":{}={}", axis.name, axis.names.at(static_cast<std::size_t>(*choice)));
    return text;
}

} // namespace vkvol
