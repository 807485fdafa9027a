#include "checkpoint_file.h"

#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <unistd.h>

#include "atomic_file.h"
#include "error.h"
#include "image_io.h"
#include "messages.h"

namespace vkvol {

CheckpointFile::CheckpointFile(const RenderOptions& options) : options_(options) {
    if (!options.checkpoint && !options.resume)
        return;
    path_ = options.outputs.front();
    path_.replace_extension(".checkpoint");
}

// What lies in that place and is no checkpoint; empty: nothing.
std::string CheckpointFile::not_ours() const {
    std::error_code ignored;
    if (!std::filesystem::exists(path_, ignored) || is_checkpoint(path_))
        return "";
    if (access(path_.c_str(), R_OK) != 0)
        return fmt::format("{}: cannot be read: {}, and stays; change its permissions, or name another picture with -o",
                           path_.string(), std::strerror(errno));
    return fmt::format("{}: {}, and stays; rename it, or name another picture with -o", path_.string(),
                       std::filesystem::is_directory(path_, ignored) ? "is a directory" : "is no checkpoint of vkvol");
}

void CheckpointFile::check() const {
    if (path_.empty())
        return;
    if (const std::string other = not_ours(); !other.empty())
        throw InputError(other);
    if (!options_.checkpoint)
        return;
    if (is_special(options_.outputs.front()))
        throw InputError(fmt::format("--checkpoint: a checkpoint lies beside the first output, but {} is no file; name "
                                     "one first with -o",
                                     options_.outputs.front().string()));
    check_directory_writable(path_);
    if (!options_.resume && is_checkpoint(path_))
        throw InputError(fmt::format("{}: a checkpoint is there already, whose samples would be lost; go on from it "
                                     "with --resume, or remove or rename it to begin anew",
                                     path_.string()));
}

const std::optional<Checkpoint>& CheckpointFile::find() {
    if (!options_.resume)
        return from_;
    std::error_code ignored;
    if (std::filesystem::exists(path_, ignored))
        from_ = load_checkpoint(path_);
    else if (!options_.quiet)
        tell(stderr, "vkvol: note: there is no {}: the render begins anew\n", path_.string());
    return from_;
}

void CheckpointFile::keep(const Checkpoint& checkpoint) {
    try {
        if (const std::string other = not_ours(); !other.empty()) // since the render began
            throw RenderError(other);
        save_checkpoint(path_, checkpoint);
        saved_ = checkpoint.done;
    } catch (const std::exception& error) {
        tell(stderr, "vkvol: warning: {}: {}\n", error.what(),
             is_checkpoint(path_) ? "the last checkpoint stays" : "there is no checkpoint yet");
    }
}

void CheckpointFile::remove() {
    std::error_code ignored;
    if ((saved_ || from_) && is_checkpoint(path_))
        std::filesystem::remove(behind_links(path_), ignored);
}

std::string CheckpointFile::advice() const {
    if (!saved_ && !from_)
        return "";
    return fmt::format("; {} holds {} samples per pixel: the same command with --resume goes on from there",
                       path_.string(), saved_.value_or(from_ ? from_->done : 0));
}

} // namespace vkvol
