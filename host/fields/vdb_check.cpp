#include "vdb_check.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "error.h"
#include "input_file.h"
#include "one_line.h"

namespace vkvol {

namespace {

// As in openvdb/io: bits of a grid's compression, and what a node's values begin with.
constexpr std::uint32_t compress_zip = 1, compress_active = 2, compress_blosc = 4;
enum ValuesKind : std::int8_t { one_inactive = 2, mask = 3, mask_one_inactive = 4, mask_two_inactive = 5, all = 6 };
constexpr std::uint32_t oldest_version = 222, newest_version = 225; // of the format: OpenVDB 2.0 to 13
constexpr std::uint32_t longest_string = 4096;

// Metadata whose reader looks at its type and not at the size that the file states.
const std::map<std::string, std::uint32_t> metadata_sizes = {
    {"bool", 1},   {"float", 4},  {"double", 8}, {"int32", 4},  {"int64", 8},  {"vec2i", 8},   {"vec2s", 8},
    {"vec2d", 16}, {"vec3i", 12}, {"vec3s", 12}, {"vec3d", 24}, {"vec4i", 16}, {"vec4s", 16},  {"vec4d", 32},
    {"quats", 16}, {"quatd", 32}, {"mat3s", 36}, {"mat3d", 72}, {"mat4s", 64}, {"mat4d", 128}, {"half", 2}};

// Doubles that each kind of map consists of. Frusta are no affine maps and cannot be rendered.
const std::map<std::string, std::uint32_t> map_doubles = {{"AffineMap", 16},
                                                          {"UnitaryMap", 16},
                                                          {"ScaleMap", 15},
                                                          {"UniformScaleMap", 15},
                                                          {"TranslationMap", 3},
                                                          {"ScaleTranslateMap", 18},
                                                          {"UniformScaleTranslateMap", 18}};

// Grids of one name are told apart by what follows this character.
constexpr char separator = '\x1e';

// Bytes of a value, which is a float or three; 0 for other types of tree.
std::uint64_t value_bytes(const std::string& type) {
    if (type == "Tree_float_5_4_3" || type == "Tree_float_5_4_3_HalfFloat")
        return sizeof(float);
    return type == "Tree_vec3s_5_4_3" || type == "Tree_vec3s_5_4_3_HalfFloat" ? 3 * sizeof(float) : 0;
}

struct Descriptor {
    std::string name, type;
    std::string parent; // whose tree it shares; or none
    std::uint64_t position = 0, blocks = 0, end = 0;

    std::string plain_name() const { return name.substr(0, name.find(separator)); }
};

// As OpenVDB writes names for people, "name[1]".
std::string shown_name(const std::string& name) {
    const std::size_t at = name.find(separator);
    return at == std::string::npos ? name : fmt::format("{}[{}]", name.substr(0, at), name.substr(at + 1));
}

class Walk {
public:
    explicit Walk(const std::filesystem::path& file) : file_(file) {
        check_input_file(file, "");
        stream_.open(file, std::ios::binary);
        std::error_code error;
        size_ = std::filesystem::file_size(file, error);
        if (!stream_ || error)
            throw InputError(
                fmt::format("{}: cannot be opened: {}", file.string(), error ? error.message() : std::strerror(errno)));
    }

    std::vector<VdbEntry> walk(std::optional<std::size_t> number, GridValues allowed) {
        const std::vector<Descriptor> grids = headers();
        if (number && *number < grids.size())
            check(grids, grids[*number], allowed);
        std::vector<VdbEntry> entries;
        std::set<std::string> seen;
        for (const Descriptor& grid : grids) {
            // The first of several is known by the plain name too, if it has one.
            const std::string plain = grid.plain_name();
            const bool first = !plain.empty() && seen.insert(plain).second;
            entries.push_back({first ? plain : shown_name(grid.name), grid.type});
        }
        return entries;
    }

private:
    [[noreturn]] void damaged(const char* what) const {
        throw InputError(
            fmt::format("{}: not readable as OpenVDB: {} makes no sense at byte {}: the file is damaged; copy "
                        "or export it again",
                        file_.string(), what, position_));
    }

    // The grid that will be read, and the one that holds its tree.
    void check(const std::vector<Descriptor>& grids, const Descriptor& grid, GridValues allowed) {
        value_bytes_ = value_bytes(grid.type);
        const bool colors = allowed != GridValues::numbers;
        if (value_bytes_ == 0 || (value_bytes_ > sizeof(float) && !colors))
            throw InputError(fmt::format("{}: grid \"{}\" is not a grid of floats{}; {}", file_.string(),
                                         one_line(shown_name(grid.name)), colors ? " or colours (vec3s)" : "",
                                         value_bytes_ > 0
                                             ? "<albedo> and <emission model=\"color\"> take grids of colours"
                                         : allowed == GridValues::vectors ? "velocities are vec3s"
                                                                          : "only float is read, also saved as half"));
        check_grid(grid);
        if (grid.parent.empty())
            return;
        const auto parent = std::find_if(grids.begin(), grids.end(),
                                         [&](const Descriptor& other) { return other.name == grid.parent; });
        const bool is_there = parent != grids.end();
        if (!is_there || !parent->parent.empty() || parent->type != grid.type)
            throw InputError(fmt::format("{}: grid \"{}\" shares the tree of \"{}\", {}; save it again without "
                                         "instances",
                                         file_.string(), one_line(shown_name(grid.name)),
                                         one_line(shown_name(grid.parent)),
                                         !is_there                 ? "which the file does not have"
                                         : !parent->parent.empty() ? "which has none of its own"
                                                                   : "which is of another type"));
        check_grid(*parent);
    }

    void check_grid(const Descriptor& grid) {
        seek(grid.position);
        body(grid);
        if (position_ != grid.end)
            damaged("the end of a grid");
    }

    void body(const Descriptor& grid) {
        compression_ = get<std::uint32_t>();
        if (compression_ > (compress_zip | compress_active | compress_blosc))
            damaged("a grid's compression");
        metadata();
        transform();
        if (grid.parent.empty())
            tree();
    }

    void read(void* data, std::uint64_t bytes) {
        if (bytes > size_ - position_)
            damaged("what lies beyond the end");
        stream_.read(static_cast<char*>(data), static_cast<std::streamsize>(bytes));
        position_ += bytes;
        if (!stream_)
            damaged("what cannot be read");
    }

    template <class T> T get() {
        T value;
        read(&value, sizeof value);
        return value;
    }

    void skip(std::uint64_t bytes) {
        if (bytes > size_ - position_)
            damaged("what lies beyond the end");
        seek(position_ + bytes);
    }

    void seek(std::uint64_t position) {
        if (position > size_)
            damaged("an offset");
        position_ = position;
        stream_.seekg(static_cast<std::streamoff>(position));
    }

    std::string string() {
        const auto length = get<std::uint32_t>();
        if (length > longest_string)
            damaged("the length of a name");
        std::string text(length, '\0');
        read(text.data(), length);
        return text;
    }

    std::vector<Descriptor> headers() {
        if (get<std::int64_t>() != 0x56444220) // "VDB "
            throw InputError(fmt::format("{}: not an OpenVDB file; .nvdb files are read if their name ends in .nvdb",
                                         file_.string()));
        const auto version = get<std::uint32_t>();
        if (version < oldest_version || version > newest_version)
            throw InputError(
                fmt::format("{}: has version {} of the OpenVDB format, but {} to {} are read, which OpenVDB 2 to 13 "
                            "write; save it again with a program that uses one of these",
                            file_.string(), version, oldest_version, newest_version));
        skip(8); // of the library
        const auto offsets = get<std::uint8_t>();
        if (offsets > 1)
            damaged("whether grids have offsets");
        skip(36); // UUID
        metadata();
        std::vector<Descriptor> grids;
        std::set<std::string> names;
        for (auto count = get<std::uint32_t>(); count > 0; --count) {
            Descriptor grid;
            grid.name = string();
            grid.type = string();
            grid.parent = string();
            grid.position = get<std::uint64_t>();
            grid.blocks = get<std::uint64_t>();
            grid.end = get<std::uint64_t>();
            if (offsets == 0)
                streamed(grid);
            const bool in_order =
                !grid.parent.empty() || (grid.position <= grid.blocks && grid.blocks <= grid.end); // a tree has blocks
            if (grid.position < position_ || grid.end < grid.position || !in_order || grid.end > size_)
                damaged("a grid's place");
            if (!names.insert(grid.name).second)
                damaged("a grid's name");
            grids.push_back(grid);
            seek(grid.end);
        }
        return grids;
    }

    // Of a stream all grids are read, one after another.
    void streamed(Descriptor& grid) {
        value_bytes_ = value_bytes(grid.type);
        if (value_bytes_ == 0)
            throw InputError(
                fmt::format("{}: is a stream without offsets, which is read as a whole, and its grid \"{}\" is "
                            "none of floats or colours; save it again as a file, or without that grid",
                            file_.string(), one_line(shown_name(grid.name))));
        grid.position = grid.blocks = position_;
        body(grid);
        grid.end = position_;
        seek(grid.position);
    }

    // Notes whether values are halves.
    void metadata() {
        half_ = false;
        for (auto count = get<std::uint32_t>(); count > 0; --count) {
            const std::string name = string(), type = string();
            const auto bytes = get<std::uint32_t>();
            const auto known = metadata_sizes.find(type);
            if (known != metadata_sizes.end() && known->second != bytes)
                damaged("the size of metadata");
            if (name == "is_saved_as_half_float") {
                if (type != "bool")
                    damaged("metadata about half precision");
                half_ = get<std::uint8_t>() != 0;
            } else if (type == "__delayedload") {
                delayed_loading(bytes);
            } else {
                skip(bytes);
            }
        }
    }

    // A table with an entry per leaf, of which each takes at least two masks of 64 bytes; nothing where there are none.
    void delayed_loading(std::uint32_t bytes) {
        if (bytes == 0)
            return;
        const std::uint64_t end = position_ + bytes;
        if (bytes < 4 || end > size_)
            damaged("the table for delayed loading");
        const std::uint64_t leaves = get<std::uint32_t>();
        if (leaves > size_ / 128)
            damaged("the table for delayed loading");
        // Masks, then sizes; each begins with the bytes it has compressed, 0 if it is not. All ones: there are no
        // sizes.
        for (const std::uint64_t entry : {1u, 8u}) {
            if (position_ == end)
                break;
            const auto stated = get<std::uint32_t>();
            const std::uint64_t length = stated == ~0u ? 0 : stated > 0 ? stated : leaves * entry;
            if (length > end - std::min(position_, end))
                damaged("the table for delayed loading");
            if (stated > 0 && stated != ~0u)
                compressed(length);
            else
                skip(length);
        }
        seek(end);
    }

    // BLOSC's own header states its size a second time, which its reader goes by.
    void compressed(std::uint64_t bytes) {
        struct {
            std::uint8_t versions_flags_and_type[4];
            std::uint32_t unpacked, block, packed;
        } header;
        static_assert(sizeof header == 16);
        if (bytes < sizeof header)
            damaged("the size of compressed data");
        read(&header, sizeof header);
        if (header.packed != bytes || header.block == 0)
            damaged("the size of compressed data");
        skip(bytes - sizeof header);
    }

    void transform() {
        const auto known = map_doubles.find(string());
        if (known == map_doubles.end())
            throw InputError(
                fmt::format("{}: a grid has a transform of unknown kind; resample the grid to an affine one, e.g. in "
                            "Houdini with VDB Resample",
                            file_.string()));
        skip(known->second * sizeof(double));
    }

    void tree() {
        leaves_.clear();
        if (get<std::uint32_t>() != 1)
            damaged("the number of buffers");
        skip(value_bytes_); // background
        const auto tiles = get<std::uint32_t>(), children = get<std::uint32_t>();
        std::set<std::array<std::int32_t, 3>> origins;
        for (std::uint32_t i = 0; i < tiles; ++i) {
            root_entry(origins);
            skip(value_bytes_);
            if (get<std::uint8_t>() > 1)
                damaged("the state of a tile");
        }
        for (std::uint32_t i = 0; i < children; ++i) {
            root_entry(origins);
            internal_node<5>();
        }
        for (const std::bitset<512>& leaf : leaves_) {
            if (get<std::bitset<512>>() != leaf)
                damaged("the mask of a leaf");
            values(leaf);
        }
    }

    void root_entry(std::set<std::array<std::int32_t, 3>>& origins) {
        const auto origin = get<std::array<std::int32_t, 3>>();
        for (const std::int32_t coordinate : origin)
            if (coordinate % 4096 != 0)
                damaged("the place of a node");
        if (!origins.insert(origin).second)
            damaged("the place of a node");
    }

    template <int log2> void internal_node() {
        using Mask = std::bitset<std::size_t{1} << (3 * log2)>;
        const auto children = get<Mask>(), active = get<Mask>();
        if ((children & active).any())
            damaged("the mask of a node");
        values(active);
        for (std::size_t i = 0; i < children.size(); ++i)
            if (children[i]) {
                if constexpr (log2 == 5)
                    internal_node<4>();
                else
                    leaves_.push_back(get<std::bitset<512>>());
            }
    }

    template <class Mask> void values(const Mask& active) {
        const auto kind = get<std::int8_t>();
        if (kind < 0 || kind > ValuesKind::all)
            damaged("the kind of a node's values");
        if (kind == one_inactive || kind == mask_one_inactive || kind == mask_two_inactive)
            skip(value_bytes_);
        if (kind == mask_two_inactive)
            skip(value_bytes_);
        if (kind == mask || kind == mask_one_inactive || kind == mask_two_inactive)
            skip(sizeof(Mask));
        const bool packed = (compression_ & compress_active) != 0 && kind != ValuesKind::all;
        const std::uint64_t count = packed ? active.count() : active.size();
        const std::uint64_t bytes = count * (half_ ? value_bytes_ / 2 : value_bytes_);
        if (half_ && count == 0)
            return; // and no size either
        if ((compression_ & (compress_zip | compress_blosc)) == 0)
            return skip(bytes);
        // The size of what is compressed, or less than 0: as it is.
        const auto size = get<std::int64_t>();
        if (size > 0 && (compression_ & compress_blosc) != 0)
            compressed(static_cast<std::uint64_t>(size));
        else if (size > 0)
            skip(static_cast<std::uint64_t>(size));
        else if (static_cast<std::uint64_t>(-size) == bytes)
            skip(bytes);
        else
            damaged("the size of a node's values");
    }

    const std::filesystem::path& file_;
    std::ifstream stream_;
    std::uint64_t size_ = 0, position_ = 0;
    std::uint32_t compression_ = 0;
    std::uint64_t value_bytes_ = 0;
    bool half_ = false;
    std::vector<std::bitset<512>> leaves_; // masks, in the order of the file
};

} // namespace

std::vector<VdbEntry> check_vdb(const std::filesystem::path& file, std::optional<std::size_t> number,
                                GridValues allowed) {
    return Walk(file).walk(number, allowed);
}

} // namespace vkvol
