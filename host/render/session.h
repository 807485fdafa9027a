// From a scene to a film, samples as wanted. Nothing is printed; what is wrong is thrown. The command line, the bench
// and the tests want all of a scene's samples at once, by render().
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <optional>

#include "checkpoint.h"
#include "device.h"
#include "device_scene.h"
#include "film.h"
#include "film_bands.h"
#include "input_files.h"
#include "medium_outline.h"
#include "pipeline_cache.h"
#include "scene.h"
#include "stopwatch.h"
#include "trace.h"
#include "wavefront.h"

namespace vkvol {

class Workshop;
struct RenderResult;

struct RenderJob {
    Crop crop; // the part of the picture to render
    std::uint32_t seed = 0;
    std::uint32_t sample_offset = 0;   // number of the first sample
    std::optional<double> time_limit;  // seconds of rendering; the batch then under way is cut short
    std::optional<double> noise_goal;  // the render ends once relative_noise is no more; see Session::is_good_enough
    bool disk_cache = true;            // keep compiled pipelines between runs
    Plan plan;                         // what of it is chosen wins
    std::function<bool()> interrupted; // asked between submits; true ends the render early
    // Once threads compile the kernels. Whoever loads libraries does so from then on: threads cannot begin meanwhile.
    std::function<void()> compiling;
    // After each submit: samples per pixel finished, as a real number; and, now and then, the picture's relative
    // standard error.
    std::function<void(double, std::optional<double>)> progress;
    // With the film as far as it is: soon after the first samples, and then whenever it has become a little better, as
    // long as that takes no more than a hundredth of the time, and 0.1 s.
    std::function<void(const RenderResult&)> preview;
    // Called every so many seconds, and at the end of a render that was ended early.
    double checkpoint_seconds = 0.0;
    std::function<void(const Checkpoint&)> checkpoint;
    const Checkpoint* resume = nullptr; // goes on from there
    bool trace = false;                 // record the vertices of the path; crop and samples leave just one
    Workshop* workshop = nullptr;       // whose grids and pipelines are used, and kept for further frames
    bool dry_run = false;               // set up everything, and render nothing
    // Devices that render rows of each batch beside the session's own, more or fewer as they turn out to be fast. Every
    // pixel is one device's at a time, so where devices compute alike, the bits are those of one device.
    std::vector<const Device*> others;
};

// What another device than the session's own had of a render.
struct OtherDevice {
    DeviceInfo info;
    double part = 0.0; // of the paths since the render began, or was gone on with
};

// What there is of media, and how much of it they share.
struct MediaFigures {
    std::uint64_t media = 0, grids = 0, distinct_grids = 0, grid_bytes = 0; // the last of these alone
    std::uint64_t cells = 0, listed = 0; // over several: cells, and places in their lists
    std::uint32_t most_listed = 0;       // in one of them
};

// What there is of lights, and how they are looked for.
struct LightFigures {
    std::map<std::string, std::uint64_t> kinds; // how many, by the names of kind_of()
    bool tree = false;                          // one of those that have a place is chosen by where the look is from
    int map_width = 0, map_height = 0;          // of the sky; 0: there is none
    double map_unevenness = 0.0;                // see SkyMap
    std::uint64_t mended_texels = 0;            // of it
};

struct RenderResult {
    Film film;
    RenderCounts counts;
    std::vector<NonFiniteSample> non_finite; // the first few
    std::vector<std::string> warnings;       // what the scene asks for and its files do not hold
    std::string integrator;
    bool glows = false;         // the medium does, by <medium> or <emission>
    std::string biased;         // why its mean is not exact; empty: it is
    std::string by_chance;      // which light nothing but chance finds; empty: none
    std::string scene_hash;     // of the files as they were when it began; see scene_hash.h
    std::string specialization; // in words: what the kernels were compiled for
    Plan plan;
    std::vector<PassFigures> passes; // of the session's own device, as is the plan
    std::uint64_t rounds = 0;        // of all passes but the sky
    std::vector<OtherDevice> others;
    double load_seconds = 0, upload_seconds = 0, pipeline_seconds = 0, render_seconds = 0;
    std::uint64_t device_bytes = 0; // of all buffers
    MediaFigures media;
    LightFigures lights;
    bool time_is_over = false;              // which ended it
    std::exception_ptr failure;             // what ended it early, between batches; the film is whole
    MediumOutline outline;                  // to explain the picture by
    std::vector<shared::TraceRecord> trace; // positions relative to trace_origin
    glm::dvec3 trace_origin{0.0};           // world space
    std::uint32_t samples = 0;              // per pixel, finished for every pixel
    bool interrupted = false;               // ended before the samples asked for, by a signal
    bool reached_goal = false;              // by noise_goal
};

class Session {
public:
    // Reads the scene's files, uploads them and compiles the kernels. `device`, others and `job` outlive the session.
    // Throws InputError for what cannot be rendered, and RenderError where a device fails.
    Session(const Device& device, const Scene& scene, const RenderJob& job);

    // Until every pixel has `samples` in all, or the job ends it before. May be called again, for more; time limits
    // count from each call. A scene that moves is made ready for each moment, in the time of rendering; if that fails
    // what was rendered is whole, and can be had.
    void render(std::uint32_t samples);

    // Throws InputError if what the job resumes has more samples than that.
    void check_resume(std::uint32_t samples) const;
    std::uint32_t samples() const { return done_; } // per pixel, finished for every pixel
    // Not after paths were abandoned, a device failed, or a moment could not be made ready.
    bool can_go_on() const { return !gave_up_ && device_scene_ && wavefront_; }
    // Not while nobody knows what it has of a batch that failed.
    bool has_whole_film() const { return !gave_up_; }

    // As if made anew with the job's seed as it is now, without reading, uploading or compiling again; only how long
    // lanes work at a time goes by the device as met before. Of one device, without checkpoints, and where nothing
    // moves.
    void begin_again();

    // What the scene asks for and does not get.
    const std::vector<std::string>& warnings() const { return result_.warnings; }

    // With the film as it is now. A caller that renders no more may move from it.
    RenderResult& result();

private:
    struct Follower { // another device's session, and the thread in which it renders its share of a band
        RenderJob job;
        std::unique_ptr<Session> session;
        std::future<void> work;
        std::uint64_t paths = 0;
    };
    enum class Order { go_on, rest, abandon };
    struct Following { // as long as they render
        Session& leader;
        ~Following();
    };

    Session(const Device& device, const Scene& scene, const RenderJob& job, bool leads);

    std::uint32_t width() const { return static_cast<std::uint32_t>(job_.crop.x1 - job_.crop.x0); }
    void load();
    void take_warnings(const Assets& assets);
    Scene scene_at(const Moment& moment);
    void check_moments() const;
    void check_ready() const;
    void find_wish(const Assets& assets, const Specialization& specialization);
    Plan plan_by(Schedule schedule) const;
    void keep(const Assets& assets);
    void release_grids();
    void compile();
    std::unique_ptr<Wavefront> make_wavefront(const Plan& plan, const PipelineCache& cache,
                                              const std::function<void()>& meanwhile);
    void choose_schedule(const PipelineCache& cache);
    double paths_per_second(Wavefront& wavefront, const Plan& plan);
    std::uint32_t first_batch() const;
    std::uint32_t next_batch(std::uint32_t batch, double seconds) const;
    void make_film();
    std::string devices_text() const;
    void begin_identity(const Assets& assets);
    void resume(const Checkpoint& from);
    void save_checkpoint();
    void make_checkpoint();
    void warn_of_checkpoint();
    bool checkpoint_due() const;
    void report_noise();
    void offer_preview();
    std::uint32_t first_check() const; // of the noise; samples per pixel, a power of two
    std::uint32_t until_next_check() const;
    std::uint64_t next_sample() const { return std::uint64_t{job_.sample_offset} + done_; }
    bool goes_on();
    void end_rendering();
    void enter_moment();
    std::uint32_t until_next_moment() const;
    bool is_good_enough();
    bool stopping();
    bool out_of_patience();
    void begin_band(const Band& band, Rows rows);
    bool advance();
    void run_band(const Band& band);
    void run_particles(const Band& band);
    double progress_of(const Band& band) const;
    void gather();
    void develop_film();
    void develop_pixels();

    // Several devices: session_devices.cpp.
    void make_followers(const Scene& scene);
    void compile_all();
    void enter_moments();
    void agree();
    Session& member(std::size_t i);
    Rows rows_of(std::size_t i) const;
    void divide(const Band& band);
    void move_rows(Session& from, Session& to, std::size_t band, Rows rows);
    void split_pixels();
    [[nodiscard]] Following start_followers();
    void follow(Rows rows, const std::atomic<Order>& order);
    void give_order(Order order);
    bool followers_rest() const;
    void wait_for_followers() const;
    void join_followers();
    void take_from(Follower& follower);
    void measure_speeds();
    void bring_home();

    const Device& device_;
    const RenderJob& job_;
    const std::optional<Scene> moving_; // as authored, with one integrator, where something moves
    std::optional<Moment> moment_;      // then: of the samples under way
    SeenFiles seen_files_;              // of all moments
    Scene scene_;                       // of that moment, as its integrator sees it
    Method method_;
    Plan wish_; // of the job, completed by what suits the scene
    LoopSizes loops_;
    Commands commands_;
    std::optional<DeviceScene> device_scene_;
    struct { // what of it the film needs, also where a moment cannot be made ready
        LayerPlan plan;
        shared::AovParams layers{};
        glm::dvec3 origin{0.0};
    } film_scene_;
    FieldCache own_fields_;                  // of what moves, without a workshop's
    SkyCache own_skies_;                     // likewise
    std::optional<PipelineCache> own_cache_; // without a workshop's
    std::vector<Band> bands_;
    std::uint32_t records_ = 0; // of paths, in them
    shared::AovParams film_layers_{};
    std::optional<TraceBuffer> trace_;
    std::unique_ptr<Wavefront> wavefront_;
    RenderIdentity identity_; // only for checkpoints
    RenderResult result_;

    // Where the render is; see Checkpoint.
    std::uint32_t wanted_ = 0, done_ = 0, batch_ = 0, band_ = 0, next_ = 0;
    std::optional<std::vector<std::uint32_t>> pixels_;

    std::uint32_t most_batch_ = 1; // of the moment at hand; `next_` may be from one before
    Stopwatch watch_;
    double next_noise_ = 0.0;
    double next_preview_ = 0.0, preview_seconds_ = 0.0; // when, and for how long until now; seconds
    double checkpoint_at_ = 0.0;                        // the last one
    bool stopped_ = false;
    bool gave_up_ = false; // paths were left in flight
    std::optional<double> stopped_at_;

    // Where there are several devices. The session's own is the first member, and those of its followers come after.
    const bool leads_;
    std::vector<std::unique_ptr<Follower>> followers_;
    // For each band from which row on each member has what was rendered of it, and the band's end.
    std::vector<std::vector<std::uint32_t>> edges_;
    std::vector<double> speeds_;             // of each member, in samples per second; 0: not known
    std::atomic<Order> order_{Order::go_on}; // to all followers
    Stopwatch share_watch_;
    double share_seconds_ = 0.0;     // of what the session's own device had of the last band
    std::uint64_t device_bytes_ = 0; // there
    std::uint64_t paths_before_ = 0; // of the checkpoint that the render goes on from
    bool rests_ = false;             // nothing is in flight there
    bool divided_ = false;           // the band under way has whole rows to render
};

// All of the scene's samples.
RenderResult render(const Device& device, const Scene& scene, const RenderJob& job);

} // namespace vkvol
