// Opening pictures of which nothing is known yet.
#pragma once

#include <OpenImageIO/imageio.h>
#include <filesystem>
#include <memory>
#include <string>

namespace vkvol {

// What OpenImageIO says of a failure, in a line.
std::string reason_of(const std::string& message);

// Reads the header, and holds what it states against the file. Throws InputError.
std::unique_ptr<OIIO::ImageInput> open_image(const std::filesystem::path& file);

[[noreturn]] void fail_to_read(const std::filesystem::path& file, const OIIO::ImageInput& input);

} // namespace vkvol
