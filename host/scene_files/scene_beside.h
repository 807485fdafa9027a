// The scene that a picture was rendered by, kept beside it: a file of its own, or of its user once that has changed it.
#pragma once

#include <filesystem>
#include <string>

namespace vkvol {

// The text with a comment ahead that says what it is, and by which is_untouched() knows it again.
std::string marked(const std::string& scene);

// Is this as marked() made it?
bool is_untouched(const std::string& text);

// The file as a scene in the folder `beside` names it. Throws InputError for names that no scene can hold.
std::string name_beside(const std::filesystem::path& file, const std::filesystem::path& beside);

// NAME.xml for a picture NAME.exr; NAME-2.xml, ... where that is there and not ours to replace.
std::filesystem::path scene_beside(const std::filesystem::path& picture);

} // namespace vkvol
