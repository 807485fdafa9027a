#include "explain.h"

#include <algorithm>
#include <fmt/format.h>

#include "explain_causes.h"
#include "preset.h"
#include "scene_facts.h"
#include "shared/constants.h"

namespace vkvol {

namespace {

// What less than a thousandth of the pixels say is a firefly or a speck.
bool few(std::size_t count, const FilmGlance& look) {
    return 1000 * count <= look.pixels;
}

// By what it shows alone; that it is nothing but noise is asked later, of pictures from within a medium.
std::optional<Odd> oddity(const FilmGlance& look, const Scene& scene, const Tone& tone) {
    if (2 * look.unsampled > look.pixels)
        return Odd::unfinished;
    const bool has_screen = tone.pixels > 0;
    if (look.brightest == 0.0 || (has_screen && few(look.shown, look)))
        return Odd::black;
    if (few(look.apart, look) && scene.background != Rgb(0.0) && !scene.holds_out)
        return Odd::background;
    if (has_screen && 20 * look.shown >= look.pixels && 5 * tone.clipped >= 4 * look.shown)
        return Odd::white;
    return std::nullopt;
}

const char* name_of(Odd odd) {
    constexpr const char* names[] = {"unfinished", "black", "background", "white", "noise"};
    return names[static_cast<int>(odd)];
}

std::string percent(std::size_t part, std::size_t whole) {
    return fmt::format("{:.0f} % of the pixels", 100.0 * double(part) / double(whole));
}

std::string beginning(const Evidence& evidence) {
    switch (evidence.odd) {
    case Odd::unfinished:
        return percent(evidence.look->unsampled, evidence.look->pixels) + " have no sample";
    case Odd::black:
        return !evidence.look                   ? "the picture will be black"
               : evidence.look->brightest > 0.0 ? "the picture is all but black"
                                                : "the picture is black";
    case Odd::background:
        return "the picture shows its background alone";
    case Odd::white:
        return percent(evidence.tone->clipped, evidence.look->shown) +
               (evidence.look->shown < evidence.look->pixels ? " that are not black clip" : " clip");
    case Odd::noise:
        break;
    }
    return "the picture shows noise alone";
}

std::optional<Explanation> find_cause(const Evidence& evidence) {
    for (const Cause& cause : causes())
        if (const std::optional<std::string> why = cause.explain(evidence)) {
            Explanation explanation;
            explanation.picture = name_of(evidence.odd);
            explanation.cause = cause.name;
            explanation.text = beginning(evidence) + ": " + *why;
            return explanation;
        }
    return std::nullopt;
}

} // namespace

// Flights meet the sky by themselves, and the camera sees lamps.
bool sees_light(const Scene& scene, const Method& method) {
    const auto any = [&](bool (*is)(const Light&)) {
        return std::any_of(scene.lights.begin(), scene.lights.end(), is);
    };
    if (any(is_met_by_chance) ||
        ((any(is_lamp) || reads_flux(scene.camera)) && !scene.lights.empty() && method.uses_lights()))
        return true;
    return !scene.lights.empty() && method.uses_lights() && scene.settings.max_depth != 0u;
}

std::optional<Explanation> foresee(const Scene& authored) {
    const Scene scene = with_preset(authored);
    const Method method = choose_method(scene);
    const auto glows = [](const Surface& surface) { return surface.emission != Rgb(0.0); };
    if (authored.motion_blur) // at other times of the picture there may be light
        return std::nullopt;
    if (std::any_of(scene.surfaces.begin(), scene.surfaces.end(), glows))
        return std::nullopt;
    if (sees_light(scene, method) || scene.background != Rgb(0.0) || emits(scene) || method.material_colour)
        return std::nullopt;
    Evidence evidence{scene, authored, method};
    return find_cause(evidence);
}

namespace {

Rgb background_shown(const Scene& scene) {
    return scene.holds_out ? Rgb(0.0) : reading_of_unit_radiance(scene.camera) * scene.background;
}

} // namespace

std::optional<Explanation> explain(const Scene& authored, const RenderResult& result, const Tone& tone) {
    const Scene scene = with_preset(authored);
    const FilmGlance seen = first_glance(result.film, background_shown(scene), tone.mapping);
    const Crop& crop = result.film.crop;
    const bool is_whole = crop.x1 - crop.x0 == scene.picture.width && crop.y1 - crop.y0 == scene.picture.height;
    if (!authored.surfaces.empty() && seen.brightest == 0.0 && seen.unsampled == 0 && is_whole &&
        !reads_flux(scene.camera) && choose_method(scene).scattering != SCATTERING_NONE)
        return Explanation{
            "black", "shadowed",
            "the picture is black: no light comes to what is seen; surfaces stand between, are black, or "
            "have the camera inside, or it looks past them all",
            seen, std::nullopt};
    if (!authored.surfaces.empty() || authored.periodic) // what is said is about pictures of media, that are there once
        return std::nullopt;
    std::optional<Odd> odd = oddity(seen, scene, tone);
    std::optional<Sight> sight;
    if (result.outline.exists && !reads_flux(scene.camera)) // which looks nowhere
        sight = sight_of(scene, result.outline, result.film.crop);
    // Only where all that is seen is medium: elsewhere noise may hide a thing or two.
    if (!odd && sight && sight->inside && sight->least_depth >= deep && is_without_structure(result.film))
        odd = Odd::noise;
    if (!odd)
        return std::nullopt;
    const Method method = choose_method(scene);
    Evidence evidence{scene, authored, method, *odd, result.outline.emits, &result, &seen};
    evidence.sight = sight ? &*sight : nullptr;
    evidence.tone = tone.pixels > 0 ? &tone : nullptr;
    std::optional<Explanation> explanation = find_cause(evidence);
    if (explanation) {
        explanation->look = seen;
        explanation->sight = sight;
    }
    return explanation;
}

} // namespace vkvol
