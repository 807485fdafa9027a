// Input files that cannot be read, told apart: each reason has a remedy of its own.
#pragma once

#include <filesystem>
#include <string>

namespace vkvol {

// Throws InputError unless it is a regular file that this user may read. `hint`: what helps if there is none of this
// name. Never waits: a pipe is refused unopened.
void check_input_file(const std::filesystem::path& file, const std::string& hint);

// Throws InputError of a pipe or device, which gives its text but once. `reader`: "-f reads the scene for each frame".
void check_read_again(const std::filesystem::path& file, const std::string& reader);

// All of a text that may also come through a pipe, up to `longest` bytes and one more. Throws InputError as above, and
// Interrupted when a signal ends the wait for what the pipe will bring.
std::string read_input_text(const std::filesystem::path& file, std::size_t longest, const std::string& hint);

} // namespace vkvol
