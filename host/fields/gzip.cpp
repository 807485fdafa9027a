#include "gzip.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <zlib.h>

#include "error.h"
#include "file_ending.h"

namespace vkvol {

namespace {

class Inflater {
public:
    Inflater() {
        constexpr int window_bits = 15, of_gzip = 16; // by zlib's manual
        if (inflateInit2(&stream, window_bits + of_gzip) != Z_OK)
            throw std::bad_alloc();
    }
    ~Inflater() { inflateEnd(&stream); }
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;

    z_stream stream{};
};

} // namespace

bool is_packed(const std::filesystem::path& file, const char* ending) {
    return file_ending(file) == ".gz" && file_ending(file.stem()) == ending;
}

std::string unpacked(std::string bytes, const std::filesystem::path& file, std::size_t most) {
    if (!bytes.starts_with("\x1f\x8b"))
        return bytes;
    constexpr std::size_t most_at_once = std::numeric_limits<uInt>::max();
    constexpr std::size_t chunk = 1u << 18u;
    Inflater inflater;
    z_stream& stream = inflater.stream;
    std::string text;
    std::size_t taken = 0;
    for (bool ended = false; !ended || taken < bytes.size();) { // several packed files in a row are one
        if (ended && !std::string_view(bytes).substr(taken).starts_with("\x1f\x8b"))
            break; // gzip passes over what else follows
        if (ended)
            inflateReset(&stream);
        const std::size_t had = text.size();
        text.resize(had + chunk);
        stream.next_in = reinterpret_cast<Bytef*>(bytes.data() + taken);
        stream.avail_in = static_cast<uInt>(std::min(bytes.size() - taken, most_at_once));
        const uInt given = stream.avail_in;
        stream.next_out = reinterpret_cast<Bytef*>(text.data() + had);
        stream.avail_out = static_cast<uInt>(chunk);
        const int result = inflate(&stream, Z_NO_FLUSH);
        text.resize(had + chunk - stream.avail_out);
        taken += given - stream.avail_in;
        ended = result == Z_STREAM_END;
        if (!ended && (result != Z_OK || (taken == bytes.size() && stream.avail_out > 0)))
            throw InputError(fmt::format("{}: is damaged, and cannot be unpacked; copy the file again", file.string()));
        if (text.size() > most)
            throw InputError(
                fmt::format("{}: would be more than {} MiB once unpacked; unpack it with gunzip to see what "
                            "it holds",
                            file.string(), most >> 20u));
    }
    return text;
}

} // namespace vkvol
