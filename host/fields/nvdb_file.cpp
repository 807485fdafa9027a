#include "nvdb_file.h"

#include <blosc.h>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <nanovdb/util/IO.h>
#include <zlib.h>

#include "error.h"
#include "input_file.h"
#include "one_line.h"

namespace vkvol {

namespace {

using nanovdb::io::Codec;
using nanovdb::io::Header;
using nanovdb::io::MetaData;

constexpr std::uint32_t longest_name = 4096;
// zlib can shrink 1032 bytes to one and LZ4 255: a file that promises more lies, and is not given the memory.
constexpr std::uint64_t best_compression = 1040;

class Reader {
public:
    explicit Reader(const std::filesystem::path& file) : file_(file) {
        check_input_file(file, "");
        stream_.open(file, std::ios::binary);
        if (!stream_)
            throw InputError(fmt::format("{}: cannot be opened: {}", file.string(), std::strerror(errno)));
        std::error_code error;
        size_ = std::filesystem::file_size(file, error);
        if (error)
            throw InputError(fmt::format("{}: not a readable file: {}", file.string(), error.message()));
    }

    std::uint64_t position() { return static_cast<std::uint64_t>(stream_.tellg()); }
    std::uint64_t remaining() { return size_ - position(); }
    bool at_end() { return position() >= size_; }
    void seek(std::uint64_t offset) { stream_.seekg(static_cast<std::streamoff>(offset)); }

    void read(void* data, std::uint64_t bytes, const char* what) {
        if (bytes > remaining())
            truncated(what);
        stream_.read(static_cast<char*>(data), static_cast<std::streamsize>(bytes));
        if (!stream_)
            truncated(what);
    }

    [[noreturn]] void truncated(const char* what) const {
        throw InputError(fmt::format("{}: ends within {}: the file is truncated or damaged; copy or convert it again",
                                     file_.string(), what));
    }
    [[noreturn]] void damaged(const std::string& what) const {
        throw InputError(fmt::format("{}: {}; copy or convert the file again", file_.string(), what));
    }

private:
    std::filesystem::path file_;
    std::ifstream stream_;
    std::uint64_t size_ = 0;
};

// "NanoVDB0" up to 32.5; "NanoVDB2" marks files since 32.6, whose grids have the same layout.
bool is_nvdb_magic(std::uint64_t magic) {
    return magic == NANOVDB_MAGIC_NUMBER || magic == NANOVDB_MAGIC_NUMBER + (2ull << 56);
}

void check_header(const std::filesystem::path& file, const Header& header) {
    if (header.magic == NANOVDB_MAGIC_NUMBER + (1ull << 56)) // "NanoVDB1": a grid as it lies in memory
        throw InputError(fmt::format("{}: a raw NanoVDB grid without a file's header; write it with "
                                     "nanovdb::io::writeGrid, or convert the .vdb with `nanovdb_convert`",
                                     file.string()));
    if (!is_nvdb_magic(header.magic))
        throw InputError(fmt::format("{}: not a NanoVDB file; .nvdb files come from `nanovdb_convert`, .vdb files are "
                                     "read too if their name ends in .vdb",
                                     file.string()));
    if (header.version.getMajor() != NANOVDB_MAJOR_VERSION_NUMBER)
        throw InputError(fmt::format("{}: written by NanoVDB {}.{}.{}, but version {}.x is read here; convert it again "
                                     "from the .vdb with `nanovdb_convert` of that version",
                                     file.string(), header.version.getMajor(), header.version.getMinor(),
                                     header.version.getPatch(), NANOVDB_MAJOR_VERSION_NUMBER));
}

void decompress_zip(Reader& reader, GridBytes& grid) {
    std::uint64_t size = 0;
    reader.read(&size, sizeof size, "a grid");
    if (size > reader.remaining())
        reader.truncated("a grid");
    std::vector<Bytef> packed(size);
    reader.read(packed.data(), size, "a grid");
    uLongf bytes = grid.size();
    const int status = uncompress(reinterpret_cast<Bytef*>(grid.edit()), &bytes, packed.data(), size);
    if (status != Z_OK || bytes != grid.size())
        reader.damaged("its ZIP data does not decompress");
}

void decompress_blosc(Reader& reader, GridBytes& grid) {
    constexpr std::uint64_t longest_chunk = 1u << 30; // as NanoVDB writes them
    for (std::uint64_t done = 0; done < grid.size();) {
        std::uint64_t size = 0;
        reader.read(&size, sizeof size, "a grid");
        if (size > reader.remaining())
            reader.truncated("a grid");
        std::vector<std::byte> packed(size);
        reader.read(packed.data(), size, "a grid");
        const std::uint64_t chunk = std::min(longest_chunk, grid.size() - done);
        std::size_t unpacked = 0;
        if (blosc_cbuffer_validate(packed.data(), size, &unpacked) != 0 || unpacked != chunk ||
            blosc_decompress_ctx(packed.data(), grid.edit() + done, chunk, 1) != static_cast<int>(chunk))
            reader.damaged("its BLOSC data does not decompress");
        done += chunk;
    }
}

} // namespace

const char* grid_type_name(std::uint32_t type) {
    return type < static_cast<std::uint32_t>(nanovdb::GridType::End)
               ? nanovdb::toStr(static_cast<nanovdb::GridType>(type))
               : "unknown type";
}

const char* grid_class_name(std::uint32_t grid_class) {
    return grid_class < static_cast<std::uint32_t>(nanovdb::GridClass::End)
               ? nanovdb::toStr(static_cast<nanovdb::GridClass>(grid_class))
               : "unknown class";
}

const char* codec_name(std::uint16_t codec) {
    return codec < static_cast<std::uint16_t>(Codec::END) ? nanovdb::io::toStr(static_cast<Codec>(codec))
                                                          : "unknown codec";
}

std::vector<GridEntry> read_nvdb_entries(const std::filesystem::path& file) {
    Reader reader(file);
    std::vector<GridEntry> entries;
    do {
        Header header;
        reader.read(&header, sizeof header, "the header");
        check_header(file, header);
        const std::size_t first = entries.size();
        for (int i = 0; i < header.gridCount; ++i) {
            MetaData meta;
            reader.read(&meta, sizeof meta, "the list of grids");
            if (meta.nameSize > longest_name)
                reader.damaged("a grid's name is longer than 4096 bytes");
            std::string name(meta.nameSize, '\0');
            reader.read(name.data(), name.size(), "the list of grids");
            GridEntry entry;
            entry.name = name.c_str();
            entry.type = static_cast<std::uint32_t>(meta.gridType);
            entry.grid_class = static_cast<std::uint32_t>(meta.gridClass);
            entry.memory = meta.gridSize;
            entry.file_bytes = meta.fileSize;
            entry.codec = static_cast<std::uint16_t>(header.codec);
            entry.version = fmt::format("{}.{}.{}", header.version.getMajor(), header.version.getMinor(),
                                        header.version.getPatch());
            entries.push_back(std::move(entry));
        }
        for (std::size_t i = first; i < entries.size(); ++i) {
            entries[i].file_offset = reader.position();
            if (entries[i].file_bytes > reader.remaining())
                reader.truncated(fmt::format("grid \"{}\"", one_line(entries[i].name)).c_str());
            reader.seek(reader.position() + entries[i].file_bytes);
        }
    } while (!reader.at_end());
    // As OpenVDB writes names that several grids have, the first as it is, then "name[1]"; and none, "[0]".
    std::map<std::string, int> known;
    for (GridEntry& entry : entries)
        if (const int before = known[entry.name]++; before > 0 || entry.name.empty())
            entry.name += fmt::format("[{}]", before);
    return entries;
}

GridBytes read_nvdb_grid(const std::filesystem::path& file, const GridEntry& entry) {
    Reader reader(file);
    reader.seek(entry.file_offset);
    const auto codec = static_cast<Codec>(entry.codec);
    const std::uint64_t bound = codec == Codec::NONE ? entry.file_bytes : entry.file_bytes * best_compression;
    if (entry.memory > bound || entry.memory < sizeof(nanovdb::GridData))
        reader.damaged(fmt::format("grid \"{}\" cannot have the {} bytes that its header states", one_line(entry.name),
                                   entry.memory));
    GridBytes grid(entry.memory);
    switch (codec) {
    case Codec::NONE:
        reader.read(grid.edit(), grid.size(), "a grid");
        break;
    case Codec::ZIP:
        decompress_zip(reader, grid);
        break;
    case Codec::BLOSC:
        decompress_blosc(reader, grid);
        break;
    default:
        reader.damaged(fmt::format("unknown compression codec {}", entry.codec));
    }
    return grid;
}

} // namespace vkvol
