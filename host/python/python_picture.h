// A picture as Python has it: a film, and what was done for it.
#pragma once

#include <filesystem>
#include <string>

#include "film.h"
#include "tone_choice.h"

namespace vkvol::python {

struct PythonPicture {
    Film film;
    Metadata metadata;
    std::string report;             // JSON, as of --report
    std::vector<std::string> notes; // what makes it less than it claims to be
};

// By its ending; see write_image. Throws RenderError.
void write_picture(const PythonPicture& picture, const std::filesystem::path& file, const ToneRequest& tone);

// Three bytes a pixel, rows top to bottom.
std::vector<std::uint8_t> developed(const PythonPicture& picture, const ToneRequest& tone);

} // namespace vkvol::python
