// What `vkvol scene.xml` says of a render, besides its progress.
#pragma once

#include "explain.h"
#include "render_request.h"
#include "session.h"

namespace vkvol {

void print_warnings(const std::vector<std::string>& warnings);

// Why the picture shows nothing.
void print_explanation(const Explanation& explanation);

// One line for each kind of thing that makes the picture less than it claims to be.
std::vector<std::string> caps_text(const RenderCounts& counts);

// These, and for samples that were not finite the command that follows their path.
void print_caps(const RenderRequest& request, const RenderResult& result);

// Prints what the validation layer has said, each once. Throws RenderError if that is anything.
void check_validation(const Device& device);

// What is said of devices, where several rendered: "A + B".
std::string of_all_devices(const Device& first, const RenderResult& result, std::string DeviceInfo::*text);

// Why there is no sample, and so no picture.
std::string no_samples_text(const RenderResult& result);

} // namespace vkvol
