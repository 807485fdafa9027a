// What `vkvol scene.xml` says of a render, besides its progress.
#pragma once

#include "explain.h"
#include "options.h"
#include "renderer.h"

namespace vkvol {

void print_warnings(const RenderOptions& options, const std::vector<std::string>& warnings);

// Where the command line can be read in two ways: which was taken.
void print_reading(const RenderOptions& options);

// Why the picture shows nothing.
void print_explanation(const RenderOptions& options, const Explanation& explanation);

// One line for each kind of thing that makes the picture less than it claims to be; for samples that were not finite
// also the command that follows their path.
void print_caps(const RenderOptions& options, const RenderResult& result);

// Where the picture is, samples per pixel, seconds, noise, what of the tone is unusual, and device.
void print_summary(const RenderOptions& options, const Device& device, const RenderResult& result, const Tone& tone);

// Why there is no sample, and so no picture.
std::string no_samples_text(const RenderResult& result);

} // namespace vkvol
