#include "exr_check.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "error.h"
#include "input_file.h"

namespace vkvol {

namespace {

constexpr std::int64_t largest_edge = 65536;
constexpr std::streamoff channel_bytes = 16;    // after a channel's name
constexpr std::uint64_t largest_tile = 1 << 20; // pixels

const std::map<std::string, std::int32_t> type_sizes = {{"box2i", 16},      {"box2f", 16},   {"chromaticities", 32},
                                                        {"compression", 1}, {"double", 8},   {"envmap", 1},
                                                        {"float", 4},       {"int", 4},      {"keycode", 28},
                                                        {"lineOrder", 1},   {"m33f", 36},    {"m33d", 72},
                                                        {"m44f", 64},       {"m44d", 128},   {"rational", 8},
                                                        {"tiledesc", 9},    {"timecode", 8}, {"v2i", 8},
                                                        {"v2f", 8},         {"v2d", 16},     {"v3i", 12},
                                                        {"v3f", 12},        {"v3d", 24},     {"deepImageState", 1}};

// "The OpenEXR file layout": a magic number and a version, then per part attributes of name, type, size and value up to
// an empty name, and the parts up to an empty part if there are several. Then a table of 8 bytes per chunk.
class Header {
public:
    explicit Header(const std::filesystem::path& file) : file_(file) {
        check_input_file(file, "");
        stream_.open(file, std::ios::binary);
        std::error_code error;
        size_ = std::filesystem::file_size(file, error);
        if (!stream_ || error)
            throw InputError(fmt::format("{}: cannot be opened", file.string()));
    }

    void check() {
        if (get<std::uint32_t>() != 20000630)
            throw InputError(fmt::format("{}: is no EXR file", file_.string()));
        const bool several = (get<std::uint32_t>() & 0x1000u) != 0;
        do {
            width_ = height_ = 0; // of this part
            tile_ = {};
            for (std::string name = text(); !name.empty(); name = text())
                attribute(name);
        } while (several && stream_.peek() > 0);
    }

private:
    [[noreturn]] void damaged(const std::string& what) const {
        throw InputError(fmt::format("{}: its header is damaged: {}; copy or render it again", file_.string(), what));
    }

    std::uint64_t left() { return size_ - static_cast<std::uint64_t>(stream_.tellg()); }

    template <class T> T get() {
        T value{};
        if (left() < sizeof value || !stream_.read(reinterpret_cast<char*>(&value), sizeof value))
            damaged("it ends early");
        return value;
    }

    std::string text() {
        constexpr std::size_t longest = 255;
        std::string text;
        while (const char c = get<char>()) {
            text += c;
            if (text.size() > longest)
                damaged("a name is longer than 255 bytes");
        }
        return text;
    }

    void attribute(const std::string& name) {
        const std::string type = text();
        if (type.empty())
            damaged("an attribute has no type");
        const auto size = get<std::int32_t>();
        if (size < 0 || static_cast<std::uint64_t>(size) > left())
            damaged("an attribute reaches beyond the end of the file");
        const auto known = type_sizes.find(type);
        if (known != type_sizes.end() && known->second != size)
            damaged("an attribute's size is not that of its type");
        const auto end = stream_.tellg() + std::streamoff{size};
        if (type == "chlist" || type == "stringvector" || type == "preview")
            check_parts(type, end);
        stream_.seekg(end - std::streamoff{size});
        if (name == "dataWindow" && size == 16)
            std::tie(width_, height_) = checked_window(get<std::array<std::int32_t, 4>>());
        if (name == "displayWindow" && size == 16)
            checked_window(get<std::array<std::int32_t, 4>>());
        if (name == "chunkCount" && size == 4)
            check_chunks(static_cast<std::uint64_t>(std::max(get<std::int32_t>(), 0)));
        if (name == "tiles" && size == 9)
            tile_ = get<std::array<std::uint32_t, 2>>();
        check_tiles();
        stream_.seekg(end);
    }

    // Values that have sizes or an end of their own, which must agree with the attribute's.
    void check_parts(const std::string& type, std::streamoff end) {
        if (type == "chlist")
            while (stream_.tellg() < end && !text().empty())
                stream_.seekg(channel_bytes, std::ios::cur);
        else if (type == "stringvector")
            while (stream_.tellg() < end)
                stream_.seekg(std::max(get<std::int32_t>(), 0), std::ios::cur);
        else {
            const auto edges = get<std::array<std::uint32_t, 2>>();
            constexpr std::uint32_t longest = 1 << 14;
            if (edges[0] > longest || edges[1] > longest)
                damaged("a huge preview");
            stream_.seekg(std::streamoff{4} * edges[0] * edges[1], std::ios::cur);
        }
        if (stream_.tellg() != end)
            damaged("an attribute's size is not that of its parts");
    }

    // Width and height.
    std::pair<std::int64_t, std::int64_t> checked_window(const std::array<std::int32_t, 4>& window) {
        const std::int64_t width = std::int64_t{window[2]} - window[0] + 1;
        const std::int64_t height = std::int64_t{window[3]} - window[1] + 1;
        if (width < 1 || width > largest_edge || height < 1 || height > largest_edge)
            damaged(
                fmt::format("a data window or picture of {}x{}, where edges are 1 to {}", width, height, largest_edge));
        return {width, height};
    }

    void check_tiles() {
        if (tile_[0] == 0 && tile_[1] == 0)
            return;
        const std::uint64_t x = tile_[0], y = tile_[1];
        if (x == 0 || y == 0 || x > largest_tile || y > largest_tile || x * y > largest_tile)
            damaged(fmt::format("tiles of {}x{}", x, y));
        if (width_ > 0)
            check_chunks(static_cast<std::uint64_t>(width_) / x * (static_cast<std::uint64_t>(height_) / y));
    }

    void check_chunks(std::uint64_t chunks) {
        if (chunks > size_ / 8)
            damaged(fmt::format("{} pieces in a file of {} bytes", chunks, size_));
    }

    const std::filesystem::path& file_;
    std::ifstream stream_;
    std::uint64_t size_ = 0;
    std::int64_t width_ = 0, height_ = 0;
    std::array<std::uint32_t, 2> tile_{};
};

} // namespace

void check_exr_header(const std::filesystem::path& file) {
    Header(file).check();
}

} // namespace vkvol
