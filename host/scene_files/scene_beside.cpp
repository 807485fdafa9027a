#include "scene_beside.h"

#include <fmt/format.h>
#include <fstream>
#include <iterator>

#include "digest.h"

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

std::filesystem::path scene_beside(const std::filesystem::path& picture) {
    std::filesystem::path file = picture;
    file.replace_extension(".xml");
    for (int i = 2; !may_be_written(file); ++i)
        file.replace_filename(fmt::format("{}-{}.xml", picture.stem().string(), i));
    return file;
}

} // namespace vkvol
