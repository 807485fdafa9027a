// What a render was and did, for machines: the JSON of --report and the metadata of an EXR.
#pragma once

#include <string>

#include "device.h"
#include "explain.h"
#include "film.h"
#include "render_request.h"
#include "session.h"

namespace vkvol {

Metadata make_metadata(const RenderRequest& request, const Scene& scene, const Device& device,
                       const RenderResult& result);

// How a picture is shown, and why it shows nothing, if it does not.
struct Shown {
    Tone tone; // of 8-bit pictures; without pixels if there are none
    std::optional<Explanation> explanation;
};

// JSON text; the fields are documented in the README. `write_seconds`: spent on image files. `error`: why the render
// failed; empty: it did not.
std::string make_report(const RenderRequest& request, const Scene& scene, const Device& device,
                        const RenderResult& result, const Shown& shown, double write_seconds,
                        const std::string& error = "");

// Report of a render without a result: what is known all the same. `device` may be null.
std::string make_failure_report(const RenderRequest& request, const Scene& scene, const DeviceInfo* device,
                                const std::string& error);

} // namespace vkvol
