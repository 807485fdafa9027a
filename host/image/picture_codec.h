// Picture files as OpenImageIO reads and writes them. It brings 250 libraries, which take a fifth of a second to load:
// they are with a library of its own, which is loaded when the first picture is read or written.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include "film.h"

namespace vkvol {

// What a file says of its pixels. Windows are OpenEXR's: the data begins at x, y, the picture at full_x, full_y.
struct PictureHeader {
    int width = 0, height = 0, depth = 1;
    int x = 0, y = 0, full_x = 0, full_y = 0;
    int full_width = 0, full_height = 0;
    std::vector<std::string> channels;
    std::size_t pixel_bytes = 0;   // as the file has it, but for what is packed more densely than in bytes
    std::vector<bool> counts;      // by channel: whole numbers of 32 bits
    bool is_whole_numbers = false; // all of them, as in a PNG
    Metadata attributes;
};

class PictureReader {
public:
    virtual ~PictureReader() = default;
    virtual const PictureHeader& header() const = 0;
    // width * height pixels of all channels; whole numbers as parts of the largest there is. Whether it could.
    virtual bool read(float* pixels) = 0;
    // width * height numbers of a channel that holds counts.
    virtual bool read(int channel, std::uint32_t* counts) = 0;
    virtual std::string error() const = 0; // of what could not be read
};

class PictureSink {
public:
    virtual ~PictureSink() = default;
    virtual bool write(const void* data, std::size_t size, std::int64_t at) = 0;
};

enum class PictureFormat { exr, png };

class PictureCodec {
public:
    virtual ~PictureCodec() = default;
    // Nothing, and the reason, if it cannot be opened.
    virtual std::unique_ptr<PictureReader> open(const std::filesystem::path& file, std::string& reason) const = 0;
    // Pixels are interleaved: of an EXR floats and counts, of a PNG bytes of red, green, blue and, if there is a fourth
    // channel, an alpha by which they are not multiplied. Empty, or the reason why it failed.
    virtual std::string write(PictureFormat format, const PictureHeader& header, const void* pixels,
                              PictureSink& sink) const = 0;
};

// Throws RenderError if the library cannot be loaded. From any thread.
const PictureCodec& picture_codec();

// Loads it beside whatever else is done while the result lives.
std::future<void> picture_codec_ahead();

} // namespace vkvol

// What the library offers.
extern "C" const vkvol::PictureCodec* vkvol_picture_codec();
