// What `vkvol scene.xml` says of a picture when it is done, and of how its command line was read.
#pragma once

#include <cstdio>

#include "options.h"
#include "session.h"

namespace vkvol {

// Standard output, or standard error where a picture, a table or the report goes to that.
std::FILE* stream_for_words(const std::vector<std::filesystem::path>& outputs,
                            const std::optional<std::filesystem::path>& report);

// Where the command line can be read in two ways: which was taken.
void print_reading(const RenderOptions& options);

// Where the picture is, samples per pixel, seconds, noise, what of the tone is unusual, and device.
void print_summary(const RenderOptions& options, const Device& device, const RenderResult& result, const Tone& tone);

} // namespace vkvol
