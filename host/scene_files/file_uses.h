// Which files a run reads and which it writes: what is read may not be written over, and no file be written twice.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "input_files.h"
#include "scene.h"

namespace vkvol {

class FileUses {
public:
    // `what` stands in messages: "the scene".
    void reads(const std::string& what, const std::filesystem::path& file);
    // All that the scene names: its density field, its models and their materials.
    void reads_files_of(const Scene& scene);
    // `option` is the one that gives the file its name: "-o".
    void writes(const std::string& what, const std::filesystem::path& file, const std::string& option);

    // Whether a file was written after all that is read: hashes know files by name and size, which one made anew may
    // have as before. False if that cannot be told.
    bool is_newer_than_inputs(const std::filesystem::path& file) const;

    struct Output {
        std::string what; // "the report"
        std::filesystem::path file;
        std::string option;
    };
    const std::vector<InputFile>& inputs() const { return inputs_; }
    const std::vector<Output>& outputs() const { return outputs_; }

    // Throws InputError for the first file of a scene that cannot be read: where many scenes are to be rendered, that
    // of a late one should not end it all after hours.
    void check_inputs() const;
    // Throws InputError that names both uses and the remedy. Other spellings and links are the same file; devices and
    // pipes may be used more than once.
    void check() const;

private:
    std::vector<InputFile> inputs_;
    std::vector<Output> outputs_;
};

// Absolute, without links in the part that is there: two spellings of a file have one.
std::filesystem::path real_name(const std::filesystem::path& file);

// Whether to write one would change the other, now or once they are there.
bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b);

} // namespace vkvol
