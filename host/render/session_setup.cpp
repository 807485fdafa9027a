// The part of Session that makes ready: files, device scene, plan, kernels.
#include <algorithm>
#include <bit>
#include <fmt/format.h>
#include <set>
#include <utility>

#include "error.h"
#include "estimator_traits.h"
#include "even_sky.h"
#include "frame_params.h"
#include "kernel_constants.h"
#include "light_table.h"
#include "phase_params.h"
#include "pilot_paths.h"
#include "preset.h"
#include "scene_facts.h"
#include "scene_hash.h"
#include "schedule_memory.h"
#include "session.h"
#include "software_lanes.h"
#include "surface_gaps.h"
#include "surface_mesh.h"
#include "workshop.h"

namespace vkvol {

namespace {

// Tracking steps in a turn, as suits the scene; 0: not known.
std::uint32_t steps_per_turn(const Specialization& s, const LoadedMedium& medium) {
    const bool at_once =
        flight_has(s[SPEC_FREE_FLIGHT], TRAIT_CLOSED) && transmittance_has(s[SPEC_TRANSMITTANCE], TRAIT_CLOSED);
    if (at_once && s[SPEC_SHAPE] != SHAPE_MESH)
        return 1;
    const bool walks = flight_has(s[SPEC_FREE_FLIGHT], TRAIT_NULL) &&
                       !transmittance_has(s[SPEC_TRANSMITTANCE], TRAIT_VOXELS | TRAIT_MARCH);
    return walks && medium.majorants ? best_steps_per_turn(medium.majorants->segment_steps) : 0;
}

MediaFigures figures_of(const Assets& assets) {
    MediaFigures figures;
    figures.media = assets.media.size();
    for (const LoadedMedium& medium : assets.media)
        figures.grids += grids_of(medium).size();
    for (const DensityField* grid : distinct_grids(assets.media)) {
        ++figures.distinct_grids;
        figures.grid_bytes += grid->bytes.size();
    }
    if (assets.superposition) {
        figures.cells = assets.superposition->entries();
        figures.listed = assets.superposition->listed();
        figures.most_listed = assets.superposition->most_overlaps;
    }
    return figures;
}

LightFigures figures_of_lights(const Scene& scene, const SkyMap* sky) {
    LightFigures figures;
    std::set<int> bodies; // of surfaces that shine: on both sides they are two lights
    for (const Light& light : scene.lights)
        if (const int body = body_of(light); body == no_body)
            ++figures.kinds[kind_of(light)];
        else if (bodies.insert(body).second)
            ++figures.kinds["surface"];
    figures.tree = (lights_kind(scene) & LIGHTS_TREE) != 0;
    if (sky) {
        figures.map_width = sky->width;
        figures.map_height = sky->height;
        figures.map_unevenness = sky->unevenness;
        figures.mended_texels = sky->mended;
    }
    return figures;
}

} // namespace

Session::Session(const Device& device, const Scene& scene, const RenderJob& job) : Session(device, scene, job, true) {
    result_.scene_hash = scene_hash(scene);
    check_moments();
    make_followers(moving_ ? *moving_ : scene);
    compile_all();
    watch_.lap();
}

Session::Session(const Device& device, const Scene& scene, const RenderJob& job, bool leads)
    : device_(device), job_(job),
      moving_(scene.motion_blur ? std::optional(with_steady_integrator(scene)) : std::nullopt),
      moment_(moving_ ? std::optional(moment_of_sample(job.sample_offset)) : std::nullopt),
      scene_(with_surface_files(with_preset(moving_ ? scene_at(*moment_) : scene))), method_(choose_method(scene_)),
      commands_(device), leads_(leads) {
    scene_.warnings.erase(scene_.warnings.begin(), scene_.warnings.begin() + std::ptrdiff_t(scene.warnings.size()));
    load();
}

Scene Session::scene_at(const Moment& moment) {
    Scene scene = scene_of_time(*moving_, time_of(*moving_->motion_blur, moment, job_.seed));
    seen_files_.see(scene);
    return scene;
}

namespace {
[[noreturn]] void fail_moments() {
    throw InputError(
        "<motionBlur>: at some moments the scene needs another kind of paths, or has other layers, than at "
        "others; let lights be dim rather than 0, name the paths, or leave the layers out");
}
} // namespace

// Before anything is rendered, as far as few moments tell. Nobody sees the very first and last.
void Session::check_moments() const {
    // From the camera paths are whatever there is; of both some moments may have none from lights.
    if (!moving_ || scene_.settings.choices.paths.value_or(choose_integrator(scene_).paths) == PATHS_CAMERA)
        return;
    const MotionBlur& blur = *moving_->motion_blur;
    const double within = 1e-4 * (blur.close - blur.open);
    for (const double time : telling_times(blur)) {
        const Scene then = scene_of_time(*moving_, std::clamp(time, blur.open + within, blur.close - within));
        if (choose_method(with_preset(then)).paths != method_.paths)
            fail_moments();
    }
}

// Enters the moment of the sample that comes next: all before it are finished. The device keeps what it has compiled.
void Session::enter_moment() {
    if (!moving_ || next_sample() < moment_->end)
        return;
    const Moment moment = moment_of_sample(next_sample());
    Scene scene = with_surface_files(with_preset(scene_at(moment)));
    Method method = choose_method(scene);
    if (method.paths != method_.paths || plan_layers(scene).params.count != device_scene_->layers().params.count)
        fail_moments();
    moment_ = moment;
    scene_ = std::move(scene);
    method_ = std::move(method);
    wavefront_.reset();
    device_scene_.reset();
    load();
    compile();
}

// Files may be gone since, and memory used up.
void Session::check_ready() const {
    if (!device_scene_ || !wavefront_)
        throw RenderError("the scene could not be prepared for one of its moments; the render cannot be continued");
}

std::uint32_t Session::until_next_moment() const {
    return moment_ ? static_cast<std::uint32_t>(moment_->end - next_sample()) : most_batch_;
}

// What the first moment's files have to be warned of.
void Session::take_warnings(const Assets& assets) {
    result_.warnings = scene_.warnings;
    result_.warnings.insert(result_.warnings.end(), method_.warnings.begin(), method_.warnings.end());
    result_.warnings.insert(result_.warnings.end(), assets.warnings.begin(), assets.warnings.end());
    for (const LoadedMedium& medium : assets.media)
        result_.warnings.insert(result_.warnings.end(), medium.warnings.begin(), medium.warnings.end());
    const glm::dvec3 origin = render_origin(scene_, assets.media, whole_of(assets));
    if (const std::string gap = surface_gap_warning(scene_, assets, origin); !gap.empty())
        result_.warnings.push_back(gap);
    for (const DensityField* grid : distinct_grids(assets.media))
        result_.counts.cleaned_voxels += grid->cleaned;
}

// Files, and all of them on the device.
void Session::load() {
    Stopwatch watch;
    const bool is_first = bands_.empty();
    FieldCache* const fields = job_.workshop ? &job_.workshop->fields() : moving_ ? &own_fields_ : nullptr;
    SkyCache* const skies = job_.workshop ? &job_.workshop->skies() : moving_ ? &own_skies_ : nullptr;
    Assets assets = load_assets(scene_, method_, fields, skies);
    if (is_first) {
        result_.load_seconds = watch.lap();
        take_warnings(assets);
    }
    const auto has_colour = [&](const LoadedMedium& medium) { // fog, not fire
        return method_.material_colour && medium.mesh && medium.mesh->diffuse;
    };
    result_.media = figures_of(assets);
    const SkyMap* const sky = assets.sky ? &*assets.sky : nullptr;
    result_.lights = figures_of_lights(scene_, sky);
    const Method method = without_idle_looks(scene_, assets.media, method_, sky);
    const Specialization specialization = specialize(scene_, assets.media, method, whole_of(assets));
    find_wish(assets, specialization);
    result_.plan = plan_by(wish_.schedule);
    device_scene_.emplace(device_, commands_, scene_, method, assets, job_.crop, job_.seed,
                          result_.plan.most_grid_bytes, result_.plan.most_texel_bytes,
                          result_.plan.hits == Hits::query);
    result_.plan.hits = device_scene_->boxes() ? Hits::query : Hits::tree; // of planes alone there are none
    if (is_first)
        make_film();
    device_scene_->set_records(records_);
    film_scene_ = {device_scene_->layers(), device_scene_->frame().layers, device_scene_->origin()};
    if (is_first)
        begin_identity(assets);
    const bool glows = device_scene_->emits() && std::none_of(assets.media.begin(), assets.media.end(), has_colour);
    result_.glows = result_.glows || glows; // at any moment
    if (is_first)
        result_.integrator = method_.integrator;
    if (result_.biased.empty())
        result_.biased = method_.biased;
    if (result_.by_chance.empty())
        result_.by_chance = method_.by_chance;
    result_.specialization =
        device_scene_->text() + (method.nee == method_.nee ? "" : ", an even sky by flights alone");
    result_.trace_origin = device_scene_->origin();
    keep(assets);
    if (is_first)
        result_.upload_seconds = watch.lap();
}

void Session::find_wish(const Assets& assets, const Specialization& specialization) {
    wish_ = job_.plan;
    if (wish_.hits == Hits::query && !device_.has_ray_queries())
        throw InputError(fmt::format("--schedule hits=query: \"{}\" offers no ray queries (VK_KHR_ray_query); leave "
                                     "hits=query out",
                                     device_.info().name));
    if (!bands_.empty()) { // a later moment, of the same paths and records
        wish_.schedule = result_.plan.schedule;
        wish_.slots = result_.plan.slots;
        wish_.waiting = result_.plan.waiting;
    }
    loops_ = {};
    loops_.lights = loop_iterations(scene_);
    loops_.surfaces = !scene_.surfaces.empty();
    if (wish_.hits == Hits::query && device_.is_cpu())
        loops_.queried = pieces_of(scene_.surfaces);
    loops_.facets = std::any_of(scene_.surfaces.begin(), scene_.surfaces.end(),
                                [](const Surface& surface) { return surface.material.roughness > 0.0; });
    loops_.halvings = static_cast<std::uint32_t>(specialization[SPEC_MAP_HALVINGS]);
    loops_.layers = plan_layers(scene_).params.count;
    for (std::size_t i = 0; i < assets.media.size(); ++i) {
        const Volume& volume = scene_.volumes[i];
        const LoadedMedium& medium = assets.media[i];
        loops_.mesh = loops_.mesh || medium.bvh;
        loops_.models += medium.inside ? 1 : 0;
        loops_.faces = std::max(loops_.faces, medium.inside ? medium.inside->longest : 0u);
        loops_.phase = std::max(loops_.phase, phase_iterations(volume, medium.phase_nodes));
        loops_.octaves = std::max(loops_.octaves, volume.noise ? std::uint32_t(volume.noise->octaves) : 0u);
        if (wish_.steps == 0)
            wish_.steps = steps_per_turn(specialization, medium);
        if (medium.majorants) {
            wish_.majorant_cell = medium.majorants->cell;
            wish_.leaps = medium.majorants->leaps;
        }
    }
    if (assets.superposition) {
        loops_.media = assets.superposition->most_overlaps;
        if (specialization[SPEC_NEE] != NEE_NONE && transmittance_has(specialization[SPEC_TRANSMITTANCE], TRAIT_CLOSED))
            loops_.even = static_cast<std::uint32_t>(assets.media.size());
        wish_.majorant_cell = 0;
        wish_.leaps = assets.superposition->cells.leaps;
    }
    if (!job_.resume)
        return;
    if (wish_.schedule == Schedule::automatic) // a GPU may round the two differently
        wish_.schedule = job_.resume->schedule;
    if (wish_.schedule != job_.resume->schedule && !device_.is_cpu())
        throw InputError(fmt::format("the checkpoint was rendered by --schedule {0}; go on by that, or name none",
                                     name_of(job_.resume->schedule)));
    // Its batch is gone on with, whatever this schedule would have made of it.
    wish_.waiting = std::max(wish_.waiting, job_.resume->batch);
}

Plan Session::plan_by(Schedule schedule) const {
    Plan wish = wish_;
    wish.schedule = schedule;
    const std::uint64_t pixels = std::uint64_t{width()} * std::uint64_t(job_.crop.y1 - job_.crop.y0);
    Plan plan = make_plan(device_, loops_, pixels, wish);
    if (method_.paths != PATHS_CAMERA)
        fit_splats(device_, pixels, job_.resume ? job_.resume->batch : 0, plan);
    return plan;
}

// What the picture is explained by, and, where there are further frames, what they need.
void Session::keep(const Assets& assets) {
    if (assets.superposition)
        result_.outline = make_outline(*assets.superposition, device_scene_->emits());
    else if (const Volume* lone = lone_volume(scene_))
        result_.outline = make_outline(scene_, *lone, assets.media[0], device_scene_->emits());
    // A collision at distance D is shown with 1 / D^2, of which the mean square about the eye has no bound.
    const bool has_eye =
        scene_.camera.projection == Projection::perspective || scene_.camera.projection == Projection::equirectangular;
    const std::string near =
        method_.integrator +
        ": the camera is within a medium, where what particles show from next to it has "
        "no bound: its noise is more than errors tell; integrator bidirectional leaves that to paths";
    const bool is_about = may_have_matter(result_.outline, scene_.camera.position) &&
                          (any_medium(scene_, can_scatter) || device_scene_->emits());
    if (method_.paths == PATHS_LIGHT && has_eye && is_about &&
        std::find(result_.warnings.begin(), result_.warnings.end(), near) == result_.warnings.end())
        result_.warnings.push_back(near);
    if (leads_ && job_.others.empty())
        release_grids();
}

void Session::release_grids() {
    if (job_.workshop && job_.workshop->has_frames())
        job_.workshop->fields().foresee(job_.workshop->next());
    else if (job_.workshop && !moving_) {
        job_.workshop->fields().retain({});
        job_.workshop->skies() = {};
    }
}

void Session::compile() {
    Stopwatch watch;
    if (!job_.workshop && !own_cache_)
        own_cache_.emplace(device_, job_.disk_cache);
    const PipelineCache& cache = job_.workshop ? job_.workshop->pipelines(device_, job_.disk_cache) : *own_cache_;
    device_scene_->make_light_cache();
    if (job_.trace && !trace_)
        trace_.emplace(device_, commands_);
    wavefront_ = make_wavefront(result_.plan, cache, [&] {
        if (job_.compiling)
            job_.compiling();
        device_scene_->compile_light_cache(&cache);
    });
    device_scene_->fill_light_cache();
    // Software drivers are faster with one pass (schedules.txt in tools/results): no trial is worth its time.
    const bool is_known = device_.is_cpu() && !job_.plan.tries;
    const bool has_paths = device_scene_->specialization()[SPEC_SHAPE] != SHAPE_NONE || !scene_.surfaces.empty();
    if (wish_.schedule == Schedule::automatic && !is_known && has_paths && !job_.trace && !job_.dry_run)
        choose_schedule(cache);
    cache.save();
    device_scene_->set_queues(result_.plan.slots, queue_capacity(result_.plan));
    // Counters of the sky, which are read once a batch, have 32 bits.
    const std::uint64_t pixels = std::uint64_t{bands_.front().rows} * width();
    most_batch_ = std::min<std::uint32_t>(result_.plan.most_batch, std::max<std::uint64_t>((1ull << 31) / pixels, 1));
    device_bytes_ = device_scene_->bytes() + wavefront_->bytes();
    for (const Band& band : bands_)
        device_bytes_ += band.film.bytes() + (band.layers ? band.layers->bytes() : 0);
    if (result_.pipeline_seconds == 0.0) // of the first moment
        result_.pipeline_seconds = watch.lap();
}

std::unique_ptr<Wavefront> Session::make_wavefront(const Plan& plan, const PipelineCache& cache,
                                                   const std::function<void()>& meanwhile) {
    BoundBuffers bound = device_scene_->bound();
    Specialization specialization = device_scene_->specialization();
    if (trace_) {
        specialization[SPEC_TRACE] = 1;
        bound[BINDING_TRACE] = &trace_->buffer();
    }
    return std::make_unique<Wavefront>(device_, bound, device_scene_->boxes(), bands_.front().rows * width(),
                                       specialization, device_scene_->form(), plan, &cache, meanwhile);
}

// Fused or staged, by a moment of each, unless that was done before with such a scene at such a size.
void Session::choose_schedule(const PipelineCache& cache) {
    const Plan plan = plan_by(Schedule::staged);
    const std::uint64_t pixels = std::uint64_t{bands_.front().rows} * width();
    const std::string kind =
        fmt::format("{} {}: {}, {}, {}, 2^{} pixels", device_.info().uuid, device_.info().driver,
                    result_.specialization, describe(result_.plan), describe(plan), std::bit_width(pixels));
    std::optional<Schedule> known = recall_schedule(kind, job_.disk_cache);
    if (known == Schedule::fused)
        return;
    std::unique_ptr<Wavefront> staged;
    try {
        staged = make_wavefront(plan, cache, [] {});
    } catch (const RenderError&) { // no room for both
        return;
    }
    if (!known) {
        const bool faster = paths_per_second(*staged, plan) > paths_per_second(*wavefront_, result_.plan);
        known = faster ? Schedule::staged : Schedule::fused;
        remember_schedule(kind, *known, job_.disk_cache);
    }
    if (known == Schedule::staged) {
        wavefront_ = std::move(staged);
        result_.plan = plan;
    }
}

// Speed of a batch that is thrown away: once lanes work as long at a time as they may, if the batch lasts until then.
// Paths that miss the medium count: both schedules have the same.
double Session::paths_per_second(Wavefront& wavefront, const Plan& plan) {
    constexpr double start_up = 0.1, enough = 0.3; // seconds
    const Band& band = bands_.front();
    const std::uint32_t pixels = band.rows * width();
    const auto samples = static_cast<std::uint32_t>(std::clamp<std::uint64_t>((1u << 22) / pixels, 1, plan.most_batch));
    device_scene_->set_queues(plan.slots, queue_capacity(plan));
    device_scene_->set_rows(static_cast<std::uint32_t>(job_.crop.y0) + band.first_row, band.rows);
    wavefront.bind_film(band);
    wavefront.begin_batch(0, samples, 0, pixels);
    Stopwatch watch;
    double counted_from = 0.0;
    std::uint64_t paths = 0;
    for (bool resting = false; !resting && watch.seconds() < enough;) {
        resting = wavefront.advance();
        paths += wavefront.counters().paths;
        // Unless the first submit took all of the time: then it is what counts.
        if (const double now = watch.seconds(); !resting && counted_from == 0.0 && now > start_up && now < enough) {
            counted_from = now;
            paths = 0;
        }
    }
    const double seconds = watch.seconds() - counted_from;
    clear(commands_, band);
    return static_cast<double>(paths) / seconds;
}

// Where either schedule may be taken there is room for the paths of both.
void Session::make_film() {
    shared::AovParams layers = device_scene_->frame().layers;
    const auto may_be = [&](Schedule schedule) {
        const bool is_tried = schedule == Schedule::fused || !device_.is_cpu() || job_.plan.tries;
        // Beside what the wish has since: what is resumed needs the same bands, and records for what goes on.
        const Schedule asked = job_.plan.schedule;
        return asked == schedule || wish_.schedule == schedule || (asked == Schedule::automatic && is_tried);
    };
    for (const Schedule schedule : {Schedule::fused, Schedule::staged})
        if (layers.count > 0 && may_be(schedule)) {
            const Plan plan = plan_by(schedule);
            layers.records = std::max({layers.records, plan.slots, plan.waiting});
        }
    const auto films =
        std::count_if(job_.others.begin(), job_.others.end(), [](const Device* d) { return d->shares_memory(); }) +
        (device_.shares_memory() ? 1 : 0);
    bands_ = make_bands(device_, commands_, job_.crop, result_.plan.most_film_bytes, job_.plan.band_rows, layers,
                        int(films));
    records_ = layers.records;
    film_layers_ = layers;
}

// Names each kind of device once: those of one kind compute the same bits.
std::string Session::devices_text() const {
    const auto text_of = [](const Device& device) {
        return fmt::format("{}, {}", name_by_bits(device.info().name), device.info().driver);
    };
    std::string text = text_of(device_);
    for (const Device* other : job_.others)
        if (text.find(text_of(*other)) == std::string::npos)
            text += "; " + text_of(*other);
    return text;
}

void Session::begin_identity(const Assets& assets) {
    if (!job_.checkpoint && !job_.resume)
        return;
    std::vector<std::uint32_t> rows;
    for (const Band& band : bands_)
        rows.push_back(band.rows);
    shared::FrameParams frame = device_scene_->frame();
    frame.layers.records = 0; // how it is carried out
    identity_ = identify(frame, device_scene_->specialization(), assets, device_scene_->lights(),
                         device_scene_->media(), device_scene_->surfaces(), device_scene_->points(), job_.sample_offset,
                         devices_text(), std::move(rows));
    if (device_scene_->boxes() && !device_.is_cpu()) // other kernels, which a GPU may round differently
        identity_.kernel += ", by ray queries";
    if (moving_) // of which the device has but a moment
        identity_.kernel += scene_hash(*moving_);
    if (job_.resume)
        check_identity(job_.resume->identity, identity_);
}

} // namespace vkvol
