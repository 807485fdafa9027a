#include "view.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <memory>
#include <new>
#include <optional>
#include <system_error>
#include <utility>

#include "camera_view.h"
#include "error.h"
#include "integrators.h"
#include "interrupt.h"
#include "medium_outline.h"
#include "messages.h"
#include "render_notes.h"
#include "report.h"
#include "requested_scene.h"
#include "scene_xml.h"
#include "session.h"
#include "stopwatch.h"
#include "view_board.h"
#include "view_server.h"
#include "vulkan_error.h"
#include "watched_scene.h"
#include "workshop.h"

namespace vkvol {

namespace {

constexpr double seconds_between_polls = 0.5; // at the scene's file
constexpr double longest_unwatched = 10.0;    // seconds; then it waits until somebody looks again
constexpr int sketch_pixels = 20'000;         // of the first picture of a view
constexpr std::uint32_t sketch_samples = 2;
constexpr double patience = 0.3; // seconds that a view may still take to be shown, though another is wished by now
constexpr auto nap = std::chrono::milliseconds(200);

// Renders what the board wishes, one scene after another.
class Viewing {
public:
    Viewing(const ViewOptions& options, ViewBoard& board)
        : options_(options), board_(board), source_(options), device_(workshop_.device(options.request.device)) {}

    void run() {
        while (!interrupted()) {
            bool rendered = false;
            try {
                rendered = render_wish();
            } catch (const InputError& error) {
                board_.say(error.what());
            } catch (const VulkanError& error) {
                if (error.result == VK_ERROR_DEVICE_LOST) // for good
                    throw;
                session_.reset();
                board_.say(error.what());
            } catch (const RenderError& error) {
                session_.reset();
                board_.say(error.what());
            } catch (const std::bad_alloc&) {
                session_.reset();
                board_.say("there is no memory for that; take a smaller picture or grid");
            } catch (const std::system_error& error) { // no thread, say
                session_.reset();
                board_.say(error.what());
            }
            if (!rendered)
                wait_for_news();
        }
    }

    const Device& device() const { return device_; }

private:
    bool is_news() { return board_.wish_number() != wish_number_ || file_changed(); }

    // What cannot be read is told until it can be, and the picture stays that of what could.
    bool file_changed() {
        if (since_poll_.seconds() < seconds_between_polls)
            return has_new_file_;
        since_poll_.lap();
        try {
            if (source_.refresh()) {
                has_new_file_ = true;
                file_trouble_.clear();
            }
        } catch (const InputError& error) {
            file_trouble_ = error.what();
            board_.say(file_trouble_);
        }
        return has_new_file_;
    }

    void wait_for_news() {
        while (!interrupted() && !is_news())
            board_.wait_for_wish(wish_number_, nap);
    }

    // False: there is nothing more to do for this wish.
    bool render_wish() {
        const ViewWish wish = board_.wish(&wish_number_);
        if (std::exchange(has_new_file_, false)) { // whatever comes of it: what cannot be read is not read again
            // Grids that stand in it, or that it names, may be others.
            rendering_.clear();
            see_file_camera();
        }
        WatchedScene::Read read = read_with_layers(wish.layer);
        const std::string what = read.xml + '\n' + layers_ + asked_text(options_.request, read.scene);
        if (what != rendering_ || !session_) {
            begin(std::move(read), what, wish.paused);
        } else {
            describe(read.xml);
            if (session_->samples() > 0)
                publish(session_->result(), is_done_);
            else
                sketch(wish.paused);
        }
        board_.say(file_trouble_); // of this wish there is none
        try {
            return go_on(wish);
        } catch (const InputError&) { // of a later moment
            session_.reset();
            throw;
        }
    }

    // With all layers that were asked for so far, so that going back to one renders nothing anew; if the scene as it is
    // now cannot have some of them, with this one alone.
    WatchedScene::Read read_with_layers(const std::string& layer) {
        const std::string wanted = layer == "picture" || layer == "noise" ? "" : layer;
        std::string all = layers_;
        if (!wanted.empty() && ("," + all + ",").find("," + wanted + ",") == std::string::npos)
            all += (all.empty() ? "" : ",") + wanted;
        const SceneEdits edits = board_.wish().edits;
        try {
            WatchedScene::Read read = source_.read(edits, all, workshop_.fields());
            layers_ = all;
            return read;
        } catch (const InputError&) {
            if (all == wanted)
                throw;
        }
        WatchedScene::Read read = source_.read(edits, wanted, workshop_.fields());
        layers_ = wanted;
        return read;
    }

    // The viewer's camera and lights give way to those that the file has got meanwhile.
    void see_file_camera() {
        const WatchedScene::Read file = source_.read({}, "", workshop_.fields());
        std::string lights;
        for (const Shining& light : what_shines(file.xml))
            lights += light.name + (light.direction ? fmt::format(" {} {} {}\n", light.direction->x, light.direction->y,
                                                                  light.direction->z)
                                                    : "\n");
        if (lights != file_lights_)
            board_.forget_lights();
        file_lights_ = lights;
        const Camera& camera = file.scene.camera;
        const auto key = [](const Camera& c) {
            return fmt::format("{} {} {} {} {} {} {} {} {} {}", int(c.projection), c.position.x, c.position.y,
                               c.position.z, c.pitch, c.yaw, c.roll, c.fov, c.view_height, c.lens.focus);
        };
        if (key(camera) != key(file_camera_))
            board_.forget_camera();
        file_camera_ = camera;
    }

    // Of a view that is dragged about each is shown for a moment, though there is another already.
    bool is_outdated() {
        if (!is_news())
            return false;
        if (!since_asked_)
            since_asked_.emplace();
        return has_shown_ || since_asked_->seconds() > patience;
    }

    void begin(WatchedScene::Read read, const std::string& what, bool is_paused) {
        session_.reset();
        has_shown_ = false;
        since_asked_.reset();
        rendering_.clear();
        ++begun_;
        scene_ = std::move(read.scene);
        job_ = {};
        job_.workshop = &workshop_;
        job_.crop = {0, scene_.picture.width, 0, scene_.picture.height};
        job_.seed = options_.request.seed;
        job_.plan = options_.request.plan;
        job_.disk_cache = !options_.request.no_cache;
        job_.noise_goal = options_.request.noise_goal;
        job_.interrupted = [this] {
            return interrupted() || is_outdated() || board_.seconds_unwatched() > longest_unwatched;
        };
        describe(read.xml);
        if (!options_.quiet)
            print_warnings(workshop_.new_warnings(scene_.warnings));
        sketch(is_paused);
        if (interrupted() || is_outdated())
            return;
        job_.preview = [this](const RenderResult& result) { publish(result, false); };
        session_.emplace(device_, scene_, job_);
        since_asked_.reset(); // that took its time
        if (!options_.quiet)
            print_warnings(workshop_.new_warnings(session_->warnings()));
        rendering_ = what;
        is_done_ = false;
    }

    void describe(const std::string& xml) {
        auto viewed = std::make_shared<ViewedScene>();
        viewed->name = source_.name();
        viewed->xml = xml;
        viewed->has_grids = source_.has_grids();
        viewed->camera = scene_.camera;
        viewed->has_view = !reads_flux(scene_.camera);
        viewed->lights = what_shines(xml);
        viewed->device = device_.info().name;
        viewed->wish = wish_number_;
        viewed->number = begun_;
        viewed_ = std::move(viewed);
    }

    // A small picture at once, where the whole one takes longer, or does not come.
    void sketch(bool is_paused) {
        sketch_.reset();
        const double pixels = double(scene_.picture.width) * scene_.picture.height;
        if ((pixels < 3.0 * sketch_pixels && !is_paused) || reads_flux(scene_.camera))
            return;
        Scene small = scene_;
        if (pixels > sketch_pixels)
            resize_picture(small.picture, int(std::max(scene_.picture.width * std::sqrt(sketch_pixels / pixels), 1.0)),
                           std::nullopt);
        RenderJob job = job_;
        job.preview = nullptr; // of another session, whose pictures are whole ones
        job.crop = {0, small.picture.width, 0, small.picture.height};
        job.interrupted = [this] { return interrupted() || is_outdated(); }; // also while nobody looks: it is soon done
        Session session(device_, small, job);
        session.render(sketch_samples);
        if (session.samples() == 0) // there is news
            return;
        is_sketch_ = true;
        publish(session.result(), false);
        is_sketch_ = false;
        sketch_ = std::make_shared<const Film>(session.result().film);
    }

    // Until there is news, or all is rendered.
    bool go_on(const ViewWish& wish) {
        if (session_ && wish.paused && !has_shown_)
            publish(session_->result(), false);
        if (!session_ || wish.paused)
            return false;
        while (!interrupted() && !is_outdated()) {
            if (board_.seconds_unwatched() > longest_unwatched) {
                board_.wait_for_wish(wish_number_, nap);
                continue;
            }
            if (!session_->can_go_on()) { // paths were abandoned while nobody looked, or it was paused
                session_.reset();
                return true;
            }
            session_->render(scene_.settings.spp);
            if (!session_->result().interrupted) {
                is_done_ = true;
                publish(session_->result(), true);
                return is_news();
            }
        }
        return true;
    }

    void publish(const RenderResult& result, bool is_done) {
        has_shown_ = has_shown_ || result.samples > 0;
        auto viewed = std::make_shared<ViewedScene>(*viewed_);
        viewed->integrator = result.integrator;
        viewed->biased = result.biased;
        viewed->target = target_of(result.outline, viewed->camera);
        Shot shot;
        shot.scene = std::move(viewed);
        shot.film = result.film;
        shot.metadata = make_metadata(options_.request, scene_, device_, result);
        shot.samples = result.samples;
        shot.seconds = result.render_seconds;
        shot.is_sketch = is_sketch_;
        if (result.samples == 0)
            shot.sketch = sketch_;
        shot.is_done = is_done;
        board_.publish(std::move(shot));
    }

    // The middle of the medium, as far as it has one.
    static glm::dvec3 target_of(const MediumOutline& outline, const Camera& camera) {
        const glm::dvec3 ahead = camera.position - 10.0 * camera_rotation(camera)[2];
        if (!outline.exists)
            return ahead;
        const WorldBox box = world_box(outline);
        const bool is_far =
            glm::length(box.high - box.low) > 1e3 * glm::length(camera.position - 0.5 * (box.low + box.high));
        return is_far ? ahead : 0.5 * (box.low + box.high);
    }

    const ViewOptions& options_;
    ViewBoard& board_;
    Workshop workshop_{true};
    WatchedScene source_;
    const Device& device_;
    std::uint64_t wish_number_ = 0, begun_ = 0;
    Stopwatch since_poll_;
    bool has_new_file_ = true;
    std::string file_trouble_; // of the file as it is now; or empty
    Camera file_camera_;
    std::string file_lights_; // what shines, by name
    std::string layers_;      // all that were asked for so far
    Scene scene_;
    RenderJob job_;
    std::shared_ptr<const ViewedScene> viewed_;
    std::optional<Session> session_;
    std::string rendering_;              // what the session is of
    std::shared_ptr<const Film> sketch_; // of the session's view
    bool is_sketch_ = false, is_done_ = false;
    bool has_shown_ = false;               // anything of this view,
    std::optional<Stopwatch> since_asked_; // which was news first then
};

} // namespace

int run_view(const ViewOptions& options) {
    install_interrupt_handler();
    ViewBoard board;
    Viewing viewing(options, board);
    std::vector<std::string> names;
    for (const Integrator& integrator : integrators())
        names.emplace_back(integrator.name);
    const ViewServer server(board, options.port, names);
    tell(stdout, "{}\n", server.address());
    if (!options.quiet)
        tell(stderr, "{}: open that address in a browser of this machine; Ctrl-C ends it\n",
             options.request.scene.string());
    std::fflush(stdout);
    viewing.run();
    check_validation(viewing.device());
    return exit_done;
}

} // namespace vkvol
