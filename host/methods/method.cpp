#include "method.h"

#include <algorithm>
#include <fmt/format.h>

#include "density_field.h"
#include "error.h"
#include "estimator_traits.h"
#include "integrators.h"
#include "particle_scenes.h"
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

bool has_map(const Scene& scene) {
    return any_medium(scene, [](const Volume& volume) { return volume.map.exists(); });
}

bool fades(const Scene& scene) {
    const Volume& volume = scene.volumes.front();
    return volume.layers && volume.layers->scale_height > 0.0;
}

// One method in the making: each rule builds on those before.
class Resolution {
public:
    Resolution(const Scene& scene, int field, bool chromatic_extinction, bool emits)
        : scene_(scene), choices_(scene.settings.choices), preset_(choose_integrator(scene)), field_(field),
          chromatic_(chromatic_extinction), emits_(emits) {}

    Method resolve();

private:
    template <class Is> bool any_surface(Is is) const {
        return std::any_of(scene_.surfaces.begin(), scene_.surfaces.end(), is);
    }
    bool has_thrown_light() const;
    bool is_thrown_from_afar() const;
    std::string who_finds_caustics() const;
    void find_chances();
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
    void choose_emission();
    void choose_filter();
    void check_channels() const;
    void find_biases();
    void warn(const std::string& message) { method_.warnings.push_back(method_.integrator + ": " + message); }

    const Scene& scene_;
    const AxisChoices& choices_;
    const Integrator& preset_;
    const int field_;
    const bool chromatic_, emits_;
    Method method_{};
};

Method Resolution::resolve() {
    method_.integrator = integrator_text({preset_.name, choices_});
    method_.jitter = scene_.settings.march.jitter && !(preset_.adjustments & adjust_no_jitter);
    choose_paths();
    choose_scattering();
    choose_flight();
    choose_nee();
    choose_mis();
    choose_distance();
    choose_transmittance();
    choose_emission();
    choose_filter();
    check_channels();
    find_biases();
    find_chances();
    method_.material_colour = (preset_.adjustments & adjust_material_colour) && method_.scattering == SCATTERING_NONE;
    return method_;
}

void Resolution::choose_paths() {
    method_.paths = choices_.paths.value_or(preset_.paths);
    if (method_.paths == PATHS_BOTH && scene_.lights.empty()) {
        warn("paths are from the camera: without lights there are no particles");
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

// Single scattering is one event, of which maxDepth allows none.
int scattering_of(const RenderSettings& settings, const Integrator& integrator) {
    const int scattering = settings.choices.scattering.value_or(integrator.scattering);
    return scattering == SCATTERING_SINGLE && settings.max_depth == 0u ? SCATTERING_NONE : scattering;
}

void Resolution::choose_scattering() {
    method_.scattering = scattering_of(scene_.settings, preset_);
    if (method_.paths != PATHS_CAMERA && method_.scattering != SCATTERING_MULTIPLE) {
        warn("scattering is multiple, as particles have it");
        method_.scattering = SCATTERING_MULTIPLE;
    }
}

void Resolution::choose_flight() {
    int& flight = method_.free_flight;
    flight = choices_.free_flight.value_or(preset_.free_flight);
    if (is_closed()) {
        const bool explicitly = choices_.free_flight.has_value();
        if (flight == FREE_FLIGHT_REGULAR || (flight_has(flight, TRAIT_NULL) && !explicitly))
            flight = FREE_FLIGHT_ANALYTIC;
    } else if (flight == FREE_FLIGHT_ANALYTIC) {
        throw InputError(fmt::format("{}: analytic flights need constant density, and this medium's varies; use "
                                     "flight delta, or integrator ratioTracking",
                                     method_.integrator));
    } else if (flight == FREE_FLIGHT_REGULAR && field_ != FIELD_GRID) {
        throw InputError(fmt::format("{}: regular flights go from voxel to voxel, and {}; use flight "
                                     "delta, or integrator ratioTracking",
                                     method_.integrator, without_voxels()));
    } else if (flight == FREE_FLIGHT_DECOMPOSITION && field_ == FIELD_SUPERPOSITION) {
        warn("flights are delta: several volumes have no control density");
        flight = FREE_FLIGHT_DELTA;
    } else if (flight == FREE_FLIGHT_REGULAR && bends_voxels()) {
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

const char* Resolution::without_voxels() const {
    return field_ == FIELD_NOISE    ? "noise has none"
           : field_ == FIELD_LAYERS ? "layers have none"
                                    : "several volumes share none";
}

// A map of the values between voxels leaves no polynomial of them; of each voxel's own it leaves one.
bool Resolution::bends_voxels() const {
    return field_ != FIELD_CONSTANT && has_map(scene_) && scene_.settings.filter != Filter::nearest;
}

void Resolution::choose_nee() {
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
    } else if (nee == NEE_CACHED && (is_closed() || !can_cache_light(scene_))) {
        if (choices_.nee)
            warn("a cache of transmittances is for grids, and for noise in spheres and boxes, without surfaces and "
                 "where "
                 "nothing repeats; shadow rays start at every collision");
        nee = NEE_COLLISIONS;
    }
}

void Resolution::choose_mis() {
    const std::vector<Light>& lights = scene_.lights;
    const bool looks_too = method_.scattering == SCATTERING_MULTIPLE || reads_flux(scene_.camera);
    const bool met = looks_too && std::any_of(lights.begin(), lights.end(), is_met_by_chance);
    const bool shared = method_.paths != PATHS_LIGHT && method_.nee != NEE_NONE &&
                        (met || std::any_of(lights.begin(), lights.end(), is_lamp));
    if (choices_.mis && !shared)
        warn("mis is without effect: no light is found in two ways");
    method_.mis = shared ? choices_.mis.value_or(MIS_BALANCE) : MIS_BALANCE;
}

// Looks from along a flight need to know where it is within the medium, of which a mesh has many parts.
void Resolution::choose_distance() {
    const auto is_mesh = [](const Volume& volume) { return std::holds_alternative<MeshFiles>(volume.shape); };
    const bool could =
        method_.paths == PATHS_CAMERA && method_.nee != NEE_NONE && method_.scattering != SCATTERING_NONE &&
        !any_medium(scene_, is_mesh) &&
        (has_lamps_of_surfaces(scene_) || std::any_of(scene_.lights.begin(), scene_.lights.end(), has_place));
    if (choices_.distance && !could)
        warn("distance is without effect: it is for point, spot, sphere, disk and rectangle lights, and not in models");
    method_.distance = could ? choices_.distance : DISTANCE_FLIGHTS;
}

void Resolution::choose_transmittance() {
    int& transmittance = method_.transmittance;
    transmittance = choices_.transmittance.value_or(preset_.transmittance);
    if (choices_.transmittance && method_.nee == NEE_NONE)
        warn("transmittance is without effect: there are no shadow rays");
    if (has_no_end() && transmittance_has(transmittance, TRAIT_MARCH)) {
        if (method_.nee != NEE_NONE)
            warn("shadow rays do not march: a march comes to no end of what is everywhere");
        transmittance = is_closed() ? TRANSMITTANCE_ANALYTIC : TRANSMITTANCE_RATIO;
    }
    if (is_closed()) {
        if (!choices_.transmittance || transmittance == TRANSMITTANCE_REGULAR)
            transmittance = TRANSMITTANCE_ANALYTIC;
        return;
    }
    if (transmittance == TRANSMITTANCE_RESIDUAL && field_ == FIELD_SUPERPOSITION) {
        if (method_.nee != NEE_NONE)
            warn("transmittance is by ratio tracking: several volumes have no control density");
        transmittance = TRANSMITTANCE_RATIO;
    }
    if (transmittance == TRANSMITTANCE_REGULAR && field_ == FIELD_GRID && bends_voxels()) {
        if (method_.nee != NEE_NONE)
            warn(fmt::format("transmittance is by ratio tracking: {}", no_polynomials));
        transmittance = TRANSMITTANCE_RATIO;
    }
    const bool impossible =
        transmittance == TRANSMITTANCE_ANALYTIC || (transmittance == TRANSMITTANCE_REGULAR && field_ != FIELD_GRID);
    if (!impossible)
        return;
    if (method_.nee == NEE_NONE) {
        transmittance = TRANSMITTANCE_RATIO; // unused
        return;
    }
    const std::string why =
        transmittance == TRANSMITTANCE_ANALYTIC
            ? "analytic transmittance needs constant density, and this medium's varies"
            : fmt::format("regular transmittance goes from voxel to voxel, and {}", without_voxels());
    throw InputError(
        fmt::format("{}: {}; use transmittance ratio, or march with marched flights", method_.integrator, why));
}

void Resolution::choose_emission() {
    method_.emission_at = emits_ ? choices_.emission.value_or(EMISSION_AT_COLLISIONS) : EMISSION_AT_COLLISIONS;
    if (method_.emission_at == EMISSION_AT_COLLISIONS)
        return;
    if (is_through(method_)) {
        method_.emission_at = EMISSION_AT_COLLISIONS; // the march adds it anyway
    } else if (chromatic_ && !method_.flights_have(TRAIT_NULL)) {
        warn("emission is added at collisions: along these flights it would be biased, since the extinction differs "
             "between the colour channels; flight spectral adds it at steps");
        method_.emission_at = EMISSION_AT_COLLISIONS;
    }
}

// The stochastic filter is exact wherever the density enters linearly, which it does in null-collision estimators.
void Resolution::choose_filter() {
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
void Resolution::check_channels() const {
    const bool knows_depth =
        !method_.flights_have(TRAIT_NULL) || (method_.nee != NEE_NONE && !method_.shadow_rays_have(TRAIT_NULL));
    if (field_ == FIELD_SUPERPOSITION && chromatic_ && knows_depth)
        throw InputError(fmt::format("{}: in several volumes, of which some take away more of one colour than of "
                                     "another, light is followed by null collisions only; use integrator "
                                     "spectralTracking",
                                     method_.integrator));
}

bool is_smooth(const Surface& surface) {
    return surface.material.kind != MaterialKind::diffuse && surface.material.roughness == 0.0;
}

bool is_clear(const Surface& surface) {
    return surface.material.kind == MaterialKind::thin_dielectric ||
           (surface.material.kind == MaterialKind::dielectric && is_smooth(surface));
}

// Whether there are caustics of lights that no path may meet.
bool Resolution::has_thrown_light() const {
    const auto has_no_extent = [](const Light& light) { return !is_lamp(light) && !is_met_by_chance(light); };
    return method_.scattering == SCATTERING_MULTIPLE && method_.nee != NEE_NONE && any_surface(is_smooth) &&
           std::any_of(scene_.lights.begin(), scene_.lights.end(), has_no_extent);
}

// Whether some of them are of light that particles do not bring.
bool Resolution::is_thrown_from_afar() const {
    const auto is_directional = [](const Light& light) { return std::holds_alternative<DirectionalLight>(light); };
    return !particles_come_from_afar(scene_) && std::any_of(scene_.lights.begin(), scene_.lights.end(), is_directional);
}

// Where particles can, to the end of what is missing.
std::string Resolution::who_finds_caustics() const {
    if (why_no_particles(scene_, true, false))
        return reads_flux(scene_.camera) && !why_no_particles(scene_, false, emits(scene_))
                   ? "; integrator lightTracing does"
                   : "";
    return is_thrown_from_afar() ? "; of points and spots integrator bidirectional does"
                                 : "; integrator bidirectional does";
}

void Resolution::find_chances() {
    const bool has_extent = std::any_of(scene_.lights.begin(), scene_.lights.end(),
                                        [](const Light& light) { return is_lamp(light) || is_met_by_chance(light); });
    const auto shines = [](const Surface& surface) { return surface.emission != Rgb(0.0); };
    std::vector<const char*> found;
    const bool by_particles = method_.paths == PATHS_BOTH && particles_come_from_afar(scene_);
    const bool both_can = !why_no_particles(scene_, true, false);
    if (method_.paths == PATHS_BOTH && !by_particles && any_surface(is_smooth) &&
        std::any_of(scene_.lights.begin(), scene_.lights.end(), is_met_by_chance))
        found.push_back("what smooth mirrors, coats and glass throw of suns and skies, from which particles come only "
                        "where neither a plane nor a medium is without end");
    if (method_.paths == PATHS_CAMERA && any_surface(is_smooth) && has_extent)
        found.push_back(!both_can ? "what smooth mirrors, coats and glass throw of lights"
                        : particles_come_from_afar(scene_)
                            ? "what smooth mirrors, coats and glass throw of lights, which integrator bidirectional "
                              "looks for"
                            : "what smooth mirrors, coats and glass throw of lights, which integrator bidirectional "
                              "looks for if they have a place");
    if (method_.paths != PATHS_LIGHT && any_surface(shines))
        found.push_back(
            "light of surfaces that no shadow ray looks for (meshes, boxes, planes, balls that shine inwards; all "
            "where there are more than 256, or in domains that repeat)");
    method_.by_chance = fmt::format("{}", fmt::join(found, "; "));
}

void Resolution::find_biases() {
    std::vector<std::string> reasons;
    const auto add = [&](Bias bias, const std::string& reason) {
        method_.biases |= bias;
        reasons.push_back(reason);
    };
    // At constant density a march knows its optical depths exactly, but not the light between its sample points.
    if (method_.flights_have(TRAIT_MARCH) && field_ != FIELD_CONSTANT)
        add(bias_flight_steps, "flights take the density of one point for that of a whole step");
    else if (method_.flights_have(TRAIT_MARCH) && is_through(method_) && method_.nee != NEE_NONE &&
             method_.scattering != SCATTERING_NONE)
        add(bias_flight_steps, "the march takes the light of one point for that of a whole step");
    if (method_.shadow_rays_have(TRAIT_MARCH) && method_.transmittance != TRANSMITTANCE_TELESCOPING &&
        field_ != FIELD_CONSTANT)
        add(bias_shadow_steps, "shadow rays take the density of one point for that of a whole step");
    // The other null-collision estimators weight what exceeds the majorant.
    const bool needs_majorant = method_.flights_have(TRAIT_BOUND) || method_.shadow_rays_have(TRAIT_BOUND);
    if (needs_majorant && scene_.settings.majorant_scale < 1.0)
        add(bias_majorant, "the majorant is scaled below the density");
    if (any_surface(is_smooth) && method_.paths == PATHS_LIGHT && !reads_flux(scene_.camera))
        add(bias_specular_view, "what smooth mirrors, coats and glass show is missing, which no particle finds");
    if (has_thrown_light() && method_.paths == PATHS_CAMERA) {
        if (any_surface(is_clear))
            warn("no path from the camera finds what directional lights, points and spots send through glass, which "
                 "casts their shadow" +
                 who_finds_caustics() + "; a sun, sphere, disk or rectangle shines through");
        add(bias_caustics, "what smooth mirrors, coats and glass throw of points, spots and directional lights is "
                           "missing, which no path from the camera finds" +
                               who_finds_caustics());
    } else if (has_thrown_light() && method_.paths == PATHS_BOTH) {
        if (is_thrown_from_afar())
            add(bias_caustics,
                "what smooth mirrors, coats and glass throw of directional lights is missing: from these "
                "particles come only where neither a plane nor a medium is without end");
        add(bias_caustics_in_mirrors,
            "what smooth mirrors, coats and glass throw of points, spots and directional lights and then "
            "show is missing, which neither particles nor paths from the camera find; lights with an "
            "extent have it");
    }
    method_.biased = fmt::format("{}", fmt::join(reasons, "; "));
}

} // namespace

bool is_through(const Method& method) {
    if (method.scattering == SCATTERING_NONE && method.free_flight == FREE_FLIGHT_ANALYTIC)
        return true;
    return method.scattering != SCATTERING_MULTIPLE && method.flights_have(TRAIT_MARCH);
}

bool can_scatter(const Volume& volume) {
    return volume.sigma_s * most_map_albedo(volume) != Rgb(0.0);
}

bool is_superposition(const Scene& scene) {
    return scene.volumes.size() > 1;
}

int density_kind(const Scene& scene) {
    if (is_superposition(scene))
        return FIELD_SUPERPOSITION;
    int kind = FIELD_CONSTANT;
    for (const Volume& volume : scene.volumes) {
        const bool is_grid = std::holds_alternative<GridFile>(volume.shape);
        kind = std::max(kind, is_grid         ? FIELD_GRID
                              : volume.layers ? FIELD_LAYERS
                              : volume.noise  ? FIELD_NOISE
                                              : FIELD_CONSTANT);
    }
    return kind;
}

bool can_cache_light(const Scene& scene) {
    const auto is_mesh = [](const Volume& volume) { return std::holds_alternative<MeshFiles>(volume.shape); };
    return !scene.lights.empty() && scene.surfaces.empty() && !scene.periodic &&
           density_kind(scene) != FIELD_CONSTANT && !any_medium(scene, is_mesh) && !any_medium(scene, is_everywhere);
}

bool has_chromatic_extinction(const Scene& scene) {
    return any_medium(scene, [](const Volume& volume) {
        const Rgb sigma_t = volume.sigma_a + volume.sigma_s;
        const double largest = std::max({sigma_t.x, sigma_t.y, sigma_t.z});
        const double smallest = std::min({sigma_t.x, sigma_t.y, sigma_t.z});
        return largest - smallest > 1e-9 * largest; // what sums of decimals differ by is rounding
    });
}

bool emits(const Scene& scene) {
    return any_medium(scene, [](const Volume& volume) {
        return most_sigma_a(volume) * (volume.Le + volume.temperature.color + most_map_emission(volume)) != Rgb(0.0);
    });
}

Method choose_method(const Scene& scene, int field, bool chromatic_extinction, bool emits) {
    return Resolution(scene, field, chromatic_extinction, emits).resolve();
}

namespace {

// Analytic estimators are refused where the density varies. In a grid without voxels it does not; its file is opened
// in this case alone.
bool is_analytic_in_nothing(const Scene& scene) {
    if (density_kind(scene) != FIELD_GRID)
        return false;
    const AxisChoices& choices = scene.settings.choices;
    const Integrator& preset = choose_integrator(scene);
    const bool analytic = choices.free_flight.value_or(preset.free_flight) == FREE_FLIGHT_ANALYTIC ||
                          choices.transmittance.value_or(preset.transmittance) == TRANSMITTANCE_ANALYTIC;
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
        return choose_method(scene, field, has_chromatic_extinction(scene), emits(scene));
    } catch (const InputError& error) {
        if (unread.empty())
            throw;
        throw InputError(fmt::format("{}; also, {}", error.what(), unread));
    }
}

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
    const bool looks = scene.settings.choices.nee.value_or(integrator.nee) != NEE_NONE;
    return looks && scattering_of(scene.settings, integrator) != SCATTERING_NONE
               ? with_lamps_of_surfaces(std::move(scene))
               : scene;
}

} // namespace vkvol
