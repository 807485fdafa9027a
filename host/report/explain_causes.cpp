#include "explain_causes.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <set>

#include "camera_view.h"
#include "kernel_constants.h"
#include "phase_params.h"
#include "phase_table.h"
#include "scene_facts.h"
#include "shared/constants.h"
#include "view_advice.h"

namespace vkvol {

namespace {

using Answer = std::optional<std::string>;

bool sees_light(const Evidence& e) {
    return sees_light(e.scene, e.method);
}

// Before a background that is no darker than night, a picture that is black is so by its exposure.
bool shows_nothing(const Evidence& e) {
    constexpr double night = 1e-3;
    return e.odd == Odd::background || (e.odd == Odd::black && largest(e.scene.background) < night);
}

double least(const Rgb& color) {
    return std::min({color.x, color.y, color.z});
}

std::string text_of(glm::dvec3 v) {
    const double rounding = 1e-12 * std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    for (int i = 0; i < 3; ++i)
        v[i] = std::abs(v[i]) > rounding ? v[i] : 0.0;
    return fmt::format("({:.4g}, {:.4g}, {:.4g})", v.x, v.y, v.z);
}

std::string box_text(const WorldBox& box) {
    return fmt::format("{} to {}", text_of(box.low), text_of(box.high));
}

// The least and the most of the albedos of all media.
std::pair<double, double> least_and_most_albedo(const Scene& scene) {
    double low = 1.0, high = 0.0;
    for (const Volume& volume : scene.volumes) {
        low = std::min(low, least(albedo_of(volume)));
        high = std::max(high, largest(most_map_albedo(volume) * albedo_of(volume)));
    }
    return {low, high};
}

// The emission that the scene asks for, whether there will be any or not.
bool wants_glow(const Evidence& e) {
    const Volume* volume = lone_volume(e.authored);
    return volume && (volume->Le != Rgb(0.0) || volume->temperature.color != Rgb(0.0));
}

// Nothing but the medium's own glow can be seen.
bool is_dark_around(const Evidence& e) {
    return e.scene.background == Rgb(0.0) && !sees_light(e);
}

Answer unfinished(const Evidence& e) {
    if (e.odd != Odd::unfinished)
        return {};
    if (e.result->interrupted)
        return "the render was interrupted early; with --checkpoint 60s, --resume continues it after that";
    if (e.result->counts.non_finite > 0)
        return fmt::format(
            "{} samples were not finite, or too bright to add up, and were dropped; lower the lights, or "
            "bring heyneygreenstein_g nearer to 0, or raise a roughness",
            e.result->counts.non_finite);
    return "time was up early; give it more --time, or a smaller --width";
}

// Elements that are there to give light, and are black: a colour without r, g and b is.
Answer black_source(const Evidence& e) {
    const bool any = !e.authored.lights.empty() || e.scene.background != Rgb(0.0) || wants_glow(e);
    if (e.odd != Odd::black || any || e.emits || e.authored.black.empty())
        return {};
    const BlackElement& element = e.authored.black.front();
    return fmt::format("nothing gives light: <{}> at {} is black; r, g and b are 0 unless given, and a multiplier "
                       "multiplies them",
                       element.name, element.place);
}

Answer no_glow(const Evidence& e) {
    const Volume* volume = lone_volume(e.authored);
    if (e.odd != Odd::black || e.emits || !wants_glow(e) || !is_dark_around(e) || !e.authored.lights.empty())
        return {};
    if (most_sigma_a(*volume) == Rgb(0.0))
        return "the medium glows by what it absorbs, and sigma_a is 0; raise sigma_a";
    if (emits(e.authored) && !emits(e.scene))
        return fmt::format("{} leaves emission out, and nothing else gives light; use nanoVDBEmission, or no "
                           "integrator at all",
                           e.method.integrator);
    if (volume->Le == Rgb(0.0) && e.result && !e.result->outline.has_temperature)
        return fmt::format("the only light would come from a grid \"{}\", which the file does not have or which has "
                           "no voxels; name the one it has with <emission grid=\"...\"> (vkvol info lists them), or "
                           "add a <light> or a <backgroundColor>",
                           volume->temperature.grid);
    return {};
}

Answer no_light(const Evidence& e) {
    if (e.odd != Odd::black || e.scene.background != Rgb(0.0) || !e.authored.lights.empty() || e.emits)
        return {};
    return "nothing gives light: the scene has no <light>, the background is black and the medium does not glow; add "
           "e.g. <light x=\"1\" y=\"1\" z=\"1\" r=\"3\" g=\"3\" b=\"3\"/> or <backgroundColor r=\"0.4\" g=\"0.6\" "
           "b=\"1\"/>";
}

bool are_all_beams(const std::vector<Light>& lights) {
    return std::all_of(lights.begin(), lights.end(),
                       [](const Light& light) { return std::holds_alternative<DirectionalLight>(light); });
}

// The lights' kinds, each once.
std::string kinds_of(const std::vector<Light>& lights) {
    std::set<std::string> kinds;
    for (const Light& light : lights)
        kinds.insert(fmt::format("<{}>", kind_of(light)));
    return fmt::format("{}", fmt::join(kinds, ", "));
}

Answer light_unseen(const Evidence& e) {
    const Volume* volume = lone_volume(e.authored);
    if (e.odd != Odd::black || !volume || e.authored.lights.empty() || !is_dark_around(e) || e.emits)
        return {};
    const bool are_beams = are_all_beams(e.authored.lights);
    const std::string seen = (are_beams ? std::string("a <light>") : kinds_of(e.authored.lights)) +
                             " is seen by what the medium scatters of it alone";
    if (volume->sigma_s == Rgb(0.0))
        return seen + ", and sigma_s is 0; raise sigma_s, or add a <backgroundColor> to see the medium against";
    if (e.scene.settings.max_depth == 0u)
        return seen + ", and maxDepth is 0; raise maxDepth or leave it out";
    if (e.method.scattering == SCATTERING_NONE)
        return fmt::format("{}, and {} scatters nothing; use --integrator ratioTracking", seen, e.method.integrator);
    const std::string sources = are_beams ? std::string("the <light>, a point infinitely far away that")
                                          : kinds_of(e.authored.lights) + ", which";
    return fmt::format("nothing gives light but {} no path of {} meets by chance; use --integrator ratioTracking, or "
                       "add a <backgroundColor>",
                       sources, e.method.integrator);
}

Answer no_medium(const Evidence& e) {
    if (!shows_nothing(e) || !e.result || e.result->outline.exists)
        return {};
    const Volume* volume = lone_volume(e.authored);
    if (e.authored.volumes.size() > 1)
        return "none of the media holds anything: of each either sigma_a and sigma_s are 0, or the density is, or "
               "lightRayDensityMultiplier";
    if (!volume)
        return "the scene has no medium; add a <densityField>, <sphere>, <box> or <models>";
    if (volume->density_scale == 0.0)
        return "lightRayDensityMultiplier is 0, which leaves no medium; 1 is the density as it is";
    if (volume->sigma_a + volume->sigma_s == Rgb(0.0))
        return "sigma_a and sigma_s are 0, which leaves no medium; raise one of them";
    if (lone_volume(e.scene)->sigma_a + lone_volume(e.scene)->sigma_s == Rgb(0.0))
        return fmt::format("{} leaves sigma_s out and sigma_a is 0, which leaves no medium; raise sigma_a",
                           e.method.integrator);
    const GridFile* file = std::get_if<GridFile>(&volume->shape);
    if (file && file->memory)
        return fmt::format("the values of \"{}\" are all 0, so there is no medium", file->grid);
    return fmt::format("the grid \"{}\" has no voxels, so there is no medium; vkvol info {} says what the file has",
                       file ? file->grid : "", file ? file->path.string() : "FILE");
}

std::string frame_advice(const Evidence& e) {
    return fmt::format("{}look at {}", view_advice(e.scene.camera).frame,
                       text_of(0.5 * (e.sight->box.low + e.sight->box.high)));
}

// No ray of the window meets the medium's box: where it is, and where the camera looks.
Answer missed(const Evidence& e) {
    if (!shows_nothing(e) || !e.sight || e.sight->in_window)
        return {};
    const Sight& s = *e.sight;
    if (s.entering_picture > 0.0)
        return fmt::format("no ray of this crop enters the medium, but {:.2g} % of the whole picture's do; move --crop",
                           100.0 * s.entering_picture);
    if (s.entering_frame > 0.0)
        return fmt::format("no ray enters the medium, but {:.2g} % of the reference frame's do; the picture is another "
                           "part of it, by startOffset and reference of <width> and <height>",
                           100.0 * s.entering_frame);
    if (s.degrees_off < 1.0) // it is looked at
        return fmt::format(
            "no ray enters the medium, whose box {} is before the camera, but too thin to be met by any: "
            "give the picture more pixels, or {}",
            box_text(s.box), view_advice(e.scene.camera).larger);
    const std::string where =
        s.degrees_off > 90.0 ? "behind the camera" : fmt::format("{:.0f} degrees off the middle", s.degrees_off);
    return fmt::format("no ray enters the medium, whose box {} is {}: the camera at {} looks along {} with {}; {}",
                       box_text(s.box), where, text_of(s.eye), text_of(s.forward), view_advice(e.scene.camera).width,
                       frame_advice(e));
}

Answer speck(const Evidence& e) {
    constexpr double small = 0.002; // of the rays
    if (!shows_nothing(e) || !e.sight || e.sight->inside || e.sight->entering > small)
        return {};
    if (e.sight->pixels > 0.05 * std::min(e.scene.picture.width, e.scene.picture.height))
        return fmt::format("only an edge of the medium, whose box is {}, is in view: {:.1g} % of the rays enter it; "
                           "{}{}",
                           box_text(e.sight->box), 100.0 * e.sight->entering,
                           e.sight->entering_picture > 2.0 * e.sight->entering ? "move --crop, or " : "",
                           frame_advice(e));
    return fmt::format("the medium, whose box is {}, measures {:.2g} pixels in a picture of {}x{}; {}",
                       box_text(e.sight->box), e.sight->pixels, e.scene.picture.width, e.scene.picture.height,
                       view_advice(e.scene.camera).larger);
}

Answer hollow(const Evidence& e) {
    if (!shows_nothing(e) || !e.sight || e.sight->most_depth > 0.0)
        return {};
    if (e.result->outline.densest == 0.0)
        return "the density is 0 in every voxel of the grid; vkvol info says what the file holds";
    return fmt::format("rays enter the medium's box {}, but the density is 0 wherever they go; {}",
                       box_text(e.sight->box), frame_advice(e));
}

Answer too_thin(const Evidence& e) {
    constexpr double thin = 0.02; // a screen shows half a per cent of contrast
    if (!shows_nothing(e) || !e.sight || e.sight->most_depth > thin)
        return {};
    const Volume* volume = lone_volume(e.scene);
    const bool by_voxel = volume && e.result->outline.voxel > 0.0 && volume->unit == CoefficientUnit::voxel;
    const std::string unit =
        by_voxel ? fmt::format(" (sigma_a and sigma_s are per voxel, of {:.3g} world units)", e.result->outline.voxel)
                 : "";
    return fmt::format("the largest optical depth in view is {:.2g}{}; multiply sigma_a and sigma_s, or "
                       "lightRayDensityMultiplier, by {:.0e} or so",
                       e.sight->most_depth, unit, 1.0 / e.sight->most_depth);
}

Answer cold_glow(const Evidence& e) {
    const Volume* volume = lone_volume(e.scene);
    if (e.odd != Odd::black || !volume || !e.result || !e.result->outline.has_temperature || sees_light(e))
        return {};
    const TemperatureEmission& emission = volume->temperature;
    const double hottest = e.result->outline.hottest;
    // At six tenths of the reference temperature the luminance is 1e-5 of what the reference has.
    const bool faint = hottest < 0.6 * emission.reference;
    if (emission.model != TemperatureEmission::Model::blackbody || (hottest >= emission.cutoff && !faint))
        return {};
    return fmt::format("the medium is too cold to glow: \"{}\" reaches {:.4g} kelvin by temperatureScale and "
                       "temperatureOffset, {}; raise temperatureScale (flames have 1000 to 3000 kelvin)",
                       emission.grid, hottest,
                       hottest < emission.cutoff
                           ? fmt::format("below the temperatureCutoff of {:g}", emission.cutoff)
                           : fmt::format("which beside a referenceTemperature of {:g} is black", emission.reference));
}

Answer depth_limit(const Evidence& e) {
    if (e.odd != Odd::black || !e.result || 2 * e.result->counts.depth_caps < e.result->counts.paths)
        return {};
    return fmt::format("{:.0f} % of the paths ended at maxDepth {}, and those are black; raise maxDepth or leave it "
                       "out",
                       100.0 * double(e.result->counts.depth_caps) / double(e.result->counts.paths),
                       e.scene.settings.max_depth.value_or(1'000'000));
}

Answer absorbs_all(const Evidence& e) {
    constexpr double soot = 0.01;
    if (e.odd != Odd::black || !e.sight || e.emits || e.sight->most_depth < deep / 2.0)
        return {};
    const bool scatters = e.method.scattering != SCATTERING_NONE;
    const double albedo = least_and_most_albedo(e.scene).second;
    if (scatters && albedo > soot)
        return {};
    return fmt::format("the medium absorbs whatever enters it, {}, and its optical depth reaches {:.3g}; lower "
                       "sigma_a, {}",
                       scatters ? fmt::format("with an albedo of {:.2g}", albedo)
                                : fmt::format("since {} scatters nothing", e.method.integrator),
                       e.sight->most_depth, scatters ? "or raise sigma_s" : "or use --integrator ratioTracking");
}

Answer inside(const Evidence& e) {
    const bool nothing = e.odd == Odd::black || e.odd == Odd::noise;
    if (!nothing || !e.sight || !e.sight->inside || !e.result->outline.fills || e.sight->least_depth < deep)
        return {};
    if (std::any_of(e.scene.volumes.begin(), e.scene.volumes.end(), is_everywhere))
        return fmt::format(
            "<everywhere> has no end, and the optical depth before the camera reaches {:.3g} and more; give "
            "the medium a shape, lights within it, or lower sigma_a and sigma_s",
            e.sight->least_depth);
    return fmt::format("the camera at {} stands inside of the medium, whose box is {}, and sees no way out: the "
                       "optical depth before it is {:.3g} and more; {} or lower sigma_a and sigma_s",
                       text_of(e.sight->eye), box_text(e.sight->box), e.sight->least_depth,
                       view_advice(e.scene.camera).out);
}

// Where light comes from, if from one direction; else 0.
glm::dvec3 light_direction(const Evidence& e) {
    const DirectionalLight* sun = only_directional(e.scene.lights);
    return sun ? sun->direction : glm::dvec3(0.0);
}

Answer phase_peak(const Evidence& e) {
    const Volume* volume = lone_volume(e.scene);
    if (e.odd != Odd::black || !volume || !e.sight || !sees_light(e) || e.emits || !only_directional(e.scene.lights))
        return {};
    if (volume->phase == PhaseFunction::table) // of a file, which may be gone by now
        return {};
    const std::vector<shared::PhaseNode> nodes = phase_table(*volume).nodes;
    const double mu = glm::dot(light_direction(e), e.sight->forward); // straight from the light to the camera
    const double to_even = 4.0 * std::numbers::pi * phase_value(*volume, nodes, mu);
    if (to_even > 0.05)
        return {};
    const bool is_lone_lobe = volume->phase == PhaseFunction::henyey_greenstein;
    return fmt::format("the medium scatters the light past the camera: with {}, {:.1g} of what it would be by even "
                       "scattering comes this way; {}, or let the light shine {} the camera",
                       is_lone_lobe ? fmt::format("heyneygreenstein_g {:g}", volume->g) : "its phase function", to_even,
                       is_lone_lobe ? "lower it" : "take a broader one",
                       mean_cosine(*volume, nodes) > 0.0 ? "towards" : "from behind");
}

Answer backlit(const Evidence& e) {
    if (e.odd != Odd::black || !e.sight || !sees_light(e) || e.emits || e.sight->most_depth < deep)
        return {};
    const glm::dvec3 direction = light_direction(e);
    if (glm::dot(direction, e.sight->forward) < 0.3)
        return {};
    return fmt::format("the camera sees the far side of the medium: the <light> stands behind it, at {}, and the "
                       "optical depth reaches {:.3g}; turn the light, or lower sigma_a and sigma_s",
                       text_of(direction), e.sight->most_depth);
}

Answer unlike_colours(const Evidence& e) {
    const Volume* volume = lone_volume(e.scene);
    if (e.odd != Odd::black || !volume || !sees_light(e) || e.emits || e.scene.background != Rgb(0.0))
        return {};
    const DirectionalLight* sun = only_directional(e.scene.lights);
    if (!sun)
        return {};
    const Rgb irradiance = sun->irradiance;
    if (irradiance * volume->sigma_s != Rgb(0.0))
        return {};
    return fmt::format("light and medium have no colour in common: the <light> has {}, of which sigma_s {} scatters "
                       "nothing; change one of them",
                       text_of(irradiance), text_of(volume->sigma_s));
}

std::string exposure_advice(const Evidence& e) {
    const double camera =
        e.scene.camera.exposure ? stops_of(*e.scene.camera.exposure) : 0.0; // on top of which it comes
    const double suits = suitable_exposure(e.result->film, e.tone->mapping.curve) - camera;
    return fmt::format("--exposure {:.2f} suits, also of vkvol develop", suits);
}

Answer dim(const Evidence& e) {
    if (e.odd != Odd::black || !e.tone || !(e.look->brightest > 0.0))
        return {};
    return fmt::format("the brightest radiance is {:.2g}, next to nothing at exposure {:g}; {}, or brighter light",
                       e.look->brightest, e.tone->mapping.exposure, exposure_advice(e));
}

Answer unlit(const Evidence& e) {
    if (e.odd != Odd::black || !e.sight)
        return {};
    const bool is_most = e.scene.volumes.size() > 1 || any_medium(e.scene, has_albedo_of_place);
    return fmt::format(
        "none of its {} paths met light; the optical depth in view reaches {:.3g}, the albedo is {:.3g}{}",
        e.result->counts.paths, e.sight->most_depth, least_and_most_albedo(e.scene).second, is_most ? " at most" : "");
}

Answer furnace(const Evidence& e) {
    if (e.odd != Odd::background || !e.sight || e.emits || sees_light(e))
        return {};
    if (least_and_most_albedo(e.scene).first < 0.98 || e.method.scattering != SCATTERING_MULTIPLE)
        return {};
    return "a medium that absorbs next to nothing cannot be told from a background that is the same everywhere; add a "
           "<light>, or raise sigma_a";
}

Answer equilibrium(const Evidence& e) {
    if (e.odd != Odd::background || !e.sight || !e.emits || e.result->outline.has_temperature)
        return {};
    return "the medium glows just as its background does, and cannot be told from it; change <medium> or "
           "<backgroundColor>";
}

Answer indistinct(const Evidence& e) {
    if (e.odd != Odd::background || !e.sight)
        return {};
    return fmt::format("the medium differs from it by less than a screen shows; the optical depth in view reaches "
                       "{:.3g}; change <backgroundColor>, or add a brighter <light>",
                       e.sight->most_depth);
}

Answer overexposed(const Evidence& e) {
    if (e.odd != Odd::white)
        return {};
    const ToneMapping& mapping = e.tone->mapping;
    const double background = largest(e.scene.background) * std::exp2(mapping.exposure);
    const std::string sky = background > 1.0 ? fmt::format(", where the background alone is {:.3g}", background) : "";
    return fmt::format("they are brighter than curve {} shows at exposure {:g}{}; {}", name_of(mapping.curve),
                       mapping.exposure, sky, exposure_advice(e));
}

} // namespace

const std::vector<Cause>& causes() {
    static const std::vector<Cause> table = {
        {"unfinished", unfinished},
        {"blackSource", black_source},
        {"noGlow", no_glow},
        {"noLight", no_light},
        {"lightUnseen", light_unseen},
        {"noMedium", no_medium},
        {"missed", missed},
        {"speck", speck},
        {"hollow", hollow},
        {"tooThin", too_thin},
        {"coldGlow", cold_glow},
        {"inside", inside},
        {"depthLimit", depth_limit},
        {"absorbsAll", absorbs_all},
        {"unlikeColours", unlike_colours},
        {"phasePeak", phase_peak},
        {"backlit", backlit},
        {"dim", dim},
        {"unlit", unlit},
        {"furnace", furnace},
        {"equilibrium", equilibrium},
        {"indistinct", indistinct},
        {"overexposed", overexposed},
    };
    return table;
}

} // namespace vkvol
