#include "image_input.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <locale>
#include <sstream>

#include "error.h"
#include "exr_check.h"
#include "file_ending.h"
#include "metadata.h"
#include "one_line.h"

namespace vkvol {

using std::filesystem::path;

namespace {

// A header is soon written: what it promises is held against the file's own size before memory is given, and its
// windows against what a picture can be.
void check_size(const PictureHeader& header, const path& file) {
    constexpr std::int64_t largest_edge = 65536;
    const auto is_window = [](std::int64_t begin, std::int64_t size) {
        return size >= 1 && size <= largest_edge && begin >= -largest_edge && begin <= largest_edge;
    };
    if (!is_window(std::int64_t{header.x} - header.full_x, header.width) ||
        !is_window(std::int64_t{header.y} - header.full_y, header.height) || !is_window(0, header.full_width) ||
        !is_window(0, header.full_height) || header.depth > 1)
        throw InputError(fmt::format("{}: has a data window of {}x{} at {},{} in a picture of {}x{} at {},{}; expected "
                                     "edges from 1 to {}, nearby",
                                     file.string(), header.width, header.height, header.x, header.y, header.full_width,
                                     header.full_height, header.full_x, header.full_y, largest_edge));
    // As of zlib, or, of files that may have eight pixels in a byte and their colours in a list, so many times that;
    // and what any file may have.
    const std::uint64_t best_compression = header.is_whole_numbers ? 8 * 1040 * header.channels.size() : 1040,
                        small = 16 << 20;
    std::error_code error;
    const std::uint64_t file_bytes = std::filesystem::file_size(file, error);
    const std::uint64_t bytes =
        std::uint64_t(header.width) * std::uint64_t(header.height) * std::uint64_t(header.pixel_bytes);
    if (error || header.channels.size() > 1024 || bytes > small + best_compression * file_bytes)
        throw InputError(
            fmt::format("{}: states {}x{} pixels of {} channels, which a file of {} bytes cannot hold; copy "
                        "or render it again",
                        file.string(), header.width, header.height, header.channels.size(), error ? 0 : file_bytes));
}

} // namespace

std::unique_ptr<PictureReader> open_image(const path& file) {
    if (file_ending(file) == ".exr")
        check_exr_header(file);
    std::string reason;
    std::unique_ptr<PictureReader> reader = picture_codec().open(file, reason);
    if (!reader)
        throw InputError(fmt::format("{}: cannot be read: {}", file.string(), one_line(reason)));
    check_size(reader->header(), file);
    return reader;
}

bool is_rec709(const PictureHeader& header) {
    // Red, green, blue, white; x and y (CIE 1931).
    constexpr double rec709[] = {0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290};
    std::string text = text_of(header.attributes, "chromaticities");
    std::replace(text.begin(), text.end(), ',', ' ');
    std::istringstream numbers(text);
    numbers.imbue(std::locale::classic());
    for (const double expected : rec709)
        if (double number = 0.0; numbers >> number && std::abs(number - expected) > 2e-3)
            return false;
    return true;
}

void fail_to_read(const path& file, const PictureReader& reader) {
    throw InputError(fmt::format("{}: cannot be read: {}; is it complete?", file.string(), one_line(reader.error())));
}

} // namespace vkvol
