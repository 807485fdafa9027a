#include "kernel_constants.h"

#include <algorithm>
#include <bit>
#include <set>

#include "camera_view.h"
#include "estimator_traits.h"
#include "first_flights.h"
#include "layer_plan.h"
#include "light_table.h"
#include "medium_pieces.h"
#include "pixel_filter.h"
#include "placement.h"
#include "scene_facts.h"
#include "surface_table.h"

namespace vkvol {

Rgb albedo_of(const Volume& volume) {
    Rgb albedo(0.0);
    for (int i = 0; i < 3; ++i)
        if (volume.sigma_s[i] > 0.0)
            albedo[i] = volume.sigma_s[i] / (volume.sigma_a[i] + volume.sigma_s[i]);
    return albedo;
}

Rgb constant_emission(const Volume& volume, const LoadedMedium& loaded, const Method& method) {
    return method.material_colour && loaded.mesh && loaded.mesh->diffuse ? *loaded.mesh->diffuse : volume.Le;
}

namespace {

bool is_grey(const Rgb& albedo) {
    const double most = largest(albedo);
    return !glm::any(glm::greaterThan(Rgb(most) - albedo, Rgb(1e-9 * most)));
}

int shape_kind(const Volume& volume, const LoadedMedium& loaded) {
    if ((volume.sigma_a + volume.sigma_s) * volume.density_scale == Rgb(0.0))
        return SHAPE_NONE;
    if (std::holds_alternative<Sphere>(volume.shape))
        return SHAPE_SPHERE;
    if (std::holds_alternative<MeshFiles>(volume.shape))
        return SHAPE_MESH;
    const bool is_box = std::holds_alternative<Box>(volume.shape) || is_everywhere(volume);
    return loaded.field || is_box ? SHAPE_BOX : SHAPE_NONE;
}

int emission_kind(const Volume& volume, const LoadedMedium& loaded, const Method& method) {
    if (loaded.temperature)
        return volume.temperature.model == TemperatureEmission::Model::color ? EMISSION_COLOR : EMISSION_BLACKBODY;
    const Rgb glow = constant_emission(volume, loaded, method) + most_map_emission(volume);
    return most_sigma_a(volume) * glow != Rgb(0.0) ? EMISSION_CONSTANT : EMISSION_NONE;
}

int map_kind(const Volume& volume) {
    if (!volume.map.exists())
        return MAP_NONE;
    if (!volume.map.is_transfer)
        return MAP_DENSITY;
    return most_map_emission(volume) == Rgb(0.0) ? MAP_ALBEDO : MAP_GLOW;
}

int density_kind(const Volume& volume, const LoadedMedium& loaded) {
    return loaded.field ? FIELD_GRID : loaded.is_layered ? FIELD_LAYERS : volume.noise ? FIELD_NOISE : FIELD_CONSTANT;
}

} // namespace

bool is_chromatic(const Scene& scene) {
    return has_chromatic_extinction(scene) || !scene.surfaces.empty() || any_medium(scene, [](const Volume& volume) {
               return !volume.albedo_grid.empty() || !is_grey(albedo_of(volume)) ||
                      std::any_of(volume.map.points.begin(), volume.map.points.end(),
                                  [](const MapPoint& point) { return !is_grey(point.albedo); });
           });
}

static_assert(int(PhaseFunction::henyey_greenstein) == PHASE_HENYEY_GREENSTEIN &&
              int(PhaseFunction::rayleigh) == PHASE_RAYLEIGH &&
              int(PhaseFunction::double_henyey_greenstein) == PHASE_DOUBLE_HENYEY_GREENSTEIN &&
              int(PhaseFunction::draine) == PHASE_DRAINE && int(PhaseFunction::droplets) == PHASE_DROPLETS &&
              int(PhaseFunction::table) == PHASE_TABLE);

int phase_kind(PhaseFunction phase) {
    return phase == PhaseFunction::fournier_forand ? PHASE_TABLE : static_cast<int>(phase);
}

shared::MediumKinds kinds_of(const Volume& volume, const LoadedMedium& loaded, const Method& method) {
    shared::MediumKinds kinds{};
    kinds.shape = shape_kind(volume, loaded);
    kinds.field = density_kind(volume, loaded);
    kinds.grid_type = loaded.field ? loaded.field->type : GRID_FLOAT;
    kinds.phase = phase_kind(volume.phase);
    kinds.emission = kinds.shape != SHAPE_NONE ? emission_kind(volume, loaded, method) : EMISSION_NONE;
    kinds.temperature_type = loaded.temperature ? loaded.temperature->type : GRID_FLOAT;
    kinds.albedo = loaded.albedo ? ALBEDO_GRID : ALBEDO_CONSTANT;
    kinds.albedo_type = loaded.albedo ? loaded.albedo->type : GRID_FLOAT;
    kinds.map = loaded.field || loaded.is_layered ? map_kind(volume) : MAP_NONE;
    return kinds;
}

namespace {

// What kernels know of a medium.
void specialize_medium(const shared::MediumKinds& kinds, Specialization& constants) {
    constants[SPEC_PHASE] = kinds.phase;
    constants[SPEC_GRID_TYPE] = kinds.grid_type;
    constants[SPEC_TEMPERATURE_TYPE] = kinds.temperature_type;
    constants[SPEC_ALBEDO] = kinds.albedo;
    constants[SPEC_ALBEDO_TYPE] = kinds.albedo_type;
    constants[SPEC_EMISSION] = kinds.emission;
    constants[SPEC_MAP] = kinds.map;
}

// What kernels know of several media: what these have in common, else EACH.
void specialize_media(const Scene& scene, Media media, const Superposition& whole, const Method& method,
                      Specialization& constants) {
    constants[SPEC_LEAPS] = whole.cells.leaps ? 1 : 0;
    std::set<const std::byte*> grids;
    bool first = true, has_model = false;
    for (std::size_t i = 0; i < scene.volumes.size(); ++i) {
        const shared::MediumKinds kinds = kinds_of(scene.volumes[i], media[i], method);
        if (kinds.shape == SHAPE_NONE)
            continue;
        Specialization its = constants;
        specialize_medium(kinds, its);
        its[SPEC_MEMBER_SHAPE] = kinds.shape;
        its[SPEC_MEMBER_FIELD] = kinds.field;
        for (std::size_t k = 0; k < its.size(); ++k)
            constants[k] = first || its[k] == constants[k] ? its[k] : EACH;
        constants[SPEC_SHAPE] = SHAPE_BOX;
        has_model = has_model || kinds.shape == SHAPE_MESH;
        first = false;
        if (media[i].field)
            grids.insert(media[i].field->bytes.data());
    }
    constants[SPEC_MEMBER_GRID] = grids.size() > 1 ? EACH : 0;
    if (has_model && constants[SPEC_MEMBER_SHAPE] == EACH)
        constants[SPEC_MEMBER_SHAPE] = EACH_OR_MODEL;
    constants[SPEC_CELL_BITS] = whole.bits;
}

// Near enough that what it lights differs much from place to place, and where shadow rays cost next to nothing (in what
// is even, or falls exponentially with height) or, beside surfaces, the light is a point, about which there is no bound
// to that: elsewhere they take more time than they save, see tools/results/README.md.
bool gains_by_looks_along(const Scene& scene, Media media) {
    if (density_kind(scene) != FIELD_CONSTANT && !(scene.volumes.size() == 1 && fades(scene)) && !sees_at_once(scene))
        return false;
    constexpr double near = 0.1; // of the medium's diagonal
    for (std::size_t i = 0; i < scene.volumes.size(); ++i)
        for (const Light& light : scene.lights)
            if (const std::optional<glm::dvec3> place = place_of(light);
                place && (scene.surfaces.empty() || !is_lamp(light))) // surfaces of any shape have none
                if (distance_to(scene.volumes[i], media[i], *place) < near * diagonal_of(scene.volumes[i], media[i]))
                    return true;
    return false;
}

int sensor_kind(const Camera& camera) {
    switch (camera.projection) {
    case Projection::orthographic:
        return SENSOR_ORTHOGRAPHIC;
    case Projection::equirectangular:
        return SENSOR_EQUIRECTANGULAR;
    case Projection::irradiance:
        return SENSOR_IRRADIANCE;
    case Projection::fluence:
        return SENSOR_FLUENCE;
    case Projection::absorption:
        return SENSOR_ABSORPTION;
    case Projection::perspective:
        break;
    }
    return camera.lens.radius > 0.0 ? SENSOR_LENS : SENSOR_PINHOLE;
}

} // namespace

Specialization specialize(const Scene& scene, Media media, const Method& method, const Superposition* whole) {
    Specialization constants{}; // no medium, no emission
    const Volume* lone = whole ? nullptr : lone_volume(scene);
    if (whole) {
        specialize_media(scene, media, *whole, method, constants);
    } else if (lone) {
        const shared::MediumKinds kinds = kinds_of(*lone, media[0], method);
        specialize_medium(kinds, constants);
        constants[SPEC_SHAPE] = kinds.shape;
        constants[SPEC_LEAPS] = media[0].majorants && media[0].majorants->leaps ? 1 : 0;
    }
    for (const LoadedMedium& medium : media)
        if (!medium.map_knots.empty() && constants[SPEC_MAP] != MAP_NONE)
            constants[SPEC_MAP_HALVINGS] = std::bit_width(medium.map_knots.size()) - 1;
    const bool is_unbounded = lone ? is_everywhere(*lone) && has_matter(*lone, media[0]) : whole && whole->unbounded;
    constants[SPEC_UNBOUNDED] = is_unbounded ? 1 : 0;
    constants[SPEC_FIELD] = density_kind(scene);
    constants[SPEC_FILTER] = method.filter == Filter::nearest     ? FILTER_NEAREST
                             : method.filter == Filter::trilinear ? FILTER_TRILINEAR
                                                                  : FILTER_STOCHASTIC;
    constants[SPEC_SCATTERING] = method.scattering;
    constants[SPEC_NEE] = method.nee;
    constants[SPEC_EMISSION_AT] = method.emission_at;
    constants[SPEC_FREE_FLIGHT] = method.free_flight;
    const auto usual_flight = [&] {
        return gains_by_split_flights(scene, media) ? FIRST_FLIGHT_SPLIT : FIRST_FLIGHT_DRAWN;
    };
    constants[SPEC_FIRST_FLIGHT] = method.first_flight ? *method.first_flight : usual_flight();
    // Without shadow rays the choice is to leave no trace in the kernel.
    constants[SPEC_TRANSMITTANCE] = method.nee != NEE_NONE ? method.transmittance : TRANSMITTANCE_ANALYTIC;
    constants[SPEC_STEPS] = 1;
    // Without looks only what flights meet by themselves is seen.
    const int lights = lights_kind(scene);
    const int seen = method.nee == NEE_NONE && method.paths == PATHS_CAMERA ? lights & ~LIGHTS_LAMPS : lights;
    constants[SPEC_LIGHTS] = (seen & ~LIGHTS_SOLE) == LIGHTS_TABLE && method.nee == NEE_NONE ? LIGHTS_LONE : seen;
    constants[SPEC_PATHS] = method.paths;
    if (method.paths != PATHS_CAMERA) // whose looks go toward the sensor
        constants[SPEC_LIGHTS] |= LIGHTS_TABLE;
    constants[SPEC_PERIODIC] = scene.periodic ? 1 : 0;
    if (scene.periodic) // segments then have an end,
        constants[SPEC_LIGHTS] |= LIGHTS_TABLE;
    if (!scene.surfaces.empty()) { // and here
        constants[SPEC_LIGHTS] |= LIGHTS_TABLE;
        constants[SPEC_MATERIALS] = material_bits(scene.surfaces);
    }
    constants[SPEC_MIS] = method.mis.value_or(MIS_BALANCE);
    constants[SPEC_SENSOR] = sensor_kind(scene.camera);
    const bool is_plain = has_plain_pixels(scene.settings) || scene.camera.projection == Projection::absorption;
    constants[SPEC_PIXEL_FILTER] = is_plain                                          ? PIXEL_EVEN
                                   : scene.settings.pixel_filter == PixelFilter::box ? PIXEL_BOX
                                                                                     : PIXEL_QUANTILES;
    constants[SPEC_LAYERS] = plan_layers(scene).kinds;
    constants[SPEC_DISTANCE] =
        method.distance.value_or(gains_by_looks_along(scene, media) ? DISTANCE_MIXED : DISTANCE_FLIGHTS);
    return constants;
}

namespace {

// What kernels that are not compiled with FULL take for granted: see lib/specialization.glsl.
struct PlainValue {
    int constant;
    std::int32_t value;
};

constexpr PlainValue plain_values[] = {
    {SPEC_PHASE, PHASE_HENYEY_GREENSTEIN},
    {SPEC_LIGHTS, LIGHTS_LONE},
    {SPEC_DISTANCE, DISTANCE_FLIGHTS},
    {SPEC_ALBEDO, ALBEDO_CONSTANT},
    {SPEC_ALBEDO_TYPE, GRID_FLOAT},
    {SPEC_MAP, MAP_NONE},
    {SPEC_MAP_HALVINGS, 0},
    {SPEC_UNBOUNDED, 0},
    {SPEC_SENSOR, SENSOR_PINHOLE},
    {SPEC_PIXEL_FILTER, PIXEL_EVEN},
    {SPEC_LAYERS, 0},
    {SPEC_PATHS, PATHS_CAMERA},
    {SPEC_PERIODIC, 0},
};

} // namespace

bool needs_full(const Specialization& constants) {
    return constants[SPEC_FIELD] == FIELD_LAYERS || constants[SPEC_TEMPERATURE_TYPE] == GRID_COLOR ||
           std::any_of(std::begin(plain_values), std::end(plain_values),
                       [&](const PlainValue& plain) { return constants[plain.constant] != plain.value; });
}

bool shadow_rays_walk(const Specialization& constants, unsigned form) {
    return constants[SPEC_NEE] != NEE_NONE &&
           (!transmittance_has(constants[SPEC_TRANSMITTANCE], TRAIT_CLOSED) || constants[SPEC_SHAPE] == SHAPE_MESH ||
            constants[SPEC_PERIODIC] != 0 || (form & form_surfaces) != 0);
}

} // namespace vkvol
