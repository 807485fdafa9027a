// What the frames of a sequence share: the device, what is compiled for it, the grids, and what was said already. One
// picture is a sequence without further frames.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "device.h"
#include "field_cache.h"
#include "pipeline_cache.h"
#include "sky_map.h"

namespace vkvol {

class Workshop {
public:
    explicit Workshop(bool has_frames) : has_frames_(has_frames) {}

    // Whether what is read is worth its memory once a frame has it on the device.
    bool has_frames() const { return has_frames_; }
    // Opened when it is first asked for.
    const Device& device(const DeviceOptions& options) { return *open({options}).front(); }
    // Likewise each of several, of which the first leads.
    std::vector<const Device*> devices(const DeviceOptions& options) { return open(each_device(options)); }
    // Pipelines of one of the devices. From any thread.
    const PipelineCache& pipelines(const Device& device, bool use_disk) {
        const std::scoped_lock lock(mutex_);
        return pipelines_.try_emplace(&device, device, use_disk).first->second;
    }
    FieldCache& fields() { return fields_; }
    SkyCache& skies() { return skies_; }
    // The grids of the next frame, to be read while one renders whose own are on the device.
    void set_next(std::vector<GridFile> files) { next_ = std::move(files); }
    const std::vector<GridFile>& next() const { return next_; }

    bool viewer_is_gone = false; // which earlier frames were shown to

    // Those of `warnings` that no frame has given yet.
    std::vector<std::string> new_warnings(const std::vector<std::string>& warnings) {
        std::vector<std::string> unheard;
        for (const std::string& warning : warnings)
            if (warned_.insert(warning).second)
                unheard.push_back(warning);
        return unheard;
    }

private:
    std::vector<const Device*> open(const std::vector<DeviceOptions>& wanted) {
        if (devices_.empty())
            for (const DeviceOptions& options : wanted)
                devices_.push_back(std::make_unique<Device>(options));
        std::vector<const Device*> opened;
        for (const auto& device : devices_)
            opened.push_back(device.get());
        return opened;
    }

    bool has_frames_;
    std::vector<std::unique_ptr<Device>> devices_;
    std::mutex mutex_;
    std::map<const Device*, PipelineCache> pipelines_; // go before their devices
    FieldCache fields_;
    SkyCache skies_;
    std::vector<GridFile> next_;
    std::set<std::string> warned_;
};

} // namespace vkvol
