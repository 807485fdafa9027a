#include "report.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include "camera_view.h"
#include "error.h"
#include "metadata.h"
#include "program.h"
#include "render_notes.h"
#include "requested_scene.h"
#include "sample_ranges.h"
#include "scene_hash.h"
#include "version.h"

namespace vkvol {

namespace {

using Json = nlohmann::ordered_json;

std::uint64_t peak_host_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

Json seconds_json(const RenderResult& r, double write_seconds) {
    Json passes = Json::object();
    for (const PassFigures& pass : r.passes)
        passes[pass.name] = pass.seconds;
    return {{"load", r.load_seconds},     {"upload", r.upload_seconds}, {"pipeline", r.pipeline_seconds},
            {"render", r.render_seconds}, {"write", write_seconds},     {"passes", passes}};
}

Json counts_json(const RenderResult& r) {
    const RenderCounts& c = r.counts;
    return {{"paths", c.paths},
            {"realCollisions", c.real_collisions},
            {"nullCollisions", c.null_collisions},
            {"densityLookups", c.lookups},
            {"majorantCells", c.cells},
            {"shadowRays", c.shadow_rays}};
}

// Grids are read and uploaded once, however many media have them.
Json media_json(const MediaFigures& m) {
    Json json{
        {"volumes", m.media}, {"grids", m.grids}, {"distinctGrids", m.distinct_grids}, {"gridBytes", m.grid_bytes}};
    if (m.cells > 0)
        json.update({{"cells", m.cells}, {"listed", m.listed}, {"mostListed", m.most_listed}});
    return json;
}

Json lights_json(const LightFigures& l) {
    Json json{{"kinds", Json::object()}, {"tree", l.tree}, {"map", nullptr}};
    for (const auto& [kind, number] : l.kinds)
        json["kinds"][kind] = number;
    if (l.map_width > 0)
        json["map"] = {{"width", l.map_width},
                       {"height", l.map_height},
                       {"unevenness", l.map_unevenness},
                       {"mendedTexels", l.mended_texels}};
    return json;
}

// Share of the slots that were in each pass's queue when it began, on average.
Json occupancy_json(const RenderResult& r) {
    Json json = Json::object();
    const double slots = double(r.rounds) * r.plan.slots;
    for (std::size_t pass = 1; pass < r.passes.size(); ++pass) // the sky has no queue
        json[r.passes[pass].name] = slots > 0.0 ? double(r.passes[pass].queued) / slots : 0.0;
    return json;
}

Json plan_json(const Plan& plan) {
    return {{"schedule", name_of(plan.schedule)},
            {"hits", name_of(plan.hits)},
            {"slots", plan.slots},
            {"waiting", plan.waiting},
            {"lanes", plan.lanes},
            {"turns", plan.budget},
            {"steps", plan.steps},
            {"stepLimit", plan.step_limit},
            {"copiesInLoops", plan.copies == PathCopies::in_loops},
            {"majorantCell", plan.majorant_cell},
            {"leaps", plan.leaps}};
}

Json caps_json(const RenderResult& r) {
    const RenderCounts& c = r.counts;
    Json samples = Json::array();
    for (const NonFiniteSample& s : r.non_finite)
        samples.push_back({{"x", s.x}, {"y", s.y}, {"sample", s.sample}});
    return {{"depth", c.depth_caps},
            {"steps", c.step_caps},
            {"majorantViolations", c.majorant_violations},
            {"queueOverflows", c.queue_overflows},
            {"abandonedPaths", c.abandoned},
            {"nonFiniteSamples", c.non_finite},
            {"nonFiniteExamples", samples},
            {"cleanedVoxels", c.cleaned_voxels}};
}

Json device_json(const DeviceInfo& device) {
    return {{"name", device.name}, {"type", device.type}, {"driver", device.driver}, {"vulkan", device.api}};
}

// Beside the first, which has the rest of the samples.
Json others_json(const RenderResult& result) {
    Json others = Json::array();
    for (const OtherDevice& other : result.others) {
        others.push_back(device_json(other.info));
        others.back()["part"] = other.part;
    }
    return others;
}

// Names of files need not be UTF-8, as JSON must be.
std::string text_of(const Json& report) {
    return report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json tone_json(const Tone& tone) {
    if (tone.pixels == 0)
        return {};
    return {
        {"curve", name_of(tone.mapping.curve)}, {"exposure", tone.mapping.exposure}, {"clippedPixels", tone.clipped}};
}

Json vector_json(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

Json explanation_json(const std::optional<Explanation>& explanation, const Camera& camera) {
    if (!explanation)
        return {};
    Json json{{"picture", explanation->picture}, {"cause", explanation->cause}, {"text", explanation->text}};
    if (const auto& look = explanation->look)
        json.update({{"brightest", look->brightest},
                     {"pixels", look->pixels},
                     {"unsampledPixels", look->unsampled},
                     {"visiblePixels", look->shown},
                     {"pixelsUnlikeBackground", look->apart}});
    if (const auto& sight = explanation->sight)
        json.update({{"mediumBox", {vector_json(sight->box.low), vector_json(sight->box.high)}},
                     {"camera",
                      {{"position", vector_json(sight->eye)},
                       {"direction", vector_json(sight->forward)},
                       {"projection", projection_name(camera.projection)},
                       {"fov", camera.fov},
                       {"insideMediumBox", sight->inside}}},
                     {"raysEntering", sight->entering},
                     {"opticalDepth", {{"least", sight->least_depth}, {"most", sight->most_depth}}}});
    return json;
}

// Readings of a sensor of flux, where they are few enough to be read.
Json readings_json(const Film& film, const Camera& camera) {
    constexpr std::size_t most = 1024;
    if (!reads_flux(camera))
        return {};
    Json readings = Json::array();
    for (std::size_t i = 0; i < (film.pixel_count() <= most ? film.pixel_count() : 0); ++i) {
        Json reading{{"position", vector_json(film.places[i])},
                     {"value", vector_json(film.mean[i])},
                     {"standardError", nullptr},
                     {"samples", film.samples[i]}};
        if (film.samples[i] > 1)
            reading["standardError"] = vector_json(glm::sqrt(film.variance[i]));
        readings.push_back(reading);
    }
    return {{"reads", projection_name(camera.projection)}, {"readings", readings}};
}

Json mean_json(const Film& film) {
    const auto [value, error] = image_mean(film);
    Json json{{"value", {value.x, value.y, value.z}}, {"standardError", nullptr}};
    if (error)
        json["standardError"] = {error->x, error->y, error->z};
    return json;
}

} // namespace

namespace {

// Metadata integers have 32 bits.
int metadata_count(std::uint64_t count) {
    return static_cast<int>(std::min<std::uint64_t>(count, std::numeric_limits<int>::max()));
}

// Why the mean is not exact, also where a cap made it so.
std::string bias_of(const RenderResult& result) {
    std::string text = result.biased;
    const auto add = [&text](std::uint64_t count, const char* what) {
        if (count > 0)
            text += (text.empty() ? "" : "; ") + fmt::format("{} {}", count, what);
    };
    add(result.counts.depth_caps, "paths ended at maxDepth");
    add(result.counts.step_caps, "segments were cut");
    add(result.counts.abandoned, "paths were abandoned");
    add(result.counts.non_finite, "samples were not finite");
    return text;
}

} // namespace

Metadata make_metadata(const RenderRequest& request, const Scene& scene, const Device& device,
                       const RenderResult& result) {
    const auto most = std::max_element(result.film.samples.begin(), result.film.samples.end());
    // Whoever takes a picture amid a render has asked for no more than it has.
    std::optional<std::uint32_t> asked;
    if (!result.interrupted && !result.reached_goal && !result.time_is_over)
        asked = result.samples;
    Metadata metadata{{"Software", std::string("vkvol ") + version},
                      {"samplesPerPixel", static_cast<int>(*most)},
                      {"renderTimeSeconds", static_cast<float>(result.render_seconds)},
                      {"vkvol/version", std::string(version)},
                      {"vkvol/kernels", kernels_digest()},
                      {"vkvol/sceneHash", result.scene_hash},
                      {"vkvol/integrator", result.integrator},
                      {"vkvol/biased", bias_of(result)},
                      {"vkvol/specialization", result.specialization},
                      {"vkvol/plan", describe(result.plan)},
                      {"vkvol/seed", std::to_string(request.seed)},
                      {"vkvol/sampleOffset", static_cast<int>(request.sample_offset)},
                      {"vkvol/interrupted", result.interrupted ? 1 : 0},
                      {"vkvol/asked", asked_text(request, scene, asked)},
                      {"vkvol/device", of_all_devices(device, result, &DeviceInfo::name)},
                      {"vkvol/driver", of_all_devices(device, result, &DeviceInfo::driver)},
                      {"vkvol/capsHit", result.counts.any_cap() ? 1 : 0},
                      {"vkvol/depthCaps", metadata_count(result.counts.depth_caps)},
                      {"vkvol/stepCaps", metadata_count(result.counts.step_caps)},
                      {"vkvol/majorantViolations", metadata_count(result.counts.majorant_violations)},
                      {"vkvol/nullCollisions", std::to_string(result.counts.null_collisions)},
                      {"vkvol/queueOverflows", metadata_count(result.counts.queue_overflows)},
                      {"vkvol/abandonedPaths", metadata_count(result.counts.abandoned)},
                      {"vkvol/nonFiniteSamples", metadata_count(result.counts.non_finite)},
                      {"vkvol/cleanedVoxels", metadata_count(result.counts.cleaned_voxels)}};
    if (result.samples > *most) // random numbers that every pixel dropped were used as well
        metadata[sample_ranges_key] = to_text(SampleRanges{
            {{request.seed, request.sample_offset, std::uint64_t{request.sample_offset} + result.samples}}, true});
    record_facts(result.film, metadata);
    if (!scene.units.empty())
        metadata["vkvol/units"] = scene.units;
    if (const std::string layers = layers_text(scene); !layers.empty())
        metadata["vkvol/layersOf"] = layers;
    if (const std::optional<Exposure>& exposure = scene.camera.exposure) {
        metadata["isoSpeed"] =
            static_cast<float>(exposure->iso); // by OpenEXR's names, which OpenImageIO has others for
        metadata["ExposureTime"] = static_cast<float>(exposure->shutter);
        metadata["FNumber"] = static_cast<float>(exposure->f_number);
        metadata[camera_exposure_key] = fmt::format("{}", stops_of(*exposure));
    }
    record_tone(request.tone, result.glows, metadata);
    return metadata;
}

std::string make_report(const RenderRequest& request, const Scene& scene, const Device& device,
                        const RenderResult& result, const Shown& shown, double write_seconds,
                        const std::string& error) {
    const auto [least, most] = std::minmax_element(result.film.samples.begin(), result.film.samples.end());
    const double seconds = std::max(result.render_seconds, 1e-9);
    Json report;
    report["version"] = version;
    report["error"] = error.empty() ? Json() : Json(error);
    report["scene"] = request.scene.string();
    report["sceneHash"] = result.scene_hash;
    report["integrator"] = result.integrator;
    report["biased"] = bias_of(result);
    report["foundByChance"] = result.by_chance;
    report["specialization"] = result.specialization;
    report["device"] = device_json(device.info());
    report["otherDevices"] = others_json(result);
    report["picture"] = {
        {"width", scene.picture.width},
        {"height", scene.picture.height},
        {"crop", {result.film.crop.x0, result.film.crop.x1, result.film.crop.y0, result.film.crop.y1}}};
    report["seed"] = request.seed;
    report["sampleOffset"] = request.sample_offset;
    report["samplesPerPixel"] = {{"least", *least}, {"most", *most}};
    report["interrupted"] = result.interrupted;
    report["seconds"] = seconds_json(result, write_seconds);
    report["counts"] = counts_json(result);
    report["perSecond"] = {
        {"samples", static_cast<double>(result.counts.paths) / seconds},
        {"tentativeCollisions",
         static_cast<double>(result.counts.real_collisions + result.counts.null_collisions) / seconds}};
    report["media"] = media_json(result.media);
    report["lights"] = lights_json(result.lights);
    report["plan"] = plan_json(result.plan);
    report["occupancy"] = occupancy_json(result);
    report["laneUse"] = {{"track", result.counts.lane_use()}};
    report["caps"] = caps_json(result);
    report["mean"] = mean_json(result.film);
    report["sensor"] = readings_json(result.film, scene.camera);
    const std::optional<double> noise = relative_noise(result.film);
    report["noise"] = noise ? Json(*noise) : Json();
    report["tone"] = tone_json(shown.tone);
    report["explanation"] = explanation_json(shown.explanation, scene.camera);
    report["memory"] = {{"peakHostBytes", peak_host_bytes()}, {"deviceBytes", result.device_bytes}};
    report["warnings"] = scene.warnings;
    for (const std::string& warning : result.warnings)
        report["warnings"].push_back(warning);
    return text_of(report);
}

namespace {

// Nothing of a scene that no method renders, which may be what failed.
Json hash_if_rendered(const Scene& scene) {
    try {
        return scene_hash(scene);
    } catch (const InputError&) {
        return {};
    }
}

} // namespace

std::string make_failure_report(const RenderRequest& request, const Scene& scene, const DeviceInfo* device,
                                const std::string& error) {
    Json report;
    report["version"] = version;
    report["error"] = error;
    report["scene"] = request.scene.string();
    report["sceneHash"] = hash_if_rendered(scene);
    report["device"] = device ? device_json(*device) : Json();
    report["seed"] = request.seed;
    report["sampleOffset"] = request.sample_offset;
    report["memory"] = {{"peakHostBytes", peak_host_bytes()}};
    report["warnings"] = scene.warnings;
    return text_of(report);
}

} // namespace vkvol
