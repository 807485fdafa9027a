// A directory of its own for a test, which goes with it.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>

namespace vkvol {

struct TestDirectory {
    std::filesystem::path path = std::filesystem::temp_directory_path() / ("vkvol_files_" + std::to_string(::getpid()));

    TestDirectory() { std::filesystem::create_directories(path); }
    ~TestDirectory() { std::filesystem::remove_all(path); }
    std::filesystem::path write(const std::string& name, const std::string& text) const {
        std::ofstream(path / name, std::ios::binary) << text;
        return path / name;
    }
};

} // namespace vkvol
