#include "film_bands.h"

#include <algorithm>
#include <fmt/format.h>
#include <unistd.h>

#include "error.h"

namespace vkvol {

namespace {

constexpr double layer_bytes = 4.0 * sizeof(glm::vec3); // of a pixel

constexpr double mebibyte = 1048576.0;

std::uint64_t record_bytes(const shared::AovParams& layers) {
    return std::uint64_t{layers.records} * layers.count * sizeof(glm::vec3);
}

// What is too much would not fail: the system would end the program later, without a word.
void check_memory(const Crop& crop, std::uint32_t layers, int films) {
    // As sums, in memory of this machine for devices that share it; the same read back, for checkpoints; mean,
    // variance and samples.
    const double sums = sizeof(shared::FilmPixel) + layers * layer_bytes;
    const double bytes = sums * (films + 1.0) + (1.0 + layers) * 2.0 * sizeof(glm::vec3) + 4.0;
    const double width = crop.x1 - crop.x0, height = crop.y1 - crop.y0;
    const double memory = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
    if (width * height * bytes > memory)
        throw InputError(fmt::format("{:g} x {:g} pixels need {:.3g} GB of memory, and this machine has {:.3g}; lower "
                                     "--width, or render --crop windows",
                                     width, height, width * height * bytes * 1e-9, memory * 1e-9));
}

} // namespace

std::vector<Band> make_bands(const Device& device, Commands& commands, const Crop& crop, std::uint64_t most_bytes,
                             std::uint32_t most_rows, const shared::AovParams& layers, int films) {
    check_memory(crop, layers.count, films);
    const std::uint64_t width = static_cast<std::uint64_t>(crop.x1 - crop.x0);
    const std::uint64_t row_bytes = width * sizeof(shared::FilmPixel);
    const std::uint64_t records = record_bytes(layers), layer_row = width * layers.count * std::uint64_t(layer_bytes);
    if (records + layer_row > most_bytes)
        throw InputError(fmt::format("{} layers of {} paths and a row of pixels take {:.1f} MiB, but \"{}\" holds no "
                                     "more than {:.1f} MiB of them; ask for fewer layers, or for --schedule with fewer "
                                     "slots",
                                     layers.count, layers.records, double(records + layer_row) / mebibyte,
                                     device.info().name, double(most_bytes) / mebibyte));
    std::uint64_t most = std::max<std::uint64_t>((most_bytes - sizeof(shared::FilmPixel)) / row_bytes, 1);
    if (layers.count > 0)
        most = std::min(most, (most_bytes - records) / layer_row);
    if (most_rows > 0)
        most = std::min<std::uint64_t>(most, most_rows);
    const auto height = static_cast<std::uint32_t>(crop.y1 - crop.y0);
    // Of one height, but for a row, which the first has: each has as many particles as pixels, and all of them show the
    // same noise then.
    const std::uint64_t count = (height + most - 1) / most;
    const auto first_row = [&](std::uint64_t i) {
        return static_cast<std::uint32_t>((height * i + count - 1) / count);
    };
    std::vector<Band> bands;
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint32_t row = first_row(i), rows = first_row(i + 1) - row;
        const auto make = [&](const char* name, std::uint64_t bytes) {
            return Buffer(device, name, bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, BufferPlace::device);
        };
        bands.push_back({row, rows, make("film", rows * row_bytes + sizeof(shared::FilmPixel)), std::nullopt});
        if (layers.count > 0)
            bands.back().layers.emplace(make("layers", records + rows * layer_row));
        clear(commands, bands.back());
    }
    return bands;
}

void clear(Commands& commands, const Band& band) {
    commands.fill(band.film, 0);
    if (band.layers)
        commands.fill(*band.layers, 0);
}

namespace {
std::size_t first_pixel(const Band& band, std::uint32_t width) {
    return std::size_t(band.first_row) * width;
}
std::size_t pixel_count(const Band& band, std::uint32_t width) {
    return std::size_t(band.rows) * width;
}
} // namespace

std::vector<shared::FilmPixel> read_bands(Commands& commands, const std::vector<Band>& bands, std::uint32_t width) {
    std::vector<shared::FilmPixel> pixels(first_pixel(bands.back(), width) + pixel_count(bands.back(), width));
    for (const Band& band : bands) {
        const auto part = std::span(pixels).subspan(first_pixel(band, width), pixel_count(band, width));
        commands.download(band.film, std::as_writable_bytes(part));
    }
    return pixels;
}

void write_bands(Commands& commands, const std::vector<Band>& bands, std::uint32_t width,
                 std::span<const shared::FilmPixel> pixels) {
    for (const Band& band : bands)
        commands.upload(band.film, std::as_bytes(pixels.subspan(first_pixel(band, width), pixel_count(band, width))));
}

std::vector<shared::FilmPixel> read_sums(Commands& commands, const std::vector<Band>& bands, std::uint32_t width) {
    std::vector<shared::FilmPixel> sums(bands.size());
    for (std::size_t i = 0; i < bands.size(); ++i)
        commands.download(bands[i].film, std::as_writable_bytes(std::span(&sums[i], 1)),
                          pixel_count(bands[i], width) * sizeof(shared::FilmPixel));
    return sums;
}

void write_sums(Commands& commands, const std::vector<Band>& bands, std::uint32_t width,
                std::span<const shared::FilmPixel> sums) {
    for (std::size_t i = 0; i < bands.size(); ++i)
        commands.upload(bands[i].film, std::as_bytes(sums.subspan(i, 1)),
                        pixel_count(bands[i], width) * sizeof(shared::FilmPixel));
}

std::vector<glm::vec3> read_layers(Commands& commands, const std::vector<Band>& bands, std::uint32_t width,
                                   const shared::AovParams& layers) {
    const std::size_t each = 4 * std::size_t(layers.count);
    std::vector<glm::vec3> sums((first_pixel(bands.back(), width) + pixel_count(bands.back(), width)) * each);
    for (const Band& band : bands)
        if (band.layers) {
            const auto part = std::span(sums).subspan(first_pixel(band, width) * each, pixel_count(band, width) * each);
            commands.download(*band.layers, std::as_writable_bytes(part), record_bytes(layers));
        }
    return sums;
}

void write_layers(Commands& commands, const std::vector<Band>& bands, std::uint32_t width,
                  const shared::AovParams& layers, std::span<const glm::vec3> sums) {
    const std::size_t each = 4 * std::size_t(layers.count);
    for (const Band& band : bands)
        if (band.layers) {
            const auto part = sums.subspan(first_pixel(band, width) * each, pixel_count(band, width) * each);
            commands.upload(*band.layers, std::as_bytes(part), record_bytes(layers));
        }
}

void copy_rows(const BandOn& from, const BandOn& to, Rows rows, std::uint32_t width) {
    const std::size_t first = std::size_t(rows.begin) * width, count = std::size_t(rows.end - rows.begin) * width;
    std::vector<std::byte> bytes(count * sizeof(shared::FilmPixel));
    from.commands.download(from.band.film, bytes, first * sizeof(shared::FilmPixel));
    to.commands.upload(to.band.film, bytes, first * sizeof(shared::FilmPixel));
    if (!from.band.layers)
        return;
    const std::size_t each = from.layers.count * std::size_t(layer_bytes);
    bytes.resize(count * each);
    from.commands.download(*from.band.layers, bytes, record_bytes(from.layers) + first * each);
    to.commands.upload(*to.band.layers, bytes, record_bytes(to.layers) + first * each);
}

namespace {

glm::dvec3 variance_of_mean(const shared::FilmPixel& pixel) { // of two samples at least
    const double n = pixel.count;
    const glm::dvec3 mean = (glm::dvec3(pixel.sum) + glm::dvec3(pixel.sum_low)) / n;
    const glm::dvec3 square = glm::dvec3(pixel.square) + glm::dvec3(pixel.square_low);
    return glm::max((square / n - mean * mean) / (n - 1.0), glm::dvec3(0.0));
}

} // namespace

std::optional<glm::dvec3> variance_of_sums(std::span<const shared::FilmPixel> sums) {
    glm::dvec3 variance(0.0);
    for (const shared::FilmPixel& sum : sums) {
        if (sum.count < 2)
            return std::nullopt;
        variance += double(sum.count) * variance_of_mean(sum);
    }
    return variance;
}

namespace {
void develop_pixels(std::span<const shared::FilmPixel> pixels, Film& film) {
    for (const shared::FilmPixel& pixel : pixels) {
        const double n = pixel.count;
        const glm::dvec3 sum = glm::dvec3(pixel.sum) + glm::dvec3(pixel.sum_low);
        film.mean.emplace_back(n > 0 ? sum / n : glm::dvec3(0.0));
        film.variance.emplace_back(n > 1 ? variance_of_mean(pixel) : glm::dvec3(0.0));
        film.samples.push_back(pixel.count);
    }
}
} // namespace

// Where the host sees a film it is read in its place: pictures that are watched are developed again and again.
void develop(Commands& commands, const std::vector<Band>& bands, std::uint32_t width, Film& film) {
    film.mean.clear();
    film.variance.clear();
    film.samples.clear();
    if (!bands.front().film.mapped())
        return develop_pixels(read_bands(commands, bands, width), film);
    for (const Band& band : bands)
        develop_pixels(band.film.view<const shared::FilmPixel>().first(pixel_count(band, width)), film);
}

} // namespace vkvol
