#include "method.h"

#include <algorithm>
#include <fmt/format.h>

#include "density_field.h"
#include "error.h"
#include "estimator_traits.h"
#include "integrators.h"
#include "method_biases.h"
#include "particle_scenes.h"
#include "preset.h"
#include "scene_facts.h"
#include "shared/constants.h"
#include "surface_lamps.h"

namespace vkvol {

bool Method::flights_have(int traits) const {
    return flight_has(free_flight, traits);
}

bool Method::shadow_rays_have(int traits) const {
    return nee != NEE_NONE && transmittance_has(transmittance, traits);
}

bool Method::uses_lights() const {
    return nee != NEE_NONE || paths != PATHS_CAMERA;
}

namespace {

constexpr const char* no_polynomials = "where values are mapped, densities between voxels are no polynomials; with the "
                                       "filter nearest regular ones serve";

// One method in the making: each rule builds on those before.
class MethodChooser {
public:
    MethodChooser(const Scene& scene, int field, bool chromatic_extinction, bool emits)
        : scene_(scene), choices_(scene.settings.choices), preset_(choose_integrator(scene)), field_(field),
          chromatic_(chromatic_extinction), emits_(emits) {}

    Method choose();

private:
    void choose_paths();
    void choose_scattering();
    void choose_flight();
    const char* without_voxels() const;
    bool bends_voxels() const;
    // Optical depths are closed forms: of one density, or of one that falls exponentially.
    bool is_closed() const { return field_ == FIELD_CONSTANT || (field_ == FIELD_LAYERS && fades(scene_)); }
    bool has_no_end() const { return any_medium(scene_, is_everywhere); }
    void choose_nee();
    void choose_mis();
    void choose_distance();
    void choose_transmittance();
    void choose_first_flight();
    bool glows_evenly() const;
    bool gains_by_closed_glow() const;
    bool splits_at_once() const;
    void choose_emission();
    void choose_filter();
    void check_channels() const;
    void warn(const std::string& message) { method_.warnings.push_back(method_.integrator + ": " + message); }

    const Scene& scene_;
    const AxisChoices& choices_;
    const Integrator& preset_;
    const int field_;
    const bool chromatic_, emits_;
    Method method_{};
};

Method MethodChooser::choose() {
    method_.integrator = integrator_text({preset_.name, choices_});
    method_.jitter = scene_.settings.march.jitter && !(preset_.adjustments & adjust_no_jitter);
    choose_paths();
    choose_scattering();
    choose_flight();
    choose_nee();
    choose_mis();
    choose_distance();
    choose_transmittance();
    choose_first_flight();
    choose_emission();
    choose_filter();
    check_channels();
    find_biases(scene_, field_, method_);
    method_.material_colour = (preset_.adjustments & adjust_material_colour) && method_.scattering == SCATTERING_NONE;
    return method_;
}

void MethodChooser::choose_paths() {
    method_.paths = choices_.paths.value_or(preset_.paths);
    // Surfaces of any shape are for paths to find.
    if (method_.paths == PATHS_BOTH && std::all_of(scene_.lights.begin(), scene_.lights.end(), is_met_on_the_way)) {
        warn("paths are from the camera: without lights other than meshes there are no particles");
        method_.paths = PATHS_CAMERA;
    }
    const bool for_particles = scene_.camera.projection == Projection::absorption;
    if (method_.paths == PATHS_CAMERA && for_particles)
        throw InputError(
            fmt::format("{}: what media absorb is read where particles leave it; take integrator lightTracing",
                        method_.integrator));
    if (method_.paths == PATHS_CAMERA)
        return;
    if (const char* why = why_no_particles(scene_, method_.paths == PATHS_BOTH, emits_))
        throw InputError(fmt::format("{}: {}{}", method_.integrator, why,
                                     for_particles ? "" : "; integrator ratioTracking renders it"));
}

void MethodChooser::choose_scattering() {
    method_.scattering = scattering_of(scene_.settings, preset_);
    if (method_.paths != PATHS_CAMERA && method_.scattering != SCATTERING_MULTIPLE) {
        warn("scattering is multiple, as particles have it");
        method_.scattering = SCATTERING_MULTIPLE;
    }
}

void MethodChooser::choose_flight() {
    int& flight = method_.free_flight;
    flight = choices_.free_flight.value_or(preset_.free_flight);
    if (is_closed()) {
        const bool explicitly = choices_.free_flight.has_value();
        if (flight_has(flight, TRAIT_VOXELS) || (flight_has(flight, TRAIT_NULL) && !explicitly))
            flight = FREE_FLIGHT_ANALYTIC;
    } else if (flight_has(flight, TRAIT_CLOSED)) {
        throw InputError(fmt::format("{}: analytic flights need constant density, and this medium's varies; use "
                                     "flight delta, or integrator ratioTracking",
                                     method_.integrator));
    } else if (flight_has(flight, TRAIT_VOXELS) && field_ == FIELD_SUPERPOSITION) {
        warn("flights are delta: several volumes share no voxels");
        flight = FREE_FLIGHT_DELTA;
    } else if (flight_has(flight, TRAIT_VOXELS) && field_ != FIELD_GRID) {
        throw InputError(fmt::format("{}: regular flights go from voxel to voxel, and {}; use flight "
                                     "delta, or integrator ratioTracking",
                                     method_.integrator, without_voxels()));
    } else if (flight_has(flight, TRAIT_CONTROL) && field_ == FIELD_SUPERPOSITION) {
        warn("flights are delta: several volumes have no control density");
        flight = FREE_FLIGHT_DELTA;
    } else if (flight_has(flight, TRAIT_VOXELS) && bends_voxels()) {
        warn(fmt::format("flights are delta: {}", no_polynomials));
        flight = FREE_FLIGHT_DELTA;
    }
    if (has_no_end() && flight_has(flight, TRAIT_MARCH)) {
        warn("flights do not march: a march comes to no end of what is everywhere");
        flight = is_closed() ? FREE_FLIGHT_ANALYTIC : FREE_FLIGHT_DELTA;
    }
    if (!chromatic_ || !flight_has(flight, TRAIT_GREY))
        return;
    if (choices_.free_flight)
        warn("flights are spectral, since the extinction differs between the colour channels");
    flight = FREE_FLIGHT_SPECTRAL;
}

const char* MethodChooser::without_voxels() const {
    return field_ == FIELD_NOISE ? "noise has none" : "layers have none";
}

// A map of the values between voxels leaves no polynomial of them; of each voxel's own it leaves one.
bool MethodChooser::bends_voxels() const {
    return field_ != FIELD_CONSTANT && has_map(scene_) && scene_.settings.filter != Filter::nearest;
}

void MethodChooser::choose_nee() {
    int& nee = method_.nee;
    nee = choices_.nee.value_or(preset_.nee);
    if (method_.paths != PATHS_CAMERA) {
        nee = reads_flux(scene_.camera) ? NEE_NONE : NEE_COLLISIONS;
        if (choices_.nee.value_or(nee) != nee)
            warn(nee == NEE_NONE ? "nee is none: particles are counted where they pass"
                                 : "nee is at collisions: there particles look toward the camera");
        return;
    }
    const bool scatters =
        method_.scattering != SCATTERING_NONE && (!scene_.surfaces.empty() || any_medium(scene_, can_scatter));
    // The camera sees lamps by shadow rays, and a sensor of flux all lights, whether or not anything scatters.
    const bool looks_first =
        reads_flux(scene_.camera) || std::any_of(scene_.lights.begin(), scene_.lights.end(), is_lamp);
    if (scene_.lights.empty() || (!scatters && !looks_first)) {
        if (choices_.nee.value_or(NEE_NONE) != NEE_NONE)
            warn(scene_.lights.empty() ? "nee is without effect: the scene has no light"
                                       : "nee is without effect: nothing scatters");
        nee = NEE_NONE;
    } else if (!scatters) { // the camera's looks are all there are
        const bool has_steps = is_through(method_) && method_.scattering != SCATTERING_NONE;
        nee = nee == NEE_NONE ? NEE_NONE : has_steps ? NEE_TENTATIVE : NEE_COLLISIONS;
    } else if (is_through(method_)) {
        if (choices_.nee == NEE_COLLISIONS || choices_.nee == NEE_CACHED)
            warn("a march through the medium has no collisions; shadow rays start at every step");
        // A march with single scattering that sends no shadow rays would not scatter at all: only if told so.
        if (!choices_.nee || nee == NEE_COLLISIONS || nee == NEE_CACHED)
            nee = NEE_TENTATIVE;
    } else if (nee == NEE_TENTATIVE && !method_.flights_have(TRAIT_NULL)) {
        if (choices_.nee)
            warn("these flights have no null collisions; shadow rays start at real ones");
        nee = NEE_COLLISIONS;
    } else if (nee == NEE_CACHED && (is_closed() || sees_at_once(scene_) || !can_cache_light(scene_))) {
        if (!is_closed() && sees_at_once(scene_))
            warn("no transmittances are cached: through even spheres and boxes they are closed forms; shadow rays "
                 "start at "
                 "every collision");
        else if (choices_.nee)
            warn("a cache of transmittances is for grids, and for noise in spheres and boxes, without surfaces and "
                 "where "
                 "nothing repeats; shadow rays start at every collision");
        nee = NEE_COLLISIONS;
    }
}

void MethodChooser::choose_mis() {
    const std::vector<Light>& lights = scene_.lights;
    const bool scatters = method_.scattering != SCATTERING_NONE || reads_flux(scene_.camera);
    const bool met = scatters && std::any_of(lights.begin(), lights.end(), is_met_by_chance);
    const bool shared = method_.paths != PATHS_LIGHT && method_.nee != NEE_NONE &&
                        (met || std::any_of(lights.begin(), lights.end(), is_lamp) ||
                         std::any_of(lights.begin(), lights.end(), is_met_on_the_way));
    if (choices_.mis && !shared)
        warn("mis is without effect: no light is found in two ways");
    method_.mis = shared ? choices_.mis : std::nullopt;
}

// Looks from along a flight need to know where it is within the medium, of which a mesh, if it is alone, has many
// parts.
void MethodChooser::choose_distance() {
    const auto is_mesh = [](const Volume& volume) { return std::holds_alternative<MeshFiles>(volume.shape); };
    const bool could =
        method_.paths == PATHS_CAMERA && method_.nee != NEE_NONE && method_.scattering != SCATTERING_NONE &&
        (is_superposition(scene_) || !any_medium(scene_, is_mesh)) &&
        (has_lamps_of_surfaces(scene_) || std::any_of(scene_.lights.begin(), scene_.lights.end(), has_place));
    if (choices_.distance && !could)
        warn("distance is without effect: it is for lights that have a place, and not in models alone");
    method_.distance = could ? choices_.distance : DISTANCE_FLIGHTS;
}

void MethodChooser::choose_transmittance() {
    int& transmittance = method_.transmittance;
    transmittance = choices_.transmittance.value_or(preset_.transmittance);
    if (choices_.transmittance && method_.nee == NEE_NONE)
        warn("transmittance is without effect: there are no shadow rays");
    if (has_no_end() && transmittance_has(transmittance, TRAIT_MARCH)) {
        if (method_.nee != NEE_NONE)
            warn("shadow rays do not march: a march comes to no end of what is everywhere");
        transmittance = is_closed() ? TRANSMITTANCE_ANALYTIC : TRANSMITTANCE_RATIO;
    }
    if (is_closed() || sees_at_once(scene_)) {
        if (!choices_.transmittance || transmittance_has(transmittance, TRAIT_VOXELS))
            transmittance = TRANSMITTANCE_ANALYTIC;
        return;
    }
    if (transmittance_has(transmittance, TRAIT_CONTROL | TRAIT_VOXELS) && field_ == FIELD_SUPERPOSITION) {
        if (method_.nee != NEE_NONE)
            warn(transmittance_has(transmittance, TRAIT_VOXELS)
                     ? "transmittance is by ratio tracking: several volumes share no voxels"
                     : "transmittance is by ratio tracking: several volumes have no control density");
        transmittance = TRANSMITTANCE_RATIO;
    }
    if (transmittance_has(transmittance, TRAIT_VOXELS) && field_ == FIELD_GRID && bends_voxels()) {
        if (method_.nee != NEE_NONE)
            warn(fmt::format("transmittance is by ratio tracking: {}", no_polynomials));
        transmittance = TRANSMITTANCE_RATIO;
    }
    const bool impossible =
        transmittance_has(transmittance, field_ != FIELD_GRID ? TRAIT_CLOSED | TRAIT_VOXELS : TRAIT_CLOSED);
    if (!impossible)
        return;
    if (method_.nee == NEE_NONE) {
        transmittance = TRANSMITTANCE_RATIO; // unused
        return;
    }
    const std::string why =
        transmittance_has(transmittance, TRAIT_CLOSED)
            ? fmt::format(
                  "analytic transmittance needs constant density, or up to {} spheres and boxes of it, each taking "
                  "away as much of every colour, and here it varies otherwise",
                  MOST_EVEN_MEDIA)
            : fmt::format("regular transmittance goes from voxel to voxel, and {}", without_voxels());
    throw InputError(
        fmt::format("{}: {}; use transmittance ratio, or march with marched flights", method_.integrator, why));
}

// By the depth of all its way, which a model has in many parts, and different colours differently.
bool MethodChooser::splits_at_once() const {
    const Volume* volume = lone_volume(scene_);
    return volume && method_.free_flight == FREE_FLIGHT_ANALYTIC && !is_through(method_) && !chromatic_ && !emits_ &&
           !std::holds_alternative<MeshFiles>(volume->shape);
}

// A flight that is split goes through, past all tentative collisions: what tells the matter along it by these alone can
// be.
void MethodChooser::choose_first_flight() {
    const bool from_camera = method_.paths != PATHS_LIGHT && !reads_flux(scene_.camera);
    const bool could =
        from_camera && method_.nee != NEE_TENTATIVE && !scene_.periodic && !(emits_ && field_ == FIELD_SUPERPOSITION) &&
        scene_.settings.majorant_scale >= 1.0 && !has_no_end() && // whose outermost cells have none
        (method_.free_flight == FREE_FLIGHT_DELTA || method_.free_flight == FREE_FLIGHT_SPECTRAL || splits_at_once());
    if (choices_.first_flight == FIRST_FLIGHT_SPLIT && !could)
        warn("first flights are drawn: split ones are of cameras, by flight delta or spectral, or analytic in a sphere "
             "or box of one colour that does not glow, without shadow rays at null collisions; not in domains that "
             "repeat or media without end, where several volumes glow, or below densities' bounds");
    method_.first_flight = could ? choices_.first_flight : FIRST_FLIGHT_DRAWN;
}

// Then what a flight gathers of the glow is a closed form.
bool MethodChooser::glows_evenly() const {
    const Volume* volume = lone_volume(scene_);
    return volume && method_.flights_have(TRAIT_CLOSED) && !has_map(scene_) && volume->temperature.color == Rgb(0.0) &&
           volume->albedo_grid.empty();
}

// Before what is not nearly as bright. Before what is as bright as the glow, flights that find the one or the other
// have no noise.
bool MethodChooser::gains_by_closed_glow() const {
    const auto is_map = [](const Light& light) { return std::holds_alternative<SkyLight>(light); };
    if (!glows_evenly() || std::any_of(scene_.lights.begin(), scene_.lights.end(), is_map))
        return false;
    const Volume& volume = *lone_volume(scene_);
    const Rgb glow = volume.sigma_a * volume.Le, background = scene_.background * (volume.sigma_a + volume.sigma_s);
    return !glm::any(glm::greaterThan(background, 0.5 * glow));
}

void MethodChooser::choose_emission() {
    const int usual = gains_by_closed_glow() ? EMISSION_AT_STEPS : EMISSION_AT_COLLISIONS;
    method_.emission_at = emits_ ? choices_.emission.value_or(usual) : EMISSION_AT_COLLISIONS;
    if (method_.emission_at == EMISSION_AT_COLLISIONS)
        return;
    if (is_through(method_)) {
        method_.emission_at = EMISSION_AT_COLLISIONS; // the march adds it anyway
    } else if (chromatic_ && !method_.flights_have(TRAIT_NULL) && !glows_evenly()) {
        warn("emission is added at collisions: along these flights it would be biased, since the extinction differs "
             "between the colour channels; flight spectral adds it at steps");
        method_.emission_at = EMISSION_AT_COLLISIONS;
    }
}

// The stochastic filter is exact wherever the density enters linearly, which it does in null-collision estimators.
void MethodChooser::choose_filter() {
    const int transmittance = method_.transmittance;
    const bool linear_shadows = !method_.shadow_rays_have(TRAIT_VOXELS | TRAIT_MARCH);
    const bool linear = method_.flights_have(TRAIT_NULL) && linear_shadows && !has_map(scene_);
    const bool has_voxels = field_ == FIELD_GRID || field_ == FIELD_SUPERPOSITION;
    if (!has_voxels || linear) {
        method_.filter = scene_.settings.filter.value_or(Filter::stochastic);
        return;
    }
    method_.filter = scene_.settings.filter.value_or(Filter::trilinear);
    if (method_.filter != Filter::stochastic)
        return;
    const bool flight = !method_.flights_have(TRAIT_NULL);
    if (linear_shadows && !flight) {
        warn("the filter is trilinear: a map of values would be biased by a stochastic one, since the mean of what it "
             "makes of values is not what it makes of their mean");
        method_.filter = Filter::trilinear;
        return;
    }
    const std::string name = flight ? axes()[1].names[std::size_t(method_.free_flight)] + " flights"
                                    : axes()[2].names[std::size_t(transmittance)] + " transmittance";
    warn(fmt::format("the filter is trilinear: {} would be biased by a stochastic one, since the mean of an "
                     "exponential is not the exponential of the mean",
                     name));
    method_.filter = Filter::trilinear;
}

// Estimators that know the density they have passed take the channels' extinctions for proportional everywhere.
void MethodChooser::check_channels() const {
    const bool knows_depth =
        !method_.flights_have(TRAIT_NULL) || (method_.nee != NEE_NONE && !method_.shadow_rays_have(TRAIT_NULL));
    if (field_ == FIELD_SUPERPOSITION && chromatic_ && knows_depth)
        throw InputError(fmt::format("{}: in several volumes, of which some take away more of one colour than of "
                                     "another, light is followed by null collisions only; use integrator "
                                     "spectralTracking",
                                     method_.integrator));
}

} // namespace

bool is_through(const Method& method) {
    if (method.scattering == SCATTERING_NONE && method.flights_have(TRAIT_CLOSED))
        return true;
    return method.scattering != SCATTERING_MULTIPLE && method.flights_have(TRAIT_MARCH);
}

namespace {

// Analytic estimators are refused where the density varies. In a grid without voxels it does not; its file is opened
// in this case alone.
bool is_analytic_in_nothing(const Scene& scene) {
    if (density_kind(scene) != FIELD_GRID)
        return false;
    const AxisChoices& choices = scene.settings.choices;
    const Integrator& preset = choose_integrator(scene);
    const bool analytic = flight_has(choices.free_flight.value_or(preset.free_flight), TRAIT_CLOSED) ||
                          transmittance_has(choices.transmittance.value_or(preset.transmittance), TRAIT_CLOSED);
    return analytic && !any_medium(scene, [](const Volume& volume) {
               const auto* file = std::get_if<GridFile>(&volume.shape);
               return !file || !is_empty_grid(*file);
           });
}

} // namespace

Method choose_method(const Scene& scene) {
    int field = density_kind(scene);
    std::string unread; // why
    try {
        field = is_analytic_in_nothing(scene) ? FIELD_CONSTANT : field;
    } catch (const InputError& error) {
        unread = error.what();
    }
    try {
        return MethodChooser(scene, field, has_chromatic_extinction(scene), emits(scene)).choose();
    } catch (const InputError& error) {
        if (unread.empty())
            throw;
        throw InputError(fmt::format("{}; also, {}", error.what(), unread));
    }
}

} // namespace vkvol
