// Loaded by picture_codec.cpp, and by nothing else.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <algorithm>
#include <cctype>
#include <string_view>

#include "picture_codec.h"

namespace vkvol {

namespace {

std::string reason_of(std::string message) {
    while (!message.empty() && std::isspace(static_cast<unsigned char>(message.back())))
        message.pop_back();
    return message.empty() ? "unknown reason" : message;
}

// Whether its bytes have that word, of letters of so many bytes, the last of which says which.
bool holds(const OIIO::ParamValue& value, std::string_view word, std::size_t letter) {
    const std::string_view bytes(static_cast<const char*>(value.data()), std::size_t(value.datasize()));
    std::string wanted;
    for (const char c : word)
        wanted += (wanted.empty() ? "" : std::string(letter - 1, '\0')) + c;
    return bytes.find(wanted) != std::string_view::npos;
}

Metadata attributes_of(const OIIO::ImageSpec& spec) {
    Metadata attributes;
    for (const OIIO::ParamValue& value : spec.extra_attribs) {
        const std::string key = value.name().string();
        if (value.type() == OIIO::TypeInt || value.type() == OIIO::TypeUInt16) // JPEG's orientation, say
            attributes[key] = value.get_int();
        else if (value.type() == OIIO::TypeFloat)
            attributes[key] = value.get_float();
        else if (value.type() == OIIO::TypeString)
            attributes[key] = value.get_string();
        else if (key == "chromaticities" && value.type().basetype == OIIO::TypeDesc::FLOAT)
            attributes[key] = value.get_string(); // eight numbers, with commas between
        else if (key == "ICCProfile")             // which says its name, in words of one byte or two
            attributes[key] = std::string(holds(value, "sRGB", 1) || holds(value, "sRGB", 2) ? "sRGB" : "another");
    }
    return attributes;
}

// What other files than .exr say of their place, on a sheet of paper say, is not meant of pixels.
PictureHeader header_of(const OIIO::ImageSpec& spec, bool has_windows) {
    PictureHeader header;
    header.width = header.full_width = spec.width;
    header.height = header.full_height = spec.height;
    header.depth = spec.depth;
    if (has_windows) {
        header.x = spec.x;
        header.y = spec.y;
        header.full_x = spec.full_x;
        header.full_y = spec.full_y;
        header.full_width = spec.full_width;
        header.full_height = spec.full_height;
    }
    header.pixel_bytes = spec.pixel_bytes(true);
    for (int c = 0; c < spec.nchannels; ++c) {
        header.channels.push_back(spec.channelnames[std::size_t(c)]);
        header.counts.push_back(spec.channelformat(c) == OIIO::TypeUInt32);
    }
    header.is_whole_numbers = !spec.format.is_floating_point();
    header.attributes = attributes_of(spec);
    return header;
}

class OiioReader : public PictureReader {
public:
    explicit OiioReader(std::unique_ptr<OIIO::ImageInput> input)
        : input_(std::move(input)),
          header_(header_of(input_->spec(), std::string_view(input_->format_name()) == "openexr")) {}
    const PictureHeader& header() const override { return header_; }
    bool read(float* pixels) override {
        return input_->read_image(0, 0, 0, int(header_.channels.size()), OIIO::TypeDesc::FLOAT, pixels);
    }
    bool read(int channel, std::uint32_t* counts) override {
        return input_->read_image(0, 0, channel, channel + 1, OIIO::TypeDesc::UINT32, counts);
    }
    std::string error() const override { return reason_of(input_->geterror()); }

private:
    std::unique_ptr<OIIO::ImageInput> input_;
    PictureHeader header_;
};

// Lets OpenImageIO write into a file of ours: it would not see every failure itself.
class SinkProxy : public OIIO::Filesystem::IOProxy {
public:
    explicit SinkProxy(PictureSink& sink) : IOProxy("", Write), sink_(sink) {}
    const char* proxytype() const override { return "file"; }
    std::size_t write(const void* data, std::size_t size) override {
        const std::size_t written = pwrite(data, size, m_pos);
        m_pos += static_cast<std::int64_t>(written);
        return written;
    }
    std::size_t pwrite(const void* data, std::size_t size, std::int64_t at) override {
        return sink_.write(data, size, at) ? size : 0;
    }

private:
    PictureSink& sink_;
};

OIIO::ImageSpec exr_spec(const PictureHeader& header) {
    OIIO::ImageSpec spec(header.width, header.height, int(header.channels.size()), OIIO::TypeDesc::FLOAT);
    spec.channelnames = header.channels;
    for (const bool is_count : header.counts)
        spec.channelformats.push_back(is_count ? OIIO::TypeDesc::UINT32 : OIIO::TypeDesc::FLOAT);
    spec.alpha_channel = spec.channelindex("A");
    spec.x = header.x;
    spec.y = header.y;
    spec.full_x = header.full_x;
    spec.full_y = header.full_y;
    spec.full_width = header.full_width;
    spec.full_height = header.full_height;
    spec.attribute("compression", "zip");
    spec.attribute("oiio:ColorSpace", "Linear"); // Rec.709 primaries, D65
    const float chromaticities[8] = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
    spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), chromaticities);
    for (const auto& [key, value] : header.attributes)
        std::visit([&spec, &key = key](const auto& held) { spec.attribute(key, held); }, value);
    return spec;
}

OIIO::ImageSpec png_spec(const PictureHeader& header) {
    OIIO::ImageSpec spec(header.width, header.height, int(header.channels.size()), OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    if (header.channels.size() == 4)
        spec.attribute("oiio:UnassociatedAlpha", 1); // the division by alpha is done, without its rounding twice
    return spec;
}

// By its name, or what it is. OpenImageIO takes what follows a ? in a name for arguments: then by its ending alone.
std::unique_ptr<OIIO::ImageInput> open_input(const std::filesystem::path& file, std::string& reason) {
    OIIO::ImageSpec as_stored; // a PNG's colours are not multiplied by its alpha
    as_stored.attribute("oiio:UnassociatedAlpha", 1);
    std::unique_ptr<OIIO::ImageInput> input;
    const bool has_arguments = file.string().find('?') != std::string::npos;
    const std::string ending = file.extension().string();
    if (has_arguments)
        input = OIIO::ImageInput::create(ending.substr(std::min<std::size_t>(1, ending.size())));
    else
        input = OIIO::ImageInput::open(file.string(), &as_stored);
    if (!input)
        reason = reason_of(OIIO::geterror());
    OIIO::ImageSpec spec;
    if (input && has_arguments && !input->open(file.string(), spec, as_stored)) {
        reason = reason_of(input->geterror());
        input.reset();
    }
    return input;
}

class OiioCodec : public PictureCodec {
public:
    std::unique_ptr<PictureReader> open(const std::filesystem::path& file, std::string& reason) const override {
        if (std::unique_ptr<OIIO::ImageInput> input = open_input(file, reason))
            return std::make_unique<OiioReader>(std::move(input));
        return nullptr;
    }

    std::string write(PictureFormat format, const PictureHeader& header, const void* pixels,
                      PictureSink& sink) const override {
        const bool is_exr = format == PictureFormat::exr;
        const char* const name = is_exr ? "a.exr" : "a.png";
        SinkProxy proxy(sink);
        const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(name, &proxy);
        if (!output)
            return reason_of(OIIO::geterror());
        const OIIO::TypeDesc type = is_exr ? OIIO::TypeDesc::UNKNOWN : OIIO::TypeDesc::UINT8; // unknown: its own types
        const bool done = output->open(name, is_exr ? exr_spec(header) : png_spec(header)) &&
                          output->write_image(type, pixels) && output->close();
        return done ? "" : reason_of(output->geterror());
    }
};

} // namespace

} // namespace vkvol

const vkvol::PictureCodec* vkvol_picture_codec() {
    static const vkvol::OiioCodec codec;
    return &codec;
}
