#include "renderer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "error.h"
#include "estimator_traits.h"
#include "film_bands.h"
#include "integrators.h"
#include "light_cache.h"
#include "pilot_paths.h"
#include "render_session.h"
#include "scene_buffers.h"
#include "scene_upload.h"
#include "trace.h"

namespace vkvol {

namespace {

class Stopwatch {
public:
    double lap() {
        const auto now = std::chrono::steady_clock::now();
        return std::chrono::duration<double>(now - std::exchange(start_, now)).count();
    }
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

void add_counts(RenderCounts& total, const shared::Counters& c) {
    total.paths += c.paths;
    total.real_collisions += c.real_collisions;
    total.null_collisions += c.null_collisions;
    total.lookups += c.lookups;
    total.cells += c.cells;
    total.shadow_rays += c.shadow_rays;
    total.room += c.room;
    total.steps += c.steps;
    total.depth_caps += c.depth_caps;
    total.step_caps += c.step_caps;
    total.majorant_violations += c.majorant_violations;
    total.non_finite += c.non_finite;
    total.queue_overflows += c.queue_overflows;
}

std::string describe(const Specialization& s, const LoadedVolume& volume, bool chromatic) {
    constexpr std::array shapes = {"no medium", "sphere", "box", "mesh"};
    constexpr std::array types = {"float", "Fp4", "Fp8", "Fp16", "FpN"};
    constexpr std::array filters = {"nearest", "trilinear", "stochastic"};
    constexpr std::array scatterings = {", no scattering", ", single scattering", ""};
    constexpr std::array emissions = {"", ", uniform emission", ", emission by temperature", ", black-body emission"};
    const auto choice = [&](int axis, int id) { return axes()[std::size_t(axis)].names[std::size_t(id)]; };
    if (s[SPEC_SHAPE] == SHAPE_NONE)
        return shapes[SHAPE_NONE];
    std::string text = shapes[s[SPEC_SHAPE]];
    if (s[SPEC_FIELD] == FIELD_GRID)
        text = fmt::format("grid {}, {} filter, majorant cells of {} voxels{}", types[s[SPEC_GRID_TYPE]],
                           filters[s[SPEC_FILTER]], volume.majorants->cell, s[SPEC_LEAPS] ? ", empty ones leapt" : "");
    else
        text = (s[SPEC_FIELD] == FIELD_NOISE ? "noise in a " : "homogeneous ") + text;
    text += fmt::format("{}, {} flight", chromatic ? ", chromatic" : "", choice(1, s[SPEC_FREE_FLIGHT]));
    text += scatterings[s[SPEC_SCATTERING]];
    if (s[SPEC_NEE] != NEE_NONE)
        text += fmt::format(", light at {} by {} transmittance",
                            s[SPEC_NEE] == NEE_COLLISIONS ? "collisions"
                            : s[SPEC_NEE] == NEE_CACHED   ? "collisions from a cache corrected"
                                                          : "every step",
                            choice(2, s[SPEC_TRANSMITTANCE]));
    text += emissions[s[SPEC_EMISSION]];
    return text + (s[SPEC_EMISSION_AT] == EMISSION_AT_STEPS ? " along flights" : "");
}

// Tracking steps between two looks at what they led to, as suits the scene; 0: not known.
std::uint32_t steps_per_look(const Specialization& s, const LoadedVolume& volume) {
    const bool at_once = s[SPEC_FREE_FLIGHT] == FREE_FLIGHT_ANALYTIC && s[SPEC_TRANSMITTANCE] == TRANSMITTANCE_ANALYTIC;
    if (at_once && s[SPEC_SHAPE] != SHAPE_MESH)
        return 1;
    const bool walks = flight_has(s[SPEC_FREE_FLIGHT], TRAIT_NULL) &&
                       !transmittance_has(s[SPEC_TRANSMITTANCE], TRAIT_VOXELS | TRAIT_MARCH);
    return walks && volume.majorants ? best_steps_per_look(volume.majorants->segment_steps) : 0;
}

// Runs batches of samples over all bands until the samples, the time or the user's patience is used up.
class Render {
public:
    Render(const Device& device, const Scene& scene, const RenderJob& job)
        : scene_(with_preset(scene)), job_(job), commands_(device),
          width_(static_cast<std::uint32_t>(job.crop.x1 - job.crop.x0)) {
        const Method method = choose_method(scene_);
        Stopwatch watch;
        LoadedVolume volume = load_volume(scene_, method, job.session ? &job.session->fields() : nullptr);
        result_.load_seconds = watch.lap();
        result_.counts.cleaned_voxels = volume.field ? volume.field->cleaned : 0;
        result_.warnings.assign(scene_.warnings.begin() + std::ptrdiff_t(scene.warnings.size()), scene_.warnings.end());
        for (const auto& more : {method.warnings, volume.warnings})
            result_.warnings.insert(result_.warnings.end(), more.begin(), more.end());
        Specialization specialization = specialize(scene_, volume, method);
        const bool chromatic = is_chromatic(scene_);
        const bool has_colour = method.material_colour && volume.mesh && volume.mesh->diffuse; // fog, not fire
        result_.glows = specialization[SPEC_EMISSION] != EMISSION_NONE && !has_colour;
        result_.integrator = method.integrator;
        result_.biased = method.biased;
        result_.specialization = describe(specialization, volume, chromatic);
        LoopSizes loops;
        loops.mesh = volume.bvh.has_value();
        if (density_kind(scene_) == FIELD_NOISE)
            loops.octaves = static_cast<std::uint32_t>(scene_.volumes.front().noise->octaves);
        Plan wish = job.plan;
        if (wish.steps == 0)
            wish.steps = steps_per_look(specialization, volume);
        plan_ = make_plan(device, loops, wish);
        plan_.majorant_cell = volume.majorants ? volume.majorants->cell : 0;
        plan_.leaps = volume.majorants && volume.majorants->leaps;
        result_.plan = plan_;
        buffers_.emplace(device, commands_, volume, plan_.most_grid_bytes, plan_.most_texel_bytes);
        specialization[SPEC_TEXELS] = buffers_->texels() ? 1 : 0;
        result_.specialization += buffers_->window_bits() ? ", grids in windows" : "";
        frame_ = make_frame(scene_, volume, method, job.crop, job.seed);
        bands_ = make_bands(device, commands_, job.crop, plan_.most_film_bytes);
        if (job.checkpoint || job.resume)
            begin_identity(device, specialization, volume);
        result_.trace_origin = render_origin(scene_, volume);
        result_.outline = make_outline(scene_, volume, specialization[SPEC_EMISSION] != EMISSION_NONE);
        if (job.session && job.session->has_frames())
            keep_fields(job.session->fields(), scene_, std::move(volume));
        volume = {};
        result_.upload_seconds = watch.lap();
        // Counters of the sky, which are read once a batch, have 32 bits.
        const std::uint64_t pixels = std::uint64_t{bands_.front().rows} * width_;
        most_batch_ = std::min<std::uint32_t>(plan_.most_batch, std::max<std::uint64_t>((1ull << 31) / pixels, 1));
        frame_.slots = plan_.slots;
        frame_.queue_capacity = queue_capacity(plan_);
        std::optional<PipelineCache> own_cache;
        const PipelineCache& cache =
            job.session ? job.session->pipelines(job.disk_cache) : own_cache.emplace(device, job.disk_cache);
        BoundBuffers bound = buffers_->bound();
        if (job.trace) {
            trace_.emplace(device, commands_);
            specialization[SPEC_TRACE] = 1;
            bound[BINDING_TRACE] = &trace_->buffer();
        }
        if (specialization[SPEC_NEE] == NEE_CACHED && specialization[SPEC_SHAPE] != SHAPE_NONE) {
            buffers_->set_frame(commands_, frame_);
            light_cache_.emplace(device, commands_, bound, frame_.lattice, specialization, buffers_->window_bits(),
                                 cache.handle());
            bound[BINDING_LATTICE] = &light_cache_->buffer();
            if (buffers_->texels())
                bound[BINDING_LATTICE_TEXELS] = &light_cache_->buffer();
        }
        wavefront_.emplace(device, bound, bands_.front().rows * width_, specialization,
                           TrackVariant{chromatic, buffers_->window_bits()}, plan_, cache.handle());
        cache.save();
        result_.device_bytes = buffers_->bytes() + wavefront_->bytes();
        result_.device_bytes += light_cache_ ? light_cache_->buffer().bytes() : 0;
        for (const Band& band : bands_)
            result_.device_bytes += band.film.bytes();
        result_.pipeline_seconds = watch.lap();
    }

    RenderResult run() {
        if (job_.dry_run)
            return std::move(result_);
        watch_.lap();
        if (job_.resume)
            resume(*job_.resume);
        const std::uint32_t spp = scene_.settings.spp;
        std::uint32_t next = first_batch();
        while (done_ < spp && !stopping()) {
            if (batch_ == 0)
                batch_ = std::min(next, spp - done_);
            const double begun = watch_.seconds();
            while (band_ < bands_.size() && !stopped_)
                run_band(bands_[band_]);
            if (band_ == bands_.size()) {
                next = next_batch(batch_, watch_.seconds() - begun);
                done_ += std::exchange(batch_, 0);
                band_ = 0;
            }
            report_noise();
        }
        if (job_.checkpoint && done_ < spp && !gave_up_)
            save_checkpoint();
        result_.render_seconds += watch_.lap();
        result_.samples = done_;
        develop_film();
        if (trace_)
            result_.trace = trace_->records(commands_);
        return std::move(result_);
    }

private:
    // A staged render has a path in each slot from the beginning.
    std::uint32_t first_batch() const {
        const std::uint64_t pixels = std::uint64_t{bands_.front().rows} * width_;
        const std::uint64_t wanted = plan_.schedule == Schedule::staged ? 8 * plan_.slots / pixels : 1;
        return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(wanted, 1, most_batch_));
    }

    // Long enough that its tail, when few paths are left in flight, matters little, and that lanes have many samples of
    // a pixel; short enough for the user.
    std::uint32_t next_batch(std::uint32_t batch, double seconds) const {
        if (seconds > 4.0)
            return std::max(batch / 2, 1u);
        return std::min(batch * (seconds < 0.1 ? 8 : seconds < 1.0 ? 2 : 1), most_batch_);
    }

    void begin_identity(const Device& device, const Specialization& specialization, const LoadedVolume& volume) {
        std::vector<std::uint32_t> rows;
        for (const Band& band : bands_)
            rows.push_back(band.rows);
        identity_ = identify(frame_, specialization, volume, job_.sample_offset,
                             fmt::format("{}, {}", device.info().name, device.info().driver), rows);
        if (job_.resume)
            check_identity(job_.resume->identity, identity_);
    }

    void resume(const Checkpoint& from) {
        if (from.done + from.batch > scene_.settings.spp)
            throw InputError(fmt::format("--resume: the checkpoint has {} samples per pixel already, more than the {} "
                                         "asked for; ask for more with --spp",
                                         from.done + from.batch, scene_.settings.spp));
        write_bands(commands_, bands_, width_, from.film);
        done_ = from.done;
        batch_ = from.batch;
        band_ = from.band;
        pixels_ = from.pixels;
        result_.counts = from.counts;
        result_.non_finite = from.non_finite;
        result_.render_seconds = from.seconds;
    }

    void save_checkpoint() {
        Checkpoint checkpoint{identity_,
                              done_,
                              batch_,
                              band_,
                              pixels_,
                              read_bands(commands_, bands_, width_),
                              result_.counts,
                              result_.non_finite,
                              result_.render_seconds + watch_.seconds()};
        job_.checkpoint(checkpoint);
        checkpoint_at_ = watch_.seconds();
    }

    bool checkpoint_due() const {
        return job_.checkpoint && watch_.seconds() - checkpoint_at_ >= job_.checkpoint_seconds;
    }

    // Developing the film takes a while, so not more often than every few seconds.
    void report_noise() {
        if (!job_.progress || watch_.seconds() < next_noise_)
            return;
        next_noise_ = watch_.seconds() + 3.0;
        develop_film();
        job_.progress(done_, relative_noise(result_.film));
    }

    bool stopping() {
        if (job_.interrupted && job_.interrupted())
            result_.interrupted = stopped_ = true;
        else if (job_.time_limit && watch_.seconds() >= *job_.time_limit)
            stopped_ = true;
        return stopped_;
    }

    // Paths begun are finished, as a rule in no time; not if that takes a user's patience. What is missing from the
    // picture then is what is long.
    bool out_of_patience() {
        const double now = watch_.seconds();
        stopped_at_ = stopped_at_.value_or(now);
        if (now - *stopped_at_ < patience)
            return false;
        result_.counts.abandoned += wavefront_->in_flight();
        return true;
    }

    void begin_band(const Band& band) {
        frame_.crop_y = static_cast<std::uint32_t>(job_.crop.y0) + band.first_row;
        buffers_->set_frame(commands_, frame_);
        wavefront_->bind_film(band.film);
        const std::uint32_t begin = job_.sample_offset + done_;
        if (pixels_)
            wavefront_->begin_batch(begin, begin + batch_, *pixels_);
        else
            wavefront_->begin_batch(begin, begin + batch_, band.rows * width_);
    }

    // The batch under way in one band, or what is left of it. Ends early if the render does, with what is then left in
    // pixels_. For a checkpoint it comes to rest in between: a path in flight is nothing that could be kept.
    void run_band(const Band& band) {
        if (stopping())
            return;
        if (checkpoint_due())
            save_checkpoint();
        begin_band(band);
        for (bool resting = false; !resting;) {
            resting = wavefront_->advance();
            gather();
            if (job_.progress)
                job_.progress(progress_of(band), std::nullopt);
            if (!resting && stopping()) {
                wavefront_->stop_handing_out();
                gave_up_ = resting = out_of_patience();
            } else if (!resting && checkpoint_due()) {
                wavefront_->stop_handing_out();
            }
        }
        pixels_ = wavefront_->pixels_left();
        if (pixels_->empty() && !gave_up_) {
            pixels_.reset();
            ++band_;
        }
    }

    double progress_of(const Band& band) const {
        const double rows = band.first_row + band.rows * wavefront_->handed_out();
        return done_ + batch_ * rows / (job_.crop.y1 - job_.crop.y0);
    }

    void gather() {
        const shared::Counters& counters = wavefront_->counters();
        add_counts(result_.counts, counters);
        const auto passes = wavefront_->passes();
        result_.passes.resize(passes.size());
        for (std::size_t pass = 0; pass < passes.size(); ++pass) {
            result_.passes[pass].name = passes[pass].name;
            result_.passes[pass].seconds += passes[pass].seconds;
            result_.passes[pass].queued += passes[pass].queued;
        }
        result_.rounds += wavefront_->rounds();
        for (std::uint32_t i = 0; i < std::min<std::uint32_t>(counters.non_finite_records, NON_FINITE_RECORDS); ++i) {
            const std::uint32_t place = counters.non_finite_place[i];
            if (result_.non_finite.size() < 16)
                result_.non_finite.push_back(
                    {static_cast<int>(place & 0xffffu), static_cast<int>(place >> 16u), counters.non_finite_sample[i]});
        }
    }

    void develop_film() {
        Film& film = result_.film;
        film.picture_width = scene_.picture.width;
        film.picture_height = scene_.picture.height;
        film.crop = job_.crop;
        develop(read_bands(commands_, bands_, width_), film);
    }

    const Scene scene_; // as its integrator sees it
    const RenderJob& job_;
    Commands commands_;
    std::uint32_t width_, most_batch_ = 1;
    Plan plan_;
    std::optional<SceneBuffers> buffers_;
    shared::FrameParams frame_{};
    std::vector<Band> bands_;
    std::optional<TraceBuffer> trace_;
    std::optional<LightCache> light_cache_;
    std::optional<Wavefront> wavefront_;
    RenderIdentity identity_; // only for checkpoints
    RenderResult result_;

    // Where the render is; see Checkpoint.
    std::uint32_t done_ = 0, batch_ = 0, band_ = 0;
    std::optional<std::vector<std::uint32_t>> pixels_;

    Stopwatch watch_;
    double next_noise_ = 3.0;
    double checkpoint_at_ = 0.0; // the last one
    bool stopped_ = false;
    bool gave_up_ = false; // paths were left in flight
    std::optional<double> stopped_at_;
    static constexpr double patience = 5.0; // seconds
};

} // namespace

RenderResult render(const Device& device, const Scene& scene, const RenderJob& job) {
    return Render(device, scene, job).run();
}

} // namespace vkvol
