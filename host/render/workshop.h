// What the frames of a sequence share: the device, what is compiled for it, the grids, and what was said already. One
// picture is a sequence without further frames.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "device.h"
#include "field_cache.h"
#include "pipeline_cache.h"

namespace vkvol {

class Workshop {
public:
    explicit Workshop(bool has_frames) : has_frames_(has_frames) {}

    // Whether what is read is worth its memory once a frame has it on the device.
    bool has_frames() const { return has_frames_; }
    // Opened when it is first asked for.
    const Device& device(const DeviceOptions& options) {
        if (!device_)
            device_.emplace(options);
        return *device_;
    }
    // Of that device.
    const PipelineCache& pipelines(bool use_disk) {
        if (!pipelines_)
            pipelines_.emplace(*device_, use_disk);
        return *pipelines_;
    }
    FieldCache& fields() { return fields_; }
    // The grids of the next frame, to be read while one renders whose own are on the device.
    void set_next(std::vector<GridFile> files) { next_ = std::move(files); }
    const std::vector<GridFile>& next() const { return next_; }

    // Those of `warnings` that no frame has given yet.
    std::vector<std::string> new_warnings(const std::vector<std::string>& warnings) {
        std::vector<std::string> unheard;
        for (const std::string& warning : warnings)
            if (warned_.insert(warning).second)
                unheard.push_back(warning);
        return unheard;
    }

private:
    bool has_frames_;
    std::optional<Device> device_;
    std::optional<PipelineCache> pipelines_; // goes before its device
    FieldCache fields_;
    std::vector<GridFile> next_;
    std::set<std::string> warned_;
};

} // namespace vkvol
