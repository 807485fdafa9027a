#include "render.h"

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <thread>

namespace reference {

using vkvol::Rgb;

namespace {

void render_pixel(const World& world, vkvol::Film& film, int x, int y, std::uint32_t spp, std::uint32_t seed,
                  std::uint32_t sample_offset) {
    Rgb mean(0.0), m2(0.0); // Welford's running mean and sum of squared deviations
    for (std::uint32_t n = 0; n < spp; ++n) {
        const Rgb L = trace_path(world, x, y, sample_offset + n, seed);
        const Rgb delta = L - mean;
        mean += delta / (n + 1.0);
        m2 += delta * (L - mean);
    }
    const std::size_t i = static_cast<std::size_t>(y - film.crop.y0) * film.width() + (x - film.crop.x0);
    film.mean[i] = glm::vec3(mean);
    film.variance[i] = spp < 2 ? glm::vec3(0.0f) : glm::vec3(m2 / (spp - 1.0) / double(spp));
    film.samples[i] = spp;
}

} // namespace

vkvol::Film render(const World& world, vkvol::Crop crop, std::uint32_t spp, std::uint32_t seed, unsigned threads,
                   std::uint32_t sample_offset) {
    const vkvol::Picture& picture = world.scene.picture;
    if (crop.x0 < 0 || crop.y0 < 0 || crop.x1 > picture.width || crop.y1 > picture.height || crop.x0 >= crop.x1 ||
        crop.y0 >= crop.y1)
        throw std::runtime_error("the crop is empty or reaches beyond the picture");
    if (world.scene.periodic && !world.scene.surfaces.empty())
        throw std::runtime_error("the reference knows no surfaces that repeat");

    vkvol::Film film;
    film.picture_width = picture.width;
    film.picture_height = picture.height;
    film.crop = crop;
    const std::size_t pixels = static_cast<std::size_t>(film.width()) * film.height();
    film.mean.resize(pixels);
    film.variance.resize(pixels);
    film.samples.resize(pixels);

    std::atomic<int> next_row = crop.y0;
    const auto work = [&] {
        for (int y = next_row++; y < crop.y1; y = next_row++)
            for (int x = crop.x0; x < crop.x1; ++x)
                render_pixel(world, film, x, y, spp, seed, sample_offset);
    };
    std::vector<std::jthread> workers;
    for (unsigned i = 1; i < threads; ++i)
        workers.emplace_back(work);
    work();
    workers.clear(); // joins
    return film;
}

vkvol::Film render(const vkvol::Scene& scene, vkvol::Crop crop, std::uint32_t spp, std::uint32_t seed, unsigned threads,
                   std::uint32_t sample_offset) {
    return render(load_world(scene), crop, spp, seed, threads, sample_offset);
}

} // namespace reference
