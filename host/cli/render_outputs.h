// What a render leaves: pictures and a report. What cannot be written is no reason to lose the rest.
#pragma once

#include <optional>
#include <string>

#include "options.h"
#include "report.h"

namespace vkvol {

// Whether a picture is written that is for looking at.
bool shows(const RenderOptions& options);

class RenderOutputs {
public:
    RenderOutputs(const RenderOptions& options, const Scene& scene) : options_(options), scene_(scene) {}

    // For the report, should the render fail.
    void set_device(const DeviceInfo& device) { device_ = device; }

    // Pictures and report. All are tried before RenderError says which failed, and which are there.
    // `objection`: that of the validation layer, for the report, or nothing.
    void write(const Device& device, const RenderResult& result, const Shown& shown, const std::string& objection);

    // The report alone, of a render that has a result, but no picture.
    void write_report(const Device& device, const RenderResult& result, const std::string& error);

    // The report of a render that failed, unless it was written before. Does not throw.
    void fail(const std::string& error);

private:
    bool try_report(const std::string& json, std::string& failure);

    const RenderOptions& options_;
    const Scene& scene_;
    std::optional<DeviceInfo> device_;
    bool reported_ = false; // or tried to
};

} // namespace vkvol
