#include "scene_beside.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <fstream>
#include <iterator>

#include "digest.h"
#include "error.h"
#include "one_line.h"

namespace vkvol {

namespace {

constexpr const char* before = "<?xml version=\"1.0\"?>\n"
                               "<!-- What vkvol chose, to start from. It is made anew with the picture until somebody "
                               "changes it (mark ";
constexpr const char* after = "). -->\n";

bool may_be_written(const std::filesystem::path& file) {
    std::error_code error;
    if (!std::filesystem::exists(file, error))
        return true;
    if (!std::filesystem::is_regular_file(file, error))
        return false;
    std::ifstream stream(file, std::ios::binary);
    std::string text(1 << 16, '\0'); // longer than any of ours
    stream.read(text.data(), std::streamsize(text.size()));
    text.resize(std::size_t(stream.gcount()));
    return is_untouched(text);
}

} // namespace

std::string marked(const std::string& scene) {
    return before + digest_text(scene) + after + scene;
}

bool is_untouched(const std::string& text) {
    const std::size_t end = text.find(after);
    return end != std::string::npos && text == marked(text.substr(end + std::string(after).size()));
}

std::string name_beside(const std::filesystem::path& file, const std::filesystem::path& beside) {
    std::error_code error;
    std::filesystem::path name = file;
    if (file.is_relative()) {
        name = std::filesystem::relative(file, beside.empty() ? "." : beside, error);
        // Scenes take the .. of a name as text, which behind a link leads elsewhere.
        if (error || name.empty() || !std::filesystem::equivalent((beside / name).lexically_normal(), file, error))
            name = std::filesystem::absolute(file);
    }
    const std::string text = name.string();
    const bool odd = std::any_of(text.begin(), text.end(),
                                 [](char c) { return c == '\\' || std::iscntrl(static_cast<unsigned char>(c)); });
    if (odd)
        throw InputError(fmt::format("{}: a scene cannot name this file, for its \\ or control characters; rename it",
                                     one_line(file.string())));
    return text.starts_with(' ') ? "./" + text : text;
}

std::filesystem::path scene_beside(const std::filesystem::path& picture) {
    std::filesystem::path file = picture;
    file.replace_extension(".xml");
    for (int i = 2; !may_be_written(file); ++i)
        file.replace_filename(fmt::format("{}-{}.xml", picture.stem().string(), i));
    return file;
}

} // namespace vkvol
