// The checkpoint beside a render's first output: refused, written, gone on from, and removed when it is of no more use.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "checkpoint.h"
#include "options.h"

namespace vkvol {

class CheckpointFile {
public:
    explicit CheckpointFile(const RenderOptions& options);

    const std::filesystem::path& path() const { return path_; }

    // Before rendering. Throws InputError where --checkpoint would write over what is not this render's, or where no
    // file can be made.
    void check() const;

    // For --resume. Throws InputError if it cannot be gone on from.
    const std::optional<Checkpoint>& find();

    // One that cannot be written is no reason to end the render: a warning. What is no checkpoint is not replaced.
    void keep(const Checkpoint& checkpoint);

    // When the render is done. Only what this run wrote or went on from.
    void remove();

    // What a failure in the midst of a render leaves, to be added to its message; empty: nothing.
    std::string advice() const;

private:
    std::string not_ours() const;

    const RenderOptions& options_;
    std::filesystem::path path_; // empty: neither --checkpoint nor --resume
    std::optional<Checkpoint> from_;
    std::optional<std::uint32_t> saved_; // samples per pixel
};

} // namespace vkvol
