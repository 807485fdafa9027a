#include "renderer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <list>
#include <utility>

#include "integrators.h"
#include "scene_buffers.h"
#include "scene_upload.h"

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

// The film lies in bands of whole rows, each within what one storage buffer may span.
struct Band {
    std::uint32_t first_row;
    std::uint32_t rows;
    Buffer film;
};

std::list<Band> make_bands(const Device& device, const Crop& crop, std::uint64_t most_bytes) {
    const std::uint64_t row_bytes = std::uint64_t(crop.x1 - crop.x0) * sizeof(shared::FilmPixel);
    const std::uint64_t most = most_bytes / row_bytes;
    const auto height = static_cast<std::uint32_t>(crop.y1 - crop.y0);
    std::list<Band> bands;
    for (std::uint32_t row = 0; row < height;) {
        const auto rows = static_cast<std::uint32_t>(std::min<std::uint64_t>(most, height - row));
        bands.emplace_back(
            row, rows,
            Buffer(device, "film", rows * row_bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, BufferPlace::device));
        row += rows;
    }
    return bands;
}

void develop(Commands& commands, const Band& band, std::uint32_t width, Film& film) {
    std::vector<shared::FilmPixel> pixels(std::size_t(band.rows) * width);
    commands.download(band.film, std::as_writable_bytes(std::span(pixels)));
    std::size_t out = std::size_t(band.first_row) * width;
    for (const shared::FilmPixel& pixel : pixels) {
        const double n = pixel.count;
        const glm::dvec3 sum = glm::dvec3(pixel.sum) + glm::dvec3(pixel.sum_low);
        const glm::dvec3 square = glm::dvec3(pixel.square) + glm::dvec3(pixel.square_low);
        const glm::dvec3 mean = n > 0 ? sum / n : glm::dvec3(0.0);
        const glm::dvec3 variance = n > 1 ? (square / n - mean * mean) / (n - 1.0) : glm::dvec3(0.0);
        film.mean[out] = mean;
        film.variance[out] = glm::max(variance, glm::dvec3(0.0));
        film.samples[out] = pixel.count;
        ++out;
    }
}

void add_counts(RenderCounts& total, const shared::Counters& c) {
    total.paths += c.paths;
    total.real_collisions += c.real_collisions;
    total.null_collisions += c.null_collisions;
    total.lookups += c.lookups;
    total.cells += c.cells;
    total.shadow_rays += c.shadow_rays;
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
        text = fmt::format("grid {}, {} filter, majorant cells of {} voxels", types[s[SPEC_GRID_TYPE]],
                           filters[s[SPEC_FILTER]], volume.majorants->cell);
    else
        text = (s[SPEC_FIELD] == FIELD_NOISE ? "noise in a " : "homogeneous ") + text;
    text += fmt::format("{}, {} flight", chromatic ? ", chromatic" : "", choice(1, s[SPEC_FREE_FLIGHT]));
    text += scatterings[s[SPEC_SCATTERING]];
    if (s[SPEC_NEE] != NEE_NONE)
        text +=
            fmt::format(", light at {} by {} transmittance",
                        s[SPEC_NEE] == NEE_COLLISIONS ? "collisions" : "every step", choice(2, s[SPEC_TRANSMITTANCE]));
    text += emissions[s[SPEC_EMISSION]];
    return text + (s[SPEC_EMISSION_AT] == EMISSION_AT_STEPS ? " along flights" : "");
}

// Runs batches of samples over all bands until the samples, the time or the user's patience is used up.
class Render {
public:
    Render(const Device& device, const Scene& scene, const RenderJob& job)
        : scene_(with_preset(scene)), job_(job), commands_(device),
          width_(static_cast<std::uint32_t>(job.crop.x1 - job.crop.x0)) {
        const Method method = choose_method(scene_);
        Stopwatch watch;
        LoadedVolume volume = load_volume(scene_, method);
        result_.load_seconds = watch.lap();
        result_.counts.cleaned_voxels = volume.field ? volume.field->cleaned : 0;
        result_.warnings.assign(scene_.warnings.begin() + std::ptrdiff_t(scene.warnings.size()), scene_.warnings.end());
        for (const auto& more : {method.warnings, volume.warnings})
            result_.warnings.insert(result_.warnings.end(), more.begin(), more.end());
        const Specialization specialization = specialize(scene_, volume, method);
        const bool chromatic = is_chromatic(scene_);
        result_.integrator = method.integrator;
        result_.biased = method.biased;
        result_.specialization = describe(specialization, volume, chromatic);
        const Tuning tuning = tune(device, volume.bvh ? volume.bvh->nodes.size() : 0, job.tuning);
        buffers_.emplace(device, commands_, volume, tuning.most_grid_bytes);
        frame_ = make_frame(scene_, volume, method, job.crop, job.seed);
        volume = {};
        bands_ = make_bands(device, job.crop, tuning.most_film_bytes);
        for (const Band& band : bands_)
            commands_.fill(band.film, 0);
        result_.upload_seconds = watch.lap();
        frame_.slots = tuning.slots;
        frame_.queue_capacity = queue_capacity(tuning);
        PipelineCache cache(device, job.disk_cache);
        wavefront_.emplace(device, buffers_->bound(), bands_.front().rows * width_, specialization,
                           TrackVariant{chromatic, buffers_->window_bits()}, tuning, cache.handle());
        cache.save();
        result_.device_bytes = buffers_->bytes() + wavefront_->bytes();
        for (const Band& band : bands_)
            result_.device_bytes += band.film.bytes();
        result_.pipeline_seconds = watch.lap();
    }

    RenderResult run() {
        watch_.lap();
        const std::uint32_t spp = scene_.settings.spp;
        std::uint32_t done = 0;
        std::uint32_t batch = 1;
        while (done < spp && !stopping()) {
            batch = std::min(batch, spp - done);
            const double begun = watch_.seconds();
            for (const Band& band : bands_)
                run_batch(band, done, batch);
            if (!stopped_)
                done += batch;
            report_noise(done);
            batch = next_batch(batch, watch_.seconds() - begun);
        }
        result_.render_seconds = watch_.lap();
        result_.samples = done;
        develop_film();
        return std::move(result_);
    }

private:
    // Long enough that its tail, when few paths are left in flight, matters little; short enough for the user.
    static std::uint32_t next_batch(std::uint32_t batch, double seconds) {
        return seconds < 1.0 ? batch * 2 : seconds > 4.0 ? std::max(batch / 2, 1u) : batch;
    }

    // Developing the film takes a while, so not more often than every few seconds.
    void report_noise(std::uint32_t done) {
        if (!job_.progress || watch_.seconds() < next_noise_)
            return;
        next_noise_ = watch_.seconds() + 3.0;
        develop_film();
        job_.progress(done, relative_noise(result_.film));
    }

    bool stopping() {
        if (job_.interrupted && job_.interrupted())
            result_.interrupted = stopped_ = true;
        else if (job_.time_limit && watch_.seconds() >= *job_.time_limit)
            stopped_ = true;
        return stopped_;
    }

    // Paths begun are finished, as a rule in no time; not if that takes a user's patience.
    bool gave_up() {
        const double now = watch_.seconds();
        stopped_at_ = stopped_at_.value_or(now);
        if (now - *stopped_at_ < patience)
            return false;
        result_.warnings.push_back(fmt::format("paths that would not end within {} seconds were left out: what is long "
                                               "is missing from the picture",
                                               patience));
        return true;
    }

    void run_batch(const Band& band, std::uint32_t done, std::uint32_t batch) {
        if (stopping())
            return;
        frame_.crop_y = static_cast<std::uint32_t>(job_.crop.y0) + band.first_row;
        buffers_->set_frame(commands_, frame_);
        wavefront_->bind_film(band.film);
        const std::uint32_t begin = job_.sample_offset + done;
        wavefront_->begin_batch(begin, begin + batch, band.rows * width_);
        for (bool finished = false; !finished;) {
            finished = wavefront_->advance();
            gather(band);
            if (job_.progress)
                job_.progress(progress_of(band, done, batch), std::nullopt);
            if (!finished && stopping()) {
                wavefront_->stop_handing_out();
                finished = gave_up();
            }
        }
    }

    double progress_of(const Band& band, std::uint32_t done, std::uint32_t batch) const {
        const shared::Counters& counters = wavefront_->counters();
        const double handed_out = std::min(counters.next_work, counters.work_count);
        const double done_part = counters.work_count > 0 ? handed_out / counters.work_count : 1.0;
        const double rows = band.first_row + band.rows * done_part;
        return done + batch * rows / (job_.crop.y1 - job_.crop.y0);
    }

    void gather(const Band& band) {
        const shared::Counters& counters = wavefront_->counters();
        add_counts(result_.counts, counters);
        for (std::size_t pass = 0; pass < pass_names.size(); ++pass)
            result_.pass_seconds[pass] += wavefront_->pass_seconds()[pass];
        for (std::uint32_t i = 0; i < std::min<std::uint32_t>(counters.non_finite, NON_FINITE_RECORDS); ++i) {
            const std::uint32_t pixel = counters.non_finite_pixel[i];
            if (result_.non_finite.size() < 16)
                result_.non_finite.push_back({job_.crop.x0 + static_cast<int>(pixel % width_),
                                              job_.crop.y0 + static_cast<int>(band.first_row + pixel / width_),
                                              counters.non_finite_sample[i]});
        }
    }

    void develop_film() {
        Film& film = result_.film;
        film.picture_width = scene_.picture.width;
        film.picture_height = scene_.picture.height;
        film.crop = job_.crop;
        const std::size_t pixels = std::size_t(film.width()) * film.height();
        film.mean.resize(pixels);
        film.variance.resize(pixels);
        film.samples.resize(pixels);
        for (const Band& band : bands_)
            develop(commands_, band, width_, film);
    }

    const Scene scene_; // as its integrator sees it
    const RenderJob& job_;
    Commands commands_;
    std::uint32_t width_;
    std::optional<SceneBuffers> buffers_;
    shared::FrameParams frame_{};
    std::list<Band> bands_;
    std::optional<Wavefront> wavefront_;
    RenderResult result_;
    Stopwatch watch_;
    double next_noise_ = 3.0;
    bool stopped_ = false;
    std::optional<double> stopped_at_;
    static constexpr double patience = 5.0; // seconds
};

} // namespace

RenderResult render(const Device& device, const Scene& scene, const RenderJob& job) {
    return Render(device, scene, job).run();
}

} // namespace vkvol
