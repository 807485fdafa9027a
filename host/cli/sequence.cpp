#include "sequence.h"

#include <chrono>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "atomic_file.h"
#include "error.h"
#include "file_uses.h"
#include "frames.h"
#include "input_file.h"
#include "interrupt.h"
#include "memory_left.h"
#include "messages.h"
#include "render_command.h"
#include "render_scene.h"
#include "render_summary.h"
#include "rendered_before.h"
#include "workshop.h"

namespace vkvol {

namespace {

// Errors of one frame say which, and what there is of the others. `done`: frames.
template <class Work> auto of_frame(int frame, const std::vector<int>& done, const Work& work) {
    const auto message = [&](const std::exception& error) {
        return fmt::format("frame {}: {}{}", frame, error.what(),
                           done.empty() ? "" : fmt::format(" (frames {} are done)", frames_text(done)));
    };
    try {
        return work();
    } catch (const InputError& error) {
        throw InputError(message(error));
    } catch (const RenderError& error) {
        throw RenderError(message(error));
    }
}

// No frame may write what another one writes or reads. Each frame's own names are checked with the frame.
class FrameFiles {
public:
    void add(int frame, const FileUses& uses) {
        for (const InputFile& input : uses.inputs()) {
            if (is_special(input.file))
                continue;
            const auto reader = readers_.try_emplace(real_name(input.file), Use{frame, input.what}).first;
            if (const auto writer = writers_.find(reader->first); writer != writers_.end())
                fail_lost(input.file, {frame, input.what}, writer->second);
        }
        for (const FileUses::Output& output : uses.outputs()) {
            if (is_special(output.file))
                continue;
            const auto [writer, is_new] = writers_.try_emplace(real_name(output.file), Use{frame, output.what});
            if (!is_new && writer->second.frame != frame)
                throw InputError(fmt::format("{} is frame {}'s too, and one would be lost; let the names hold the "
                                             "frame in as many digits as the longest has, as #### does",
                                             output.file.string(), writer->second.frame));
            if (const auto reader = readers_.find(writer->first); reader != readers_.end())
                fail_lost(output.file, reader->second, {frame, output.what});
        }
    }

private:
    struct Use {
        int frame;
        std::string what;
    };
    using Uses = std::map<std::filesystem::path, Use>; // the first of each file

    [[noreturn]] static void fail_lost(const std::filesystem::path& file, const Use& reader, const Use& writer) {
        throw InputError(fmt::format("{} is {} in frame {}, and would be lost to {} of frame {}; give that another "
                                     "name",
                                     file.string(), reader.what, reader.frame, writer.what, writer.frame));
    }

    Uses writers_, readers_;
};

// For machines, which see the progress of each frame begin anew.
void announce(const RenderOptions& options, std::size_t index) {
    if (options.progress == ProgressStyle::json && !options.quiet)
        tell(stderr, "{{\"frame\": {}, \"index\": {}, \"frames\": {}}}\n", options.frames[index], index,
             options.frames.size());
}

// Beside those that are in memory. What is packed in a file may be some times as large.
bool fits_in_memory(const std::vector<GridFile>& grids) {
    constexpr std::uintmax_t room = 16;
    std::uintmax_t bytes = 0;
    std::error_code ignored;
    std::set<std::filesystem::path> files;
    for (const GridFile& grid : grids)
        if (!grid.memory && files.insert(grid.path).second)
            bytes += std::filesystem::file_size(grid.path, ignored);
    return bytes < memory_left() / room;
}

// The grids of the frame after this one, if that will be rendered.
std::vector<GridFile> next_grids(const RenderOptions& options, std::size_t index,
                                 const std::vector<std::vector<GridFile>>& grids) {
    if (options.dry_run || index + 1 >= grids.size()) // the last, or the checks were interrupted
        return {};
    const RenderOptions next = frame_options(options, options.frames[index + 1]);
    const bool is_there = options.resume && std::filesystem::exists(next.outputs.front());
    return is_there || !fits_in_memory(grids[index + 1]) ? std::vector<GridFile>{} : grids[index + 1];
}

// What was rendered before is not rendered again. `has_begun`: any frame was.
int render_frame(RenderOptions options, int frame, Workshop& workshop, bool& has_begun) {
    std::optional<int> code;
    if (options.resume)
        code = rendered_before(options, load_render_scene(options, workshop.fields()).scene);
    if (!code) {
        options.has_begun = std::exchange(has_begun, true);
        return render_picture(options, workshop);
    }
    if (!options.quiet)
        tell(stream_for_words(options.outputs, options.report), "frame {}: {} is there\n", frame,
             options.outputs.front().string());
    return *code;
}

void print_end(const RenderOptions& options, const std::vector<int>& done, int code, double seconds) {
    const std::size_t total = options.frames.size();
    if (code == exit_interrupted) {
        const std::vector<int> rest(options.frames.begin() + std::ptrdiff_t(done.size()), options.frames.end());
        tell(stderr, "vkvol: interrupted at frame {}: {} of {} frames are done; -f {} goes on{}\n", rest.front(),
             done.size(), total, frames_text(rest), options.checkpoint ? ", with --resume" : "");
    } else if (code == exit_render_failed) {
        tell(stderr, "vkvol: frame {} has no picture: {} of {} frames are done\n", options.frames[done.size()],
             done.size(), total);
    } else if (options.quiet) {
        return;
    } else if (options.dry_run) {
        tell(stdout, "{} frames checked: nothing is rendered, nothing written\n", total);
    } else {
        tell(stream_for_words(options.outputs, options.report), "{} frames ({}) in {:.1f} s\n", total,
             frames_text(options.frames), seconds);
    }
}

} // namespace

int run_sequence(const RenderOptions& options) {
    const auto start = std::chrono::steady_clock::now();
    check_read_again(options.scene, "-f reads the scene for each frame");
    Workshop workshop(true);
    std::vector<int> done;
    FrameFiles files;
    std::vector<std::vector<GridFile>> grids; // of each frame
    for (const int frame : options.frames) {
        if (interrupted())
            break;
        of_frame(frame, done, [&] {
            const RenderOptions one = frame_options(options, frame);
            CheckedPicture checked = check_picture(one, workshop);
            files.add(frame, checked.uses);
            grids.push_back(std::move(checked.grids));
        });
    }
    int code = exit_done;
    bool has_begun = false;
    for (std::size_t i = 0; i < options.frames.size() && code != exit_interrupted && code != exit_render_failed; ++i) {
        const int frame = options.frames[i];
        announce(options, i);
        workshop.set_next(next_grids(options, i, grids));
        const int result = interrupted() ? int(exit_interrupted) : of_frame(frame, done, [&] {
            return render_frame(frame_options(options, frame), frame, workshop, has_begun);
        });
        code = result == exit_done ? code : result; // caps of any frame
        if (result == exit_done || result == exit_caps_hit)
            done.push_back(frame);
    }
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    print_end(options, done, code, elapsed.count());
    return code;
}

} // namespace vkvol
