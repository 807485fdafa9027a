// Opening pictures of which nothing is known yet.
#pragma once

#include <filesystem>
#include <memory>

#include "picture_codec.h"

namespace vkvol {

// Reads the header, and holds what it states against the file. Throws InputError.
std::unique_ptr<PictureReader> open_image(const std::filesystem::path& file);

// Whether colours are of Rec.709's primaries, as those of sRGB are. An .exr that says nothing of them is of these.
bool is_rec709(const PictureHeader& header);

[[noreturn]] void fail_to_read(const std::filesystem::path& file, const PictureReader& reader);

} // namespace vkvol
