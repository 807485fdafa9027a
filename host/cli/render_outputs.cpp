#include "render_outputs.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <fmt/format.h>
#include <unistd.h>

#include "error.h"
#include "file_ending.h"
#include "image_io.h"
#include "messages.h"
#include "reading_grid.h"

namespace vkvol {

namespace {

// Where the picture can be kept when its own place takes no file: a render is not lost to a full disk.
std::string rescue(const Film& film, const Metadata& metadata) {
    std::error_code error;
    const std::filesystem::path directory = std::filesystem::temp_directory_path(error);
    if (error)
        return "";
    std::filesystem::path file = directory / fmt::format("vkvol-rescued-{}.exr", getpid());
    for (int i = 2; std::filesystem::exists(file, error); ++i) // numbers of processes come again
        file = directory / fmt::format("vkvol-rescued-{}-{}.exr", getpid(), i);
    try {
        write_exr(file, film, metadata);
    } catch (const std::exception&) { // for want of memory, say
        return "";
    }
    return fmt::format("; the picture is kept as {}", file.string());
}

std::string message_of(const std::exception_ptr& failure) {
    try {
        if (failure)
            std::rethrow_exception(failure);
    } catch (const std::exception& error) {
        return error.what();
    }
    return "";
}

void append(std::string& list, const char* separator, const std::string& text) {
    list += (list.empty() ? "" : separator) + text;
}

} // namespace

bool shows(const RenderOptions& options) {
    return std::any_of(options.outputs.begin(), options.outputs.end(), is_display_file);
}

void RenderOutputs::write(const Device& device, const RenderResult& result, const Shown& shown,
                          const std::string& objection) {
    const auto start = std::chrono::steady_clock::now();
    const Metadata metadata = make_metadata(options_, scene_, device, result);
    std::string failures, written;
    bool exr_written = false;
    // The others are made of what is in an EXR, and are not older: see rendered_before.cpp.
    std::vector<std::filesystem::path> outputs = options_.outputs;
    std::stable_partition(outputs.begin(), outputs.end(),
                          [](const std::filesystem::path& output) { return file_ending(output) == ".exr"; });
    for (const std::filesystem::path& output : outputs)
        try {
            if (is_grid_file(output))
                write_text(output, reading_grid(result.film, scene_.camera, output));
            else
                write_image(output, result.film, metadata, shown.tone.mapping);
            append(written, ", ", output.string());
            exr_written = exr_written || file_ending(output) == ".exr";
        } catch (const std::bad_alloc&) {
            append(failures, "; ", output.string() + ": there is not enough memory to write it");
        } catch (const RenderError& error) {
            append(failures, "; ", error.what());
        } catch (const std::exception& error) { // of the library of grids
            append(failures, "; ", fmt::format("{}: cannot be written: {}", output.string(), error.what()));
        }
    const std::string kept = failures.empty() || exr_written ? "" : rescue(result.film, metadata);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const std::string why = message_of(result.failure);
    std::string error = why;
    if (!objection.empty())
        append(error, "; ", objection);
    if (!failures.empty())
        append(error, "; ", failures + kept);
    if (std::string failure; !try_report(make_report(options_, scene_, device, result, shown, seconds, error), failure))
        append(failures, "; ", failure);
    else if (options_.report)
        append(written, ", ", options_.report->string());
    if (!failures.empty())
        throw RenderError((why.empty() ? "" : why + "; ") + failures +
                          (written.empty() ? "" : "; written: " + written) + kept);
}

void RenderOutputs::write_report(const Device& device, const RenderResult& result, const std::string& error) {
    if (std::string failure; !try_report(make_report(options_, scene_, device, result, {}, 0.0, error), failure))
        tell(stderr, "vkvol: warning: {}\n", failure);
}

void RenderOutputs::fail(const std::string& error) {
    if (reported_ || options_.dry_run || !options_.report)
        return;
    if (std::string failure;
        !try_report(make_failure_report(options_, scene_, device_ ? &*device_ : nullptr, error), failure))
        tell(stderr, "vkvol: warning: {}\n", failure);
}

bool RenderOutputs::try_report(const std::string& json, std::string& failure) {
    if (!options_.report)
        return true;
    reported_ = true;
    try {
        write_text(*options_.report, json, "--report");
        return true;
    } catch (const RenderError& error) {
        failure = error.what();
        return false;
    }
}

} // namespace vkvol
