// The part of SceneReader that reads how the medium is rendered, and says what of the scene that leaves out.
#include <algorithm>
#include <cstring>
#include <fmt/format.h>

#include "error.h"
#include "integrators.h"
#include "preset.h"
#include "scene_reader.h"
#include "shared/estimators.h"

namespace vkvol {

// A request from the command line takes the place of the scene's, with all its choices.
void SceneReader::read_integrator(RenderSettings& settings) const {
    const XmlElement element = one("integrator");
    const XmlElement legacy = one("intersectionHandler");
    legacy.allow({}, true);
    if (legacy.exists())
        legacy.warn("<intersectionHandler> is without effect, as in the original renderer; write <integrator>");
    element.allow(axis_names(), true);
    if (overrides_.integrator) {
        try {
            const IntegratorRequest request = parse_integrator(*overrides_.integrator);
            settings.integrator = request.name;
            settings.choices = request.choices;
        } catch (const InputError& error) {
            throw InputError(one_line(fmt::format("--integrator: {}", error.what())));
        }
        return;
    }
    settings.integrator = element.text();
    try {
        if (!settings.integrator.empty())
            check_integrator(settings.integrator);
    } catch (const InputError& error) {
        element.fail_text(error.what());
    }
    for (const Axis& axis : axes())
        try {
            if (element.has(axis.name))
                settings.choices.*axis.choice = find_choice(axis, element.attribute(axis.name));
        } catch (const InputError& error) {
            element.fail_attribute(axis.name, error.what());
        }
}

March SceneReader::march() const {
    const XmlElement element = one("march");
    element.allow({"step", "shadowStep", "opticalStep", "jitter", "unit"});
    March march;
    march.step = element.attribute_number("step", march.step, length);
    march.shadow_step = element.attribute_number("shadowStep", march.shadow_step, length);
    march.optical_step = element.attribute_number("opticalStep", march.optical_step, positive);
    if (element.has("jitter")) {
        const std::string value = element.attribute("jitter");
        march.jitter = !value.empty() && std::strchr("1tTyY", value[0]);
        if (value.empty() || (!march.jitter && !std::strchr("0fFnN", value[0])))
            element.fail_attribute("jitter", fmt::format("<march> jitter: '{}' is neither true nor false", value));
    }
    const std::string unit = element.attribute("unit", "voxel");
    if (unit != "voxel" && unit != "world")
        element.fail_attribute("unit", fmt::format("<march> unit: '{}' is unknown; expected voxel or world", unit));
    march.unit = unit == "world" ? CoefficientUnit::world : CoefficientUnit::voxel;
    return march;
}

// What cannot be rendered is an error here already, where its place in the scene is known.
void SceneReader::check_method(const Scene& scene) const {
    Method method;
    try {
        method = choose_method(with_preset(scene));
    } catch (const InputError& error) {
        if (const XmlElement element = one("integrator"); element.exists() && !overrides_.integrator)
            element.fail(error.what());
        throw InputError(fmt::format("{}: {}", document_.file().string(), error.what()));
    }
    const Integrator& integrator = choose_integrator(scene);
    const XmlElement sigma_s = one("sigma_s");
    const bool scatters = any_medium(scene, [](const Volume& volume) { return volume.sigma_s != Rgb(0.0); });
    if (sigma_s.exists() && scatters && method.scattering == SCATTERING_NONE &&
        (integrator.adjustments & adjust_no_scattering))
        sigma_s.warn(fmt::format("{} scatters nothing and leaves sigma_s out; homogeneousRayMarcherImproved scatters "
                                 "once",
                                 integrator.name));
    warn_about_light(scene, method);
    warn_about_steps(scene, method);
}

void SceneReader::warn_about_light(const Scene& scene, const Method& method) const {
    if (method.uses_lights() || scene.lights.empty())
        return;
    const XmlElement lights = one("lights"), element = lights.exists() ? lights : one("light");
    if (std::all_of(scene.lights.begin(), scene.lights.end(), is_met_by_chance)) {
        if (method.scattering == SCATTERING_SINGLE)
            element.warn(fmt::format("{} sends no shadow rays, without which what scatters once has no light; the sky "
                                     "is seen only",
                                     method.integrator));
    } else if (scene.settings.choices.nee.value_or(choose_integrator(scene).nee) == NEE_NONE)
        element.warn(fmt::format("{} sends no shadow rays, without which a light that is no sun or sky is left out; "
                                 "ratioTracking renders it",
                                 method.integrator));
    else if (method.scattering == SCATTERING_NONE)
        element.warn(
            fmt::format("{} scatters nothing, and the light is left out; ratioTracking renders it", method.integrator));
}

void SceneReader::warn_about_steps(const Scene& scene, const Method& method) const {
    const XmlElement old = one("stepSize");
    old.allow({"min", "max", "multiplier"});
    for (const char* name : {"min", "max", "multiplier"})
        old.attribute_number(name, 0.0, not_negative);
    const bool takes_steps = method.flights_have(TRAIT_MARCH) || method.shadow_rays_have(TRAIT_MARCH);
    if (old.exists())
        old.warn(takes_steps ? fmt::format("stepSize is without effect: <march> has the steps of {}", method.integrator)
                             : "stepSize is without effect: free flights are sampled exactly, without steps");

    const XmlElement march = one("march");
    const bool shadows = method.shadow_rays_have(TRAIT_MARCH);
    const bool step = method.flights_have(TRAIT_EQUAL_STEPS) || (shadows && !march.has("shadowStep"));
    const bool jitter = method.flights_have(TRAIT_JITTERED) || method.shadow_rays_have(TRAIT_JITTERED);
    for (const auto& [name, used] : {std::pair{"step", step}, std::pair{"shadowStep", shadows},
                                     std::pair{"opticalStep", method.flights_have(TRAIT_OPTICAL_STEPS)},
                                     std::pair{"jitter", jitter}, std::pair{"unit", takes_steps}})
        if (march.has(name) && !used)
            march.warn(fmt::format("<march> {} is without effect: {} takes no such steps", name, method.integrator));
    if (march.has("jitter") && scene.settings.march.jitter && !method.jitter)
        march.warn(fmt::format("<march> jitter: {} samples the middle of its steps; homogeneousRayMarcherImproved "
                               "jitters",
                               method.integrator));
    if (march.attribute("unit") == "voxel" && scene.settings.march.unit == CoefficientUnit::world)
        march.warn("only grids have voxels; steps are taken in world units");
}

} // namespace vkvol
