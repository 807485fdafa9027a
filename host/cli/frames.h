// Frames of a sequence: which there are, and what their files are called.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "options.h"

namespace vkvol {

// "3", "1..8", "1..48x4" (every fourth), "8..1", and several of these between commas; each frame once. Throws
// InputError.
std::vector<int> parse_frames(const std::string& text);

// As parse_frames reads it, short.
std::string frames_text(const std::vector<int>& frames);

// `name` with the frame's number in the place of ####, %04d, $F4, $F, ${F4} or ${F} in the file's name; where there is
// none of these before the extension, in four digits. Devices and pipes keep their name.
std::filesystem::path frame_file(const std::filesystem::path& name, int frame);

// The frames for which there is a file of that name, which has a place for their numbers, ascending. Throws InputError
// if it has none, or if there is no such file.
std::vector<int> frames_with_file(const std::filesystem::path& name);

// What renders this one of options.frames: its key F and its files.
RenderOptions frame_options(const RenderOptions& options, int frame);

// Puts the frames of -f into the options. Throws InputError for what does not go together with it.
void set_frames(RenderOptions& options, const std::string& text);

} // namespace vkvol
