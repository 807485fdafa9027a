// Colour: each channel of a medium of several is as if it were alone, in the mean and, within reason, in its noise.
#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "support/images.h"
#include "support/scenes.h"

using namespace vkvol;

namespace {

// Mean variance of the samples, over the picture.
glm::dvec3 mean_variance(const Film& film) {
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < film.variance.size(); ++i)
        sum += glm::dvec3(film.variance[i]) * double(film.samples[i]);
    return sum / double(film.variance.size());
}

Film channel_of(Film film, int channel) {
    for (std::vector<glm::vec3>* values : {&film.mean, &film.variance})
        for (glm::vec3& value : *values)
            value = glm::vec3(value[channel]);
    return film;
}

} // namespace

// Where the extinction is the same in all channels: where it differs, weights do, too (tools/results/README.md).
TEST_CASE("a channel of a cloud of coloured albedo is a grey one's, with at most twice its variance",
          "[gpu][agreement][long]") {
    const Rgb albedo(0.99, 0.5, 0.0);
    Scene scene = scene_of(medium(write_grid(cloud_grid()), 2.0, 0.9, 0.3), 11.0, 16);
    scene.lights = {sunlight(Rgb(3.0))};
    scene.background = Rgb(0.4);
    scene.settings.spp = 512;
    scene.volumes.front().sigma_s = 2.0 * albedo;
    scene.volumes.front().sigma_a = 2.0 * (1.0 - albedo);
    const Film chromatic = render_here(scene, 61).film;
    for (int channel = 0; channel < 3; ++channel) {
        Scene grey = scene;
        grey.volumes.front().sigma_s = Rgb(scene.volumes.front().sigma_s[channel]);
        grey.volumes.front().sigma_a = Rgb(scene.volumes.front().sigma_a[channel]);
        const Film alone = render_here(grey, std::uint32_t(62 + channel)).film;
        CHECK_AGREEMENT(
            agree(channel_of(chromatic, channel), alone, fmt::format("coloured albedo, channel {}", channel)));
        const double ratio = mean_variance(chromatic)[channel] / mean_variance(alone).x;
        CAPTURE(channel, ratio);
        CHECK(ratio < 2.0);
    }
}
