#include "view_board.h"

#include <utility>

namespace vkvol {

void ViewBoard::publish(Shot shot) {
    {
        const std::scoped_lock lock(mutex_);
        shot.version = ++versions_;
        shot_ = std::make_shared<const Shot>(std::move(shot));
    }
    changed_.notify_all();
}

// What is wrong is a new state of the picture that there is.
void ViewBoard::say(const std::string& message) {
    {
        const std::scoped_lock lock(mutex_);
        if (message_ == message)
            return;
        message_ = message;
        Shot again = shot_ ? *shot_ : Shot{};
        again.version = ++versions_;
        shot_ = std::make_shared<const Shot>(std::move(again));
    }
    changed_.notify_all();
}

ViewWish ViewBoard::wish(std::uint64_t* number) const {
    const std::scoped_lock lock(mutex_);
    if (number)
        *number = wish_number_;
    return wish_;
}

std::uint64_t ViewBoard::wish_number() const {
    const std::scoped_lock lock(mutex_);
    return wish_number_;
}

void ViewBoard::forget_camera() {
    const std::scoped_lock lock(mutex_);
    wish_.edits.camera.reset();
}

void ViewBoard::forget_lights() {
    const std::scoped_lock lock(mutex_);
    wish_.edits.lights.clear();
}

double ViewBoard::seconds_unwatched() const {
    const std::scoped_lock lock(mutex_);
    return std::chrono::duration<double>(Clock::now() - watched_).count();
}

void ViewBoard::wait_for_wish(std::uint64_t number, std::chrono::milliseconds time) const {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, time, [&] { return closed_ || wish_number_ != number; });
}

std::uint64_t ViewBoard::want(ViewWish wish) {
    std::uint64_t number = 0;
    {
        const std::scoped_lock lock(mutex_);
        wish_ = std::move(wish);
        watched_ = Clock::now();
        number = ++wish_number_;
    }
    changed_.notify_all();
    return number;
}

std::shared_ptr<const Shot> ViewBoard::shot() const {
    const std::scoped_lock lock(mutex_);
    return shot_;
}

std::shared_ptr<const Shot> ViewBoard::next_shot(std::uint64_t version, std::chrono::milliseconds time) {
    std::unique_lock lock(mutex_);
    watched_ = Clock::now();
    changed_.wait_for(lock, time, [&] { return closed_ || (shot_ && shot_->version > version); });
    watched_ = Clock::now();
    return shot_;
}

void ViewBoard::see() {
    const std::scoped_lock lock(mutex_);
    watched_ = Clock::now();
}

std::string ViewBoard::message(std::uint64_t* version) const {
    const std::scoped_lock lock(mutex_);
    if (version)
        *version = versions_;
    return message_;
}

void ViewBoard::close() {
    {
        const std::scoped_lock lock(mutex_);
        closed_ = true;
    }
    changed_.notify_all();
}

} // namespace vkvol
