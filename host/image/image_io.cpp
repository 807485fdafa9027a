#include "image_io.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <functional>
#include <memory>
#include <sstream>
#include <system_error>
#include <unistd.h>

#include "atomic_file.h"
#include "error.h"
#include "exr_check.h"
#include "file_ending.h"
#include "film_channels.h"
#include "film_table.h"
#include "image_input.h"
#include "input_file.h"
#include "one_line.h"

namespace vkvol {

namespace {

using std::filesystem::path;

const char* remedy_of(int error) {
    switch (error) {
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
        return "free some space";
    case EACCES:
    case EPERM:
    case EROFS:
        return "check permissions";
    case ENOENT:
    case ENOTDIR:
        return "make its directory";
    case EISDIR:
        return "rename the directory of that name";
    case EPIPE:
        return "see why its reader ended";
    case EINTR:
        return "start its reader first";
    default:
        return "check the disk";
    }
}

// Fills a new file, which then takes the place of the old one.
void write_atomically(const path& target, const char* option, const std::function<void(AtomicFile&)>& write) {
    std::string reason, remedy = "check free space and permissions";
    try {
        AtomicFile file(target);
        write(file);
        file.put_in_place();
        return;
    } catch (const std::system_error& error) {
        reason = error.code().message();
        remedy = remedy_of(error.code().value());
    } catch (const std::exception& error) {
        reason = error.what();
    }
    throw RenderError(fmt::format("{}: cannot be written: {}; {}, or name another place with {}", target.string(),
                                  reason, remedy, option));
}

// Lets OpenImageIO write into a file of ours: it would not see every failure itself.
class FileProxy : public OIIO::Filesystem::IOProxy {
public:
    explicit FileProxy(AtomicFile& file) : IOProxy("", Write), file_(file) {}
    const char* proxytype() const override { return "file"; }
    std::size_t write(const void* data, std::size_t size) override {
        const std::size_t written = pwrite(data, size, m_pos);
        m_pos += static_cast<std::int64_t>(written);
        return written;
    }
    std::size_t pwrite(const void* data, std::size_t size, std::int64_t at) override {
        return file_.write(data, size, at) ? size : 0;
    }

private:
    AtomicFile& file_;
};

void write_pixels(AtomicFile& file, const char* format, const OIIO::ImageSpec& spec, OIIO::TypeDesc type,
                  const void* pixels) {
    FileProxy proxy(file);
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(format, &proxy);
    if (!output)
        throw std::runtime_error(reason_of(OIIO::geterror()));
    const bool done = output->open(format, spec) && output->write_image(type, pixels) && output->close();
    file.check(); // the disk's own word comes first
    if (!done)
        throw std::runtime_error(reason_of(output->geterror()));
}

void set_attributes(OIIO::ImageSpec& spec, const Metadata& metadata) {
    for (const auto& [key, value] : metadata)
        std::visit([&spec, &key = key](const auto& held) { spec.attribute(key, held); }, value);
}

// What we or the pixels themselves say already; the rest of a file's attributes is its metadata.
bool is_structural(const std::string& key) {
    static const char* const known[] = {"oiio:",        "openexr:", "compression", "worldToCamera", "PixelAspectRatio",
                                        "screenWindow", "nuke/",    "DateTime",    "capDate"};
    return std::any_of(std::begin(known), std::end(known),
                       [&key](const char* prefix) { return key.compare(0, std::strlen(prefix), prefix) == 0; });
}

void get_attributes(const OIIO::ImageSpec& spec, Metadata& metadata) {
    for (const OIIO::ParamValue& value : spec.extra_attribs) {
        const std::string key = value.name().string();
        if (is_structural(key))
            continue;
        if (value.type() == OIIO::TypeInt)
            metadata[key] = value.get_int();
        else if (value.type() == OIIO::TypeFloat)
            metadata[key] = value.get_float();
        else if (value.type() == OIIO::TypeString)
            metadata[key] = value.get_string();
    }
}

void check_consistent(const Film& film) {
    const Crop& crop = film.crop;
    const std::size_t pixels = crop.x1 > crop.x0 && crop.y1 > crop.y0 ? std::size_t(film.width()) * film.height() : 0;
    const bool has_layers = std::all_of(film.layers.begin(), film.layers.end(), [&](const FilmLayer& layer) {
        return layer.mean.size() == pixels && (layer.variance.empty() || layer.variance.size() == pixels);
    });
    if (!has_layers || pixels == 0 || film.mean.size() != pixels || film.variance.size() != pixels ||
        film.samples.size() != pixels)
        throw std::runtime_error(fmt::format("the film of {}x{} pixels holds {} means, {} variances and {} counts",
                                             film.width(), film.height(), film.mean.size(), film.variance.size(),
                                             film.samples.size()));
}

int channel_of(const OIIO::ImageSpec& spec, const char* name) {
    const auto found = std::find(spec.channelnames.begin(), spec.channelnames.end(), name);
    return found == spec.channelnames.end() ? -1 : int(found - spec.channelnames.begin());
}

// By the names in the image's metadata: other channels are no concern of ours.
void read_layers(const OIIO::ImageSpec& spec, const std::vector<float>& pixels, Film& film) {
    std::istringstream names{std::string(spec.get_string_attribute(layers_key))};
    for (std::string name; names >> name;) {
        FilmLayer layer{name, {}, {}};
        for (const char* const prefix : {"", "variance."}) {
            std::vector<int> channels;
            for (const char* letter = layer.channels(); *letter != 0; ++letter)
                channels.push_back(channel_of(spec, channel_name(prefix, layer, *letter).c_str()));
            if (*std::min_element(channels.begin(), channels.end()) < 0)
                continue;
            std::vector<glm::vec3>& values = *prefix == 0 ? layer.mean : layer.variance;
            for (std::size_t i = 0; i < film.pixel_count(); ++i) {
                const float* pixel = &pixels[i * std::size_t(spec.nchannels)];
                const auto value = [&](std::size_t c) { return pixel[channels[std::min(c, channels.size() - 1)]]; };
                values.emplace_back(value(0), value(1), value(2));
            }
        }
        if (!layer.mean.empty())
            film.layers.push_back(std::move(layer));
    }
}

Film film_of(const OIIO::ImageSpec& spec, const std::vector<float>& pixels, const path& file) {
    const auto channel = [&spec](const char* name) { return channel_of(spec, name); };
    const int color[3] = {channel("R"), channel("G"), channel("B")};
    const int variance[3] = {channel("variance.R"), channel("variance.G"), channel("variance.B")};
    const int samples = channel("samples");
    if (*std::min_element(color, color + 3) < 0)
        throw InputError(one_line(fmt::format("{}: has channels {}; R, G and B are needed", file.string(),
                                              fmt::join(spec.channelnames, ", "))));
    Film film;
    film.picture_width = spec.full_width;
    film.picture_height = spec.full_height;
    film.crop.x0 = spec.x - spec.full_x;
    film.crop.y0 = spec.y - spec.full_y;
    film.crop.x1 = film.crop.x0 + spec.width;
    film.crop.y1 = film.crop.y0 + spec.height;
    const std::size_t count = std::size_t(spec.width) * spec.height;
    film.mean.resize(count);
    film.variance.resize(count, glm::vec3(0));
    film.samples.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const float* pixel = &pixels[i * spec.nchannels];
        for (int c = 0; c < 3; ++c) {
            film.mean[i][c] = pixel[color[c]];
            if (variance[c] >= 0)
                film.variance[i][c] = pixel[variance[c]];
        }
        if (samples >= 0 && pixel[samples] > 0.0f && pixel[samples] < 4294967296.0f)
            film.samples[i] = static_cast<std::uint32_t>(pixel[samples]);
    }
    read_layers(spec, pixels, film);
    return film;
}

} // namespace

void check_writable(const path& target) {
    const std::string extension = file_ending(target);
    if (extension != ".exr" && extension != ".csv" && !is_display_file(target))
        throw InputError(fmt::format("{}: unknown kind of picture '{}'; expected .exr, .png or .csv", target.string(),
                                     extension.empty() ? target.filename().string() : extension));
    check_directory_writable(target);
}

void check_directory_writable(const path& target, const char* option) {
    const path directory = target.has_parent_path() ? target.parent_path() : path(".");
    std::error_code error;
    if (!std::filesystem::exists(directory, error))
        throw InputError(
            fmt::format("{}: the directory {} does not exist; make it first", target.string(), directory.string()));
    if (std::filesystem::is_directory(target, error))
        throw InputError(fmt::format("{}: is a directory; expected the name of a file", target.string()));
    if (is_special(target))
        return;
    // Only making a file tells: permissions, read-only file systems and quotas all have a say.
    const path probe = temporary_name(target);
    const int descriptor = open(probe.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (descriptor < 0)
        throw InputError(fmt::format("{}: no file can be made in {}: {}; name another place with {}", target.string(),
                                     directory.string(), std::strerror(errno), option));
    close(descriptor);
    unlink(probe.c_str());
}

bool is_display_file(const path& target) {
    return file_ending(target) == ".png";
}

void write_image(const path& target, const Film& film, const Metadata& metadata, const ToneMapping& mapping) {
    if (is_display_file(target))
        write_display(target, film, mapping);
    else if (file_ending(target) == ".csv")
        write_text(target, film_table(film));
    else
        write_exr(target, film, metadata);
}

void write_images(const std::vector<path>& targets, const Film& film, const Metadata& metadata,
                  const ToneMapping& mapping) {
    std::string failures, written;
    for (const path& target : targets)
        try {
            write_image(target, film, metadata, mapping);
            written += (written.empty() ? "; written: " : ", ") + target.string();
        } catch (const RenderError& error) {
            failures += (failures.empty() ? "" : "; ") + std::string(error.what());
        }
    if (!failures.empty())
        throw RenderError(failures + written);
}

void write_exr(const path& target, const Film& film, const Metadata& metadata, const char* option) {
    write_atomically(target, option, [&](AtomicFile& file) {
        check_consistent(film);
        const std::vector<std::string> channels = channel_names(film);
        OIIO::ImageSpec spec(film.width(), film.height(), int(channels.size()), OIIO::TypeDesc::FLOAT);
        spec.channelnames = channels;
        spec.channelformats.assign(channels.size(), OIIO::TypeDesc::FLOAT);
        spec.channelformats[samples_channel] = OIIO::TypeDesc::UINT32;
        spec.alpha_channel = spec.channelindex("A");
        spec.x = film.crop.x0;
        spec.y = film.crop.y0;
        spec.full_width = film.picture_width;
        spec.full_height = film.picture_height;
        spec.attribute("compression", "zip");
        spec.attribute("oiio:ColorSpace", "Linear"); // Rec.709 primaries, D65
        const float chromaticities[8] = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
        spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), chromaticities);
        set_attributes(spec, metadata);
        if (!film.layers.empty())
            spec.attribute(layers_key, layer_list(film));
        write_pixels(file, "a.exr", spec, OIIO::TypeDesc::UNKNOWN,
                     interleaved_channels(film).data()); // unknown: its own types
    });
}

void write_display(const path& target, const Film& film, const ToneMapping& mapping) {
    write_atomically(target, "-o", [&](AtomicFile& file) {
        check_consistent(film);
        const FilmLayer* alpha = film.layer("alpha");
        OIIO::ImageSpec spec(film.width(), film.height(), alpha ? 4 : 3, OIIO::TypeDesc::UINT8);
        spec.attribute("oiio:ColorSpace", "sRGB");
        if (alpha)
            spec.attribute("oiio:UnassociatedAlpha", 1); // the division by alpha is done, without its rounding twice
        const std::vector<std::uint8_t> pixels = alpha ? tone_map(film, mapping, *alpha) : tone_map(film, mapping);
        write_pixels(file, "a.png", spec, OIIO::TypeDesc::UINT8, pixels.data());
    });
}

Film read_exr(const path& file, Metadata* metadata) {
    check_input_file(file, "");
    if (file_ending(file) != ".exr")
        throw InputError(fmt::format("{}: expected an .exr file", file.string()));
    const std::unique_ptr<OIIO::ImageInput> input = open_image(file);
    const OIIO::ImageSpec& spec = input->spec();
    std::vector<float> pixels(std::size_t(spec.width) * spec.height * spec.nchannels);
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, pixels.data()))
        fail_to_read(file, *input);
    if (metadata)
        get_attributes(spec, *metadata);
    Film film = film_of(spec, pixels, file);
    // Read as floats, whole numbers would be parts of the largest there is.
    if (const int samples = channel_of(spec, "samples");
        samples >= 0 && spec.channelformat(samples) == OIIO::TypeUInt32 &&
        !input->read_image(0, 0, samples, samples + 1, OIIO::TypeDesc::UINT32, film.samples.data()))
        fail_to_read(file, *input);
    return film;
}

void write_text(const path& target, const std::string& text, const char* option) {
    write_atomically(target, option, [&](AtomicFile& file) { file.write(text.data(), text.size(), 0); });
}

} // namespace vkvol
