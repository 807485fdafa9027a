#include "image_input.h"

#include <cstdint>
#include <fmt/format.h>

#include "error.h"
#include "exr_check.h"
#include "file_ending.h"
#include "one_line.h"

namespace vkvol {

using std::filesystem::path;

std::string reason_of(const std::string& message) {
    std::string reason = one_line(message);
    while (!reason.empty() && reason.back() == ' ')
        reason.pop_back();
    return reason.empty() ? "unknown reason" : reason;
}

namespace {

// A header is soon written: what it promises is held against the file's own size before memory is given, and its
// windows against what a picture can be.
void check_size(const OIIO::ImageSpec& spec, const path& file) {
    constexpr std::int64_t largest_edge = 65536;
    const auto is_window = [](std::int64_t begin, std::int64_t size) {
        return size >= 1 && size <= largest_edge && begin >= -largest_edge && begin <= largest_edge;
    };
    if (!is_window(std::int64_t{spec.x} - spec.full_x, spec.width) ||
        !is_window(std::int64_t{spec.y} - spec.full_y, spec.height) || !is_window(0, spec.full_width) ||
        !is_window(0, spec.full_height) || spec.depth > 1)
        throw InputError(fmt::format("{}: has a data window of {}x{} at {},{} in a picture of {}x{} at {},{}; expected "
                                     "edges from 1 to {}, nearby",
                                     file.string(), spec.width, spec.height, spec.x, spec.y, spec.full_width,
                                     spec.full_height, spec.full_x, spec.full_y, largest_edge));
    constexpr std::uint64_t best_compression = 1040, small = 16 << 20; // as of zlib, and what any file may have
    std::error_code error;
    const std::uint64_t file_bytes = std::filesystem::file_size(file, error);
    const std::uint64_t bytes =
        std::uint64_t(spec.width) * std::uint64_t(spec.height) * std::uint64_t(spec.nchannels) * sizeof(float);
    if (error || spec.nchannels > 1024 || bytes > small + best_compression * file_bytes)
        throw InputError(
            fmt::format("{}: states {}x{} pixels of {} channels, which a file of {} bytes cannot hold; copy "
                        "or render it again",
                        file.string(), spec.width, spec.height, spec.nchannels, error ? 0 : file_bytes));
}

} // namespace

std::unique_ptr<OIIO::ImageInput> open_image(const path& file) {
    if (file_ending(file) == ".exr")
        check_exr_header(file);
    std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(file.string());
    if (!input)
        throw InputError(fmt::format("{}: cannot be read: {}", file.string(), reason_of(OIIO::geterror())));
    check_size(input->spec(), file);
    return input;
}

void fail_to_read(const path& file, const OIIO::ImageInput& input) {
    throw InputError(
        fmt::format("{}: cannot be read: {}; is it complete?", file.string(), reason_of(input.geterror())));
}

} // namespace vkvol
