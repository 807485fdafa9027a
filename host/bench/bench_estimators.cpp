#include "bench_estimators.h"

#include <algorithm>
#include <fmt/format.h>

#include "error.h"
#include "framing.h"
#include "glow_lights.h"
#include "integrators.h"
#include "preset.h"
#include "scene_facts.h"
#include "scene_hash.h"
#include "scene_xml.h"
#include "shared/estimators.h"
#include "surface_lamps.h"

namespace vkvol {

namespace {

Estimator load_estimator(const RenderRequest& request, const std::optional<std::string>& integrator) {
    Estimator estimator;
    estimator.scene = load_scene(request.scene, request.defines, {request.grid, integrator});
    estimator.scene.layers = 0; // of radiance alone
    resize_picture(estimator.scene, request.width, request.height);
    FieldCache fields;
    give_camera(estimator.scene, fields);
    estimator.method = choose_method(with_preset(estimator.scene));
    estimator.integrator = estimator.method.integrator;
    return estimator;
}

// What its integrator makes of a scene, for others: whether these look for what shines or glows is theirs to say.
Scene as_seen(const Scene& scene) {
    return without_lamps_of_surfaces(without_lights_of_glow(with_preset(scene)));
}

// The same light by other means: the scene as `of` sees it, rendered by `request`.
Estimator with_request(const Estimator& of, const IntegratorRequest& request) {
    Estimator estimator;
    estimator.scene = as_seen(of.scene);
    if (of.scene.motion_blur) { // at all times
        MotionBlur blur = *of.scene.motion_blur;
        blur.scene_at = [scene_at = blur.scene_at, settings = of.scene.settings](double time) {
            Scene then = scene_at(time);
            then.settings = asked_of(then.settings, settings);
            return as_seen(then);
        };
        estimator.scene.motion_blur = std::make_shared<const MotionBlur>(std::move(blur));
    }
    estimator.scene.settings.integrator = request.name;
    estimator.scene.settings.choices = request.choices;
    estimator.method = choose_method(with_preset(estimator.scene));
    estimator.integrator = estimator.method.integrator;
    return estimator;
}

// The preset with the scattering and the lights of `of`, and nothing said that it does by itself.
IntegratorRequest same_light(const Estimator& of, const Integrator& preset) {
    IntegratorRequest request{preset.name, {}};
    if (of.method.scattering != preset.scattering)
        request.choices.scattering = of.method.scattering;
    const bool sees_lights = of.method.uses_lights();
    if (!of.scene.lights.empty() && sees_lights != (preset.nee != NEE_NONE))
        request.choices.nee = sees_lights ? NEE_COLLISIONS : NEE_NONE;
    return request;
}

bool is_unbiased(const Estimator& estimator) {
    return (estimator.method.biases & ~bias_single_at_surfaces) == bias_none; // which all of one picture have
}

bool marches(const Method& method) {
    return method.flights_have(TRAIT_MARCH) || method.shadow_rays_have(TRAIT_MARCH);
}

// Whether two estimators of one picture have the same kernels and parameters. Choices that nothing in the scene asks
// about leave no trace there.
bool same_kernel(const Estimator& x, const Estimator& y) {
    const Method &a = x.method, &b = y.method;
    const bool same_shadows = a.nee == NEE_NONE || a.transmittance == b.transmittance;
    const bool same_filter = density_kind(x.scene) != FIELD_GRID || a.filter == b.filter;
    const bool same_steps = !marches(a) || a.jitter == b.jitter;
    return a.scattering == b.scattering && a.free_flight == b.free_flight && a.nee == b.nee && same_shadows &&
           a.emission_at == b.emission_at && a.mis == b.mis && a.distance == b.distance && a.paths == b.paths &&
           a.first_flight == b.first_flight && same_filter && same_steps && a.material_colour == b.material_colour;
}

Estimator* find_same(std::vector<Estimator>& list, const Estimator& estimator) {
    const auto found =
        std::find_if(list.begin(), list.end(), [&](const Estimator& known) { return same_kernel(known, estimator); });
    return found == list.end() ? nullptr : &*found;
}

bool contains_same(const std::vector<Estimator>& list, const Estimator& estimator) {
    return std::any_of(list.begin(), list.end(), [&](const Estimator& known) { return same_kernel(known, estimator); });
}

// At its end, or as another name of one that is there.
void add(std::vector<Estimator>& list, Estimator estimator) {
    Estimator* known = find_same(list, estimator);
    if (!known)
        list.push_back(std::move(estimator));
    else if (known->integrator != estimator.integrator)
        known->same.push_back(estimator.integrator);
}

// Calls use(estimator) for what make() returns, unless this scene cannot be rendered so.
template <typename Make, typename Use> void if_possible(const Make& make, const Use& use) {
    std::optional<Estimator> estimator;
    try {
        estimator = make();
    } catch (const InputError&) {
        return; // regular tracking of noise, say
    }
    use(std::move(*estimator));
}

Estimator default_estimator(const RenderRequest& request) {
    Estimator estimator = load_estimator(request, std::nullopt);
    if (!is_unbiased(estimator)) {
        const std::string named = estimator.integrator;
        estimator = load_estimator(request, ""); // the choice for a scene that names none
        estimator.stands_for = named;
    }
    estimator.is_default = true;
    return estimator;
}

void check_same_picture(const Estimator& first, const Estimator& estimator) {
    if (expected_hash(estimator) != expected_hash(first))
        throw InputError(fmt::format("--integrators: {} and {} do not estimate the same picture: one leaves out light "
                                     "that the other sees, or scatters differently; measure them apart",
                                     first.integrator, estimator.integrator));
}

// Departures from `of` by one choice.
std::vector<IntegratorRequest> neighbours(const Estimator& of) {
    std::vector<IntegratorRequest> requests;
    const IntegratorRequest own{choose_integrator(of.scene).name, of.scene.settings.choices};
    for (const auto choice : {&AxisChoices::free_flight, &AxisChoices::transmittance})
        for (const Axis& axis : axes())
            for (std::size_t id = 0; axis.choice == choice && id < axis.names.size(); ++id) {
                requests.push_back(own);
                requests.back().choices.*choice = static_cast<int>(id);
            }
    return requests;
}

} // namespace

std::string expected_hash(const Estimator& estimator) {
    if (is_unbiased(estimator))
        return scene_hash(estimator.scene);
    for (const Integrator& preset : integrators()) {
        std::string hash;
        if_possible([&] { return with_request(estimator, same_light(estimator, preset)); },
                    [&](const Estimator& other) {
                        const bool same_light = other.method.scattering == estimator.method.scattering &&
                                                (other.method.nee == NEE_NONE) == (estimator.method.nee == NEE_NONE);
                        if (is_unbiased(other) && same_light && preset.adjustments == adjust_nothing)
                            hash = scene_hash(other.scene);
                    });
        if (!hash.empty())
            return hash;
    }
    throw InputError(fmt::format("{}: no unbiased integrator renders this scene, so its error cannot be known",
                                 estimator.integrator));
}

std::vector<Estimator> find_estimators(const BenchRequest& request) {
    const Estimator usual = default_estimator(request.render);
    std::vector<Estimator> list;
    for (const std::string& text : request.integrators) {
        Estimator estimator = load_estimator(request.render, text);
        estimator.is_default = same_kernel(estimator, usual);
        estimator.stands_for = estimator.is_default ? usual.stands_for : "";
        if (!list.empty())
            check_same_picture(list.front(), estimator);
        add(list, std::move(estimator));
    }
    if (!list.empty())
        return list;
    list.push_back(usual);
    for (const Integrator& preset : integrators())
        if_possible([&] { return load_estimator(request.render, preset.name); },
                    [&](Estimator estimator) {
                        if (is_unbiased(estimator) && scene_hash(estimator.scene) == scene_hash(usual.scene))
                            add(list, std::move(estimator));
                    });
    return list;
}

std::vector<Estimator> reference_candidates(const std::vector<Estimator>& measured) {
    constexpr std::size_t enough = 4; // each is tried before one is chosen
    const Estimator& first = measured.front();
    const std::string hash = expected_hash(first);
    std::vector<Estimator> candidates;
    const auto consider = [&](const IntegratorRequest& request) {
        if_possible([&] { return with_request(first, request); },
                    [&](Estimator estimator) {
                        if (candidates.size() < enough && is_unbiased(estimator) &&
                            scene_hash(estimator.scene) == hash && !contains_same(measured, estimator) &&
                            !contains_same(candidates, estimator))
                            candidates.push_back(std::move(estimator));
                    });
    };
    for (const Integrator& preset : integrators())
        consider(same_light(first, preset));
    if (candidates.empty())
        for (const IntegratorRequest& request : neighbours(first))
            consider(request);
    if (!candidates.empty())
        return candidates;
    for (const Estimator& estimator : measured)
        if (is_unbiased(estimator))
            return {estimator};
    throw InputError(
        fmt::format("no unbiased integrator renders this scene as {} does; give a --reference", first.integrator));
}

} // namespace vkvol
