// Where the command line asked to see a picture while it is rendered.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "live_picture.h"
#include "options.h"
#include "progress.h"
#include "session.h"

namespace vkvol {

class LivePictures {
public:
    // Throws InputError where one takes no pictures, unless earlier frames were shown: then `missing` says so. Once
    // `tev_is_gone` it is not asked any more.
    LivePictures(const RenderOptions& options, const Scene& scene, bool tev_is_gone);

    const std::string& missing() const { return missing_; }

    bool empty() const { return pictures_.empty(); }
    // `progress` leaves its line to them.
    void show(const Device& device, const RenderResult& result, Progress* progress);

private:
    void show_all(const Device& device, const RenderResult& result, Progress* progress);

    const RenderOptions& options_;
    const Scene& scene_;
    std::string missing_;
    std::vector<std::unique_ptr<LivePicture>> pictures_;
};

} // namespace vkvol
