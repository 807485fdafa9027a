// What gzip packed (RFC 1952).
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace vkvol {

// Whether a name ends in .gz before whose `ending`, of lower case, stands: "mesh.ply.gz", ".ply".
bool is_packed(const std::filesystem::path& file, const char* ending);

// The bytes themselves where they are not packed. Throws InputError, naming the file, if they are damaged, or would be
// more than `most`.
std::string unpacked(std::string bytes, const std::filesystem::path& file, std::size_t most);

} // namespace vkvol
