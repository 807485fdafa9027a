#include "command_folder.h"

#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <unistd.h>

#include "test_paths.h"

namespace vkvol {

Folder::Folder(const std::string& elements)
    : path_(std::filesystem::temp_directory_path() / fmt::format("vkvol-command-{}", getpid())) {
    std::filesystem::create_directories(path_);
    write("ball.xml", "<options><sphere radius=\"1\"/><sigma_a>1</sigma_a><sigma_s>1</sigma_s>"
                      "<width>16</width><height>16</height><rayPerPixelCount>8</rayPerPixelCount>"
                      "<camera z=\"5\" fov=\"30\"/><backgroundColor r=\"1\" g=\"1\" b=\"1\"/>" +
                          elements + "</options>");
}

Folder::~Folder() {
    std::filesystem::remove_all(path_);
}

Run Folder::vkvol(const std::string& arguments, const std::string& before) const {
    const char* device = std::getenv("VKVOL_TEST_DEVICE");
    return run(fmt::format("cd '{}' && {} '{}' {}{}", path_.string(), before, VKVOL_BINARY, arguments,
                           device ? fmt::format(" --device '{}'", device) : ""));
}

Run Folder::script(const std::string& text) const {
    return run(fmt::format("cd '{}' && vkvol='{}' && {{ {}\n}}", path_.string(), VKVOL_BINARY, text));
}

std::string Folder::text(const std::string& name) const {
    std::ifstream stream(file(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

void Folder::write(const std::string& name, const std::string& text) const {
    std::ofstream(file(name + ".new"), std::ios::binary) << text;
    std::filesystem::rename(file(name + ".new"), file(name)); // so that nobody reads a part of it
}

} // namespace vkvol
