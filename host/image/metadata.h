// The metadata of an image read back, whoever wrote it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "film.h"

namespace vkvol {

// As text, whatever its type; empty if it is not there.
std::string text_of(const Metadata& metadata, const std::string& key);

// A whole number, stored as one or as text; none if it is not there. Throws InputError, naming the image, for anything
// else.
std::optional<std::uint64_t> count_of(const Metadata& metadata, const std::string& key, const std::string& image);

// How the errors of the film's pixels go together, and whether what is behind the media is left out, whatever the
// metadata said of that before; and back.
void record_facts(const Film& film, Metadata& metadata);
void read_facts(const Metadata& metadata, Film& film);

} // namespace vkvol
