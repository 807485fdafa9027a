#include "film_bands.h"

#include <algorithm>
#include <fmt/format.h>
#include <unistd.h>

#include "error.h"

namespace vkvol {

namespace {

// What is too much would not fail: the system would end the program later, without a word.
void check_memory(const Device& device, const Crop& crop) {
    // As sums, in memory of this machine if that is the device; the same read back; mean, variance and samples.
    const double bytes = sizeof(shared::FilmPixel) * (device.is_cpu() ? 2.0 : 1.0) + 2.0 * sizeof(glm::vec3) + 4.0;
    const double width = crop.x1 - crop.x0, height = crop.y1 - crop.y0;
    const double memory = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
    if (width * height * bytes > memory)
        throw InputError(fmt::format("{:g} x {:g} pixels need {:.3g} GB of memory, and this machine has {:.3g}; lower "
                                     "--width, or render --crop windows",
                                     width, height, width * height * bytes * 1e-9, memory * 1e-9));
}

} // namespace

std::vector<Band> make_bands(const Device& device, Commands& commands, const Crop& crop, std::uint64_t most_bytes) {
    check_memory(device, crop);
    const std::uint64_t row_bytes = std::uint64_t(crop.x1 - crop.x0) * sizeof(shared::FilmPixel);
    const std::uint64_t most = std::max<std::uint64_t>(most_bytes / row_bytes, 1);
    const auto height = static_cast<std::uint32_t>(crop.y1 - crop.y0);
    std::vector<Band> bands;
    for (std::uint32_t row = 0; row < height;) {
        const auto rows = static_cast<std::uint32_t>(std::min<std::uint64_t>(most, height - row));
        bands.push_back(
            {row, rows,
             Buffer(device, "film", rows * row_bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, BufferPlace::device)});
        commands.fill(bands.back().film, 0);
        row += rows;
    }
    return bands;
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

void develop(std::span<const shared::FilmPixel> pixels, Film& film) {
    film.mean.clear();
    film.variance.clear();
    film.samples.clear();
    for (const shared::FilmPixel& pixel : pixels) {
        const double n = pixel.count;
        const glm::dvec3 sum = glm::dvec3(pixel.sum) + glm::dvec3(pixel.sum_low);
        const glm::dvec3 square = glm::dvec3(pixel.square) + glm::dvec3(pixel.square_low);
        const glm::dvec3 mean = n > 0 ? sum / n : glm::dvec3(0.0);
        const glm::dvec3 variance = n > 1 ? (square / n - mean * mean) / (n - 1.0) : glm::dvec3(0.0);
        film.mean.emplace_back(mean);
        film.variance.emplace_back(glm::max(variance, glm::dvec3(0.0)));
        film.samples.push_back(pixel.count);
    }
}

} // namespace vkvol
