// A folder to run the program in, as its users do.
#pragma once

#include <filesystem>
#include <string>

#include "shell.h"

namespace vkvol {

// Empty but for one scene, ball.xml: a ball of optical depth 4 and what else `elements` says. Goes with its contents.
class Folder {
public:
    explicit Folder(const std::string& elements);
    ~Folder();
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    // On the device under test. `before` stands before the program's name: environment, or another command.
    Run vkvol(const std::string& arguments, const std::string& before = "") const;
    // A shell's script, with the program as $vkvol.
    Run script(const std::string& text) const;
    std::filesystem::path file(const std::string& name) const { return path_ / name; }
    std::string text(const std::string& name) const; // of a file; empty if there is none
    void write(const std::string& name, const std::string& text) const;

private:
    std::filesystem::path path_;
};

} // namespace vkvol
