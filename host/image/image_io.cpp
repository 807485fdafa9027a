#include "image_io.h"

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
#include "metadata.h"
#include "one_line.h"
#include "picture_codec.h"

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

class FileSink : public PictureSink {
public:
    explicit FileSink(AtomicFile& file) : file_(file) {}
    bool write(const void* data, std::size_t size, std::int64_t at) override { return file_.write(data, size, at); }

private:
    AtomicFile& file_;
};

void write_pixels(AtomicFile& file, PictureFormat format, const PictureHeader& header, const void* pixels) {
    FileSink sink(file);
    const std::string reason = picture_codec().write(format, header, pixels, sink);
    file.check(); // the disk's own word comes first
    if (!reason.empty())
        throw std::runtime_error(one_line(reason));
}

// What we or the pixels themselves say already; the rest of a file's attributes is its metadata.
bool is_structural(const std::string& key) {
    static const char* const known[] = {"oiio:",        "openexr:", "compression", "worldToCamera", "PixelAspectRatio",
                                        "screenWindow", "nuke/",    "DateTime",    "capDate",       "chromaticities"};
    return std::any_of(std::begin(known), std::end(known),
                       [&key](const char* prefix) { return key.compare(0, std::strlen(prefix), prefix) == 0; });
}

Metadata metadata_of(const PictureHeader& header) {
    Metadata metadata = header.attributes;
    std::erase_if(metadata, [](const auto& attribute) { return is_structural(attribute.first); });
    return metadata;
}

PictureHeader header_of(const Film& film, std::vector<std::string> channels) {
    PictureHeader header;
    header.width = film.width();
    header.height = film.height();
    header.x = film.crop.x0;
    header.y = film.crop.y0;
    header.full_width = film.picture_width;
    header.full_height = film.picture_height;
    header.counts.assign(channels.size(), false);
    header.channels = std::move(channels);
    return header;
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

int channel_of(const PictureHeader& header, const char* name) {
    const auto found = std::find(header.channels.begin(), header.channels.end(), name);
    return found == header.channels.end() ? -1 : int(found - header.channels.begin());
}

// By the names in the image's metadata: other channels are no concern of ours.
void read_layers(const PictureHeader& header, const std::vector<float>& pixels, Film& film) {
    const bool is_own_alpha = channel_of(header, "alpha.A") < 0;
    std::istringstream names{text_of(header.attributes, layers_key)};
    for (std::string name; names >> name;) {
        FilmLayer layer{name, {}, {}};
        for (const char* const prefix : {"", "variance."}) {
            std::vector<int> channels;
            for (const char* letter = layer.channels(); *letter != 0; ++letter)
                channels.push_back(channel_of(header, channel_name(prefix, layer, *letter, is_own_alpha).c_str()));
            if (*std::min_element(channels.begin(), channels.end()) < 0)
                continue;
            std::vector<glm::vec3>& values = *prefix == 0 ? layer.mean : layer.variance;
            for (std::size_t i = 0; i < film.pixel_count(); ++i) {
                const float* pixel = &pixels[i * header.channels.size()];
                const auto value = [&](std::size_t c) { return pixel[channels[std::min(c, channels.size() - 1)]]; };
                values.emplace_back(value(0), value(1), value(2));
            }
        }
        if (!layer.mean.empty())
            film.layers.push_back(std::move(layer));
    }
}

// Without which samples would be taken for ones without noise.
bool knows_variance(const PictureHeader& header) {
    return channel_of(header, "variance.R") >= 0 && channel_of(header, "variance.G") >= 0 &&
           channel_of(header, "variance.B") >= 0;
}

Film film_of(const PictureHeader& header, const std::vector<float>& pixels, const path& file) {
    const auto channel = [&header](const char* name) { return channel_of(header, name); };
    const int color[3] = {channel("R"), channel("G"), channel("B")};
    const int variance[3] = {channel("variance.R"), channel("variance.G"), channel("variance.B")};
    const bool is_sure = knows_variance(header);
    const int samples = is_sure ? channel("samples") : -1;
    if (*std::min_element(color, color + 3) < 0)
        throw InputError(one_line(fmt::format("{}: has channels {}; R, G and B are needed", file.string(),
                                              fmt::join(header.channels, ", "))));
    Film film;
    film.picture_width = header.full_width;
    film.picture_height = header.full_height;
    film.crop.x0 = header.x - header.full_x;
    film.crop.y0 = header.y - header.full_y;
    film.crop.x1 = film.crop.x0 + header.width;
    film.crop.y1 = film.crop.y0 + header.height;
    const std::size_t count = std::size_t(header.width) * header.height;
    film.mean.resize(count);
    film.variance.resize(count, glm::vec3(0));
    film.samples.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const float* pixel = &pixels[i * header.channels.size()];
        for (int c = 0; c < 3; ++c) {
            film.mean[i][c] = pixel[color[c]];
            if (is_sure)
                film.variance[i][c] = pixel[variance[c]];
        }
        if (samples >= 0 && pixel[samples] > 0.0f && pixel[samples] < 4294967296.0f)
            film.samples[i] = static_cast<std::uint32_t>(pixel[samples]);
    }
    read_layers(header, pixels, film);
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
    const path place = behind_links(target);
    const path directory = place.has_parent_path() ? place.parent_path() : path(".");
    std::error_code error;
    if (!std::filesystem::exists(directory, error))
        throw InputError(
            fmt::format("{}: the directory {} does not exist; make it first", target.string(), directory.string()));
    if (std::filesystem::is_directory(target, error))
        throw InputError(fmt::format("{}: is a directory; expected the name of a file", target.string()));
    if (is_special(target))
        return;
    if (std::filesystem::exists(target, error) && access(target.c_str(), W_OK) != 0)
        throw InputError(
            fmt::format("{}: is not to be written: {}; name another place with {}, or change its permissions",
                        target.string(), std::strerror(errno), option));
    // Only making a file tells: permissions, read-only file systems and quotas all have a say.
    const path probe = temporary_name(place);
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
        } catch (const std::bad_alloc&) {
            failures += (failures.empty() ? "" : "; ") + target.string() + ": there is not enough memory to write it";
        } catch (const RenderError& error) {
            failures += (failures.empty() ? "" : "; ") + std::string(error.what());
        }
    if (!failures.empty())
        throw RenderError(failures + written);
}

void write_exr(const path& target, const Film& film, const Metadata& metadata, const char* option) {
    write_atomically(target, option, [&](AtomicFile& file) {
        check_consistent(film);
        PictureHeader header = header_of(film, channel_names(film));
        header.counts[samples_channel] = true;
        header.attributes = metadata;
        if (!film.layers.empty())
            header.attributes[layers_key] = layer_list(film);
        write_pixels(file, PictureFormat::exr, header, interleaved_channels(film).data());
    });
}

void write_display(const path& target, const Film& film, const ToneMapping& mapping) {
    write_atomically(target, "-o", [&](AtomicFile& file) {
        check_consistent(film);
        const FilmLayer* alpha = film.is_premultiplied ? film.layer("alpha") : nullptr;
        const std::vector<std::uint8_t> pixels = alpha ? tone_map(film, mapping, *alpha) : tone_map(film, mapping);
        std::vector<std::string> channels = {"R", "G", "B"};
        if (alpha)
            channels.push_back("A");
        write_pixels(file, PictureFormat::png, header_of(film, std::move(channels)), pixels.data());
    });
}

Film read_exr(const path& file, Metadata* metadata) {
    check_input_file(file, "");
    if (file_ending(file) != ".exr")
        throw InputError(fmt::format("{}: expected an .exr file", file.string()));
    const std::unique_ptr<PictureReader> reader = open_image(file);
    const PictureHeader& header = reader->header();
    std::vector<float> pixels(std::size_t(header.width) * header.height * header.channels.size());
    if (!reader->read(pixels.data()))
        fail_to_read(file, *reader);
    const Metadata found = metadata_of(header);
    Film film = film_of(header, pixels, file);
    film.has_other_primaries = !is_rec709(header);
    read_facts(found, film);
    if (metadata)
        *metadata = found;
    // Read as floats, whole numbers would be parts of the largest there is.
    if (const int samples = channel_of(header, "samples"); samples >= 0 && knows_variance(header) &&
                                                           header.counts[std::size_t(samples)] &&
                                                           !reader->read(samples, film.samples.data()))
        fail_to_read(file, *reader);
    return film;
}

void write_text(const path& target, const std::string& text, const char* option) {
    write_atomically(target, option, [&](AtomicFile& file) { file.write(text.data(), text.size(), 0); });
}

void write_parts(const path& target, std::span<const std::span<const std::byte>> parts) {
    write_atomically(target, "-o", [&](AtomicFile& file) {
        std::int64_t at = 0;
        for (const auto& part : parts) {
            file.write(part.data(), part.size(), at);
            at += static_cast<std::int64_t>(part.size());
        }
    });
}

} // namespace vkvol
