// Image files: EXR for data (mean, variance, samples, metadata), PNG for looking at.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "film.h"
#include "tone_map.h"

namespace vkvol {

// Every writer fills a new file that then takes the place of the old one: a file of this name is never half written.
// Failures throw RenderError with path, reason and remedy: `option` is the one that names another place.

// Throws InputError unless `path` ends as a picture we can write does and a file can be made there. Leaves nothing
// behind.
void check_writable(const std::filesystem::path& path);

// The same for any file (a report): only that it can be made, and what is there replaced.
void check_directory_writable(const std::filesystem::path& path, const char* option = "-o");

// Whether it is for looking at: .png.
bool is_display_file(const std::filesystem::path& path);

// By extension: .exr, .csv (see film_table.h), or for looking at.
void write_image(const std::filesystem::path& path, const Film& film, const Metadata& metadata,
                 const ToneMapping& mapping);

// All of them. What cannot be written is told when all have been tried, with what was written.
void write_images(const std::vector<std::filesystem::path>& paths, const Film& film, const Metadata& metadata,
                  const ToneMapping& mapping);

// ZIP; channels R, G, B, variance.R, variance.G, variance.B of floats, samples of whole numbers. Data window = crop,
// display = picture.
void write_exr(const std::filesystem::path& path, const Film& film, const Metadata& metadata,
               const char* option = "-o");

// 8 bit sRGB; the crop alone.
void write_display(const std::filesystem::path& path, const Film& film, const ToneMapping& mapping);

// R, G and B are required; a file without variance or samples gives zeros there, and no samples without variance: they
// would be without noise. Samples may be floats, as they were once. Throws InputError.
Film read_exr(const std::filesystem::path& path, Metadata* metadata = nullptr);

// Writes text the same atomic way.
void write_text(const std::filesystem::path& path, const std::string& text, const char* option = "-o");
// Likewise bytes, one part after another.
void write_parts(const std::filesystem::path& path, std::span<const std::span<const std::byte>> parts);

} // namespace vkvol
