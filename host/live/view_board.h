// What a viewer and the render that it watches tell each other: wishes one way, states of the picture the other. Any
// thread may call anything.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "film.h"
#include "scene_edits.h"

namespace vkvol {

struct ViewWish {
    SceneEdits edits;
    std::string layer = "picture"; // or "noise", or a layer's name
    bool paused = false;
};

// The scene as it is rendered, for a viewer's controls.
struct ViewedScene {
    std::string name;            // of its file
    bool has_grids = false;      // that no file has
    std::string xml;             // with the edits
    Camera camera;               // as edited
    bool has_view = false;       // it looks, and reads no flux
    glm::dvec3 target{0.0};      // what to turn about, world
    std::vector<Shining> lights; // as edited
    std::string integrator;      // that renders it
    std::string biased;          // why; or empty
    std::string device;
    std::uint64_t wish = 0;   // the wish's number
    std::uint64_t number = 0; // another one whenever the picture is begun anew
};

// A picture at some time; never changed.
struct Shot {
    std::uint64_t version = 0; // ascends
    std::shared_ptr<const ViewedScene> scene;
    Film film;
    Metadata metadata;
    std::uint32_t samples = 0;
    double seconds = 0.0; // of rendering
    std::shared_ptr<const Film>
        sketch;             // of the same view in fewer pixels, as long as the picture is not whole; or null
    bool is_sketch = false; // the film is that itself
    bool is_done = false;
};

class ViewBoard {
public:
    // The render's side.
    void publish(Shot shot);              // gets its version
    void say(const std::string& message); // what is wrong with the scene at present; empty: nothing
    ViewWish wish(std::uint64_t* number = nullptr) const;
    std::uint64_t wish_number() const;
    void forget_camera(); // the file has another
    void forget_lights();
    double seconds_unwatched() const;
    // Until there is another wish than `number`, or the time is over.
    void wait_for_wish(std::uint64_t number, std::chrono::milliseconds time) const;

    // The viewer's side.
    std::uint64_t want(ViewWish wish); // its number
    std::shared_ptr<const Shot> shot() const;
    // As soon as it is newer than `version`, or when the time is over; may be null.
    std::shared_ptr<const Shot> next_shot(std::uint64_t version, std::chrono::milliseconds time);
    void see(); // it is looking
    std::string message(std::uint64_t* version = nullptr) const;
    void close(); // nobody waits any more

private:
    using Clock = std::chrono::steady_clock;

    mutable std::mutex mutex_;
    mutable std::condition_variable changed_;
    ViewWish wish_;
    std::uint64_t wish_number_ = 1;
    std::shared_ptr<const Shot> shot_;
    std::string message_;
    std::uint64_t versions_ = 0;
    Clock::time_point watched_ = Clock::now();
    bool closed_ = false;
};

} // namespace vkvol
