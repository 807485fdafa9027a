#include "file_ending.h"

namespace vkvol {

std::string file_ending(const std::filesystem::path& file) {
    std::string ending = file.extension().string();
    for (char& c : ending)
        if (c >= 'A' && c <= 'Z') // whatever the locale says
            c = static_cast<char>(c - 'A' + 'a');
    return ending;
}

bool is_grid_file(const std::filesystem::path& file) {
    const std::string ending = file_ending(file);
    return ending == ".nvdb" || ending == ".vdb";
}

} // namespace vkvol
