// Sums of samples that neither stall nor drift, and samples that are no number.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "film.h"
#include "film_sum.spv.h"
#include "kernels/test_items.h"
#include "support/kernel_runner.h"
#include "tests/reference/rng.h"

using namespace vkvol;
using shared::FilmInput;
using shared::FilmPixel;

namespace {

// `dispatches` times `samples` samples into each pixel; a kernel's loop may not be long (see Tuning::step_limit).
void add_samples(KernelRunner& runner, std::vector<FilmInput>& pixels, std::uint32_t dispatches,
                 std::uint32_t samples) {
    runner.push.budget = samples;
    for (std::uint32_t i = 0; i < dispatches; ++i) {
        const auto sums = runner.run<FilmPixel>(pixels);
        for (std::size_t k = 0; k < pixels.size(); ++k) {
            pixels[k].pixel = sums[k];
            pixels[k].first += samples;
        }
    }
}

double sum(const FilmPixel& p, int channel) {
    return double(p.sum[channel]) + p.sum_low[channel];
}
double square(const FilmPixel& p, int channel) {
    return double(p.square[channel]) + p.square_low[channel];
}

} // namespace

TEST_CASE("33 million samples of value 1 have the mean 1 exactly", "[gpu][film][hard][long]") {
    // A plain float sum stalls at 2^24.
    KernelRunner runner(film_sum_spv);
    std::vector<FilmInput> pixels(1);
    pixels[0].radiance = {1.0f, 3.0f, 0.1f};
    add_samples(runner, pixels, 1024, 1u << 15);
    const FilmPixel& p = pixels[0].pixel;
    const double n = 0x1p25;
    REQUIRE(p.count == 1u << 25);
    CHECK(sum(p, 0) / n == 1.0);
    CHECK(square(p, 0) / n == 1.0);
    CHECK(sum(p, 1) / n == 3.0);
    CHECK(square(p, 1) / n == 9.0);
    // 0.1f is no short binary fraction: every addition rounds, by 2^-24 of low, itself at most 2^-24 of the sum. In
    // the worst case all n errors have one sign: n 2^-48 = 2^-23.
    CHECK(sum(p, 2) / n == Approx(double(0.1f)).epsilon(0x1p-23));
    CHECK(square(p, 2) / n == Approx(double(0.1f) * 0.1f).epsilon(0x1p-22)); // the square itself is rounded
}

TEST_CASE("sums of random samples equal those in double precision", "[gpu][film]") {
    KernelRunner runner(film_sum_spv);
    constexpr std::uint32_t pixels_count = 64, dispatches = 20, samples = 5000;
    std::vector<FilmInput> pixels(pixels_count);
    for (std::uint32_t i = 0; i < pixels_count; ++i) {
        pixels[i].radiance = glm::vec3(1.0f, 1e-3f, 1e6f) * float(i + 1);
        pixels[i].random = 1;
    }
    const std::vector<FilmInput> first = pixels;
    add_samples(runner, pixels, dispatches, samples);
    for (std::uint32_t i = 0; i < pixels_count; ++i) {
        reference::Rng rng{i, 0, 0};
        glm::dvec3 expected(0.0), squares(0.0);
        for (std::uint32_t k = 0; k < dispatches * samples; ++k) {
            const glm::vec3 value = static_cast<float>(rng.next().x()) * first[i].radiance;
            expected += glm::dvec3(value);
            squares += glm::dvec3(value * value);
        }
        REQUIRE(pixels[i].pixel.count == dispatches * samples);
        for (int c = 0; c < 3; ++c) {
            CAPTURE(i, c);
            // Each of n = 1e5 additions rounds by 2^-48 at most: 4e-10 if all had one sign.
            CHECK(sum(pixels[i].pixel, c) == Approx(expected[c]).epsilon(1e-9));
            CHECK(square(pixels[i].pixel, c) == Approx(squares[c]).epsilon(1e-9));
        }
    }
}

TEST_CASE("samples that are not finite are dropped, counted and recorded", "[gpu][film][hard]") {
    constexpr float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    KernelRunner runner(film_sum_spv);
    std::vector<FilmInput> pixels(3);
    pixels[0].radiance = {1.0f, nan, 1.0f};
    pixels[1].radiance = {1.0f, 2.0f, -infinity};
    pixels[2].radiance = {1.0f, 2.0f, 3.0f};
    add_samples(runner, pixels, 1, 3);
    const shared::Counters counters = runner.counters();
    CHECK(counters.non_finite == 6u);
    // The first of each.
    REQUIRE(counters.non_finite_records == 2u);
    CHECK(counters.non_finite_place[0] + counters.non_finite_place[1] == 201u);
    CHECK((counters.non_finite_place[0] == 100u || counters.non_finite_place[0] == 101u));
    CHECK((counters.non_finite_sample[0] == 0u && counters.non_finite_sample[1] == 0u));
    std::vector<FilmInput> many(NON_FINITE_RECORDS + 2, pixels[0]);
    KernelRunner crowded(film_sum_spv);
    add_samples(crowded, many, 1, 1);
    CHECK(crowded.counters().non_finite == many.size());
    CHECK(crowded.counters().non_finite_records == many.size());
    for (const std::uint32_t place : crowded.counters().non_finite_place)
        CHECK((place >= 100u && place < 100u + many.size()));
    CHECK(pixels[0].pixel.count == 0u);
    CHECK(pixels[1].pixel.count == 0u);
    CHECK((pixels[1].pixel.sum == glm::vec3(0.0f)));
    CHECK(pixels[2].pixel.count == 3u);
    CHECK((pixels[2].pixel.sum == glm::vec3(3.0f, 6.0f, 9.0f)));
    CHECK((pixels[2].pixel.square == glm::vec3(3.0f, 12.0f, 27.0f)));
}

TEST_CASE("the mean of a picture and its error, by hand", "[cpu][film]") {
    Film film;
    film.mean = {glm::vec3(1, 2, 3), glm::vec3(3, 2, 1), glm::vec3(9, 9, 9)};
    film.variance = {glm::vec3(9, 0, 1), glm::vec3(16, 0, 3), glm::vec3(7, 7, 7)};
    film.samples = {4, 2, 0}; // the last was never sampled
    const ImageMean mean = image_mean(film);
    CHECK(mean.value == glm::dvec3(2.0));
    CHECK(mean.standard_error == glm::dvec3(2.5, 0.0, 1.0)); // sqrt(9 + 16) / 2
    CHECK(image_mean(Film{}).value == glm::dvec3(0.0));
    // The error of a single sample is not known.
    film.samples = {4, 1, 0};
    CHECK_FALSE(image_mean(film).standard_error);
    CHECK(relative_noise(film).value() == Approx(std::sqrt((9.0 + 0 + 1) / (1 + 4 + 9))));
    film.samples = {1, 1, 0};
    CHECK_FALSE(relative_noise(film));
}

namespace {

// Pixels of mean 1 are the object, those of `sky` the rest: each the mean of `n` samples with standard deviation a half
// of it in the object, and of `sky` itself in the sky.
Film lit_object(std::size_t object, std::size_t sky_pixels, float sky, std::uint32_t n) {
    Film film;
    for (std::size_t i = 0; i < object + sky_pixels; ++i) {
        const float mean = i < object ? 1.0f : sky;
        const float deviation = i < object ? 0.5f : sky;
        film.mean.emplace_back(mean);
        film.variance.emplace_back(deviation * deviation / float(n));
        film.samples.push_back(n);
    }
    return film;
}

} // namespace

TEST_CASE("a picture's noise is that of what is bright in it", "[cpu][film]") {
    for (const float sky : {0.0f, 1e-6f, 1e-3f}) {
        CAPTURE(sky);
        // Signals 100 against at most 9900e-6, errors 25 / n against as little: 5e-5 and 2e-4 of the sums, half in the
        // root.
        const std::optional<double> noise = relative_noise(lit_object(100, 9900, sky, 100));
        REQUIRE(noise);
        CHECK(*noise == Approx(0.05).epsilon(2e-4));
    }
    SECTION("it falls as 1 / sqrt(samples)") {
        const double one = *relative_noise(lit_object(10, 90, 0.01f, 16));
        CHECK(*relative_noise(lit_object(10, 90, 0.01f, 1024)) == Approx(one / 8.0).epsilon(1e-6));
    }
    SECTION("a factor on the picture, and black pixels, change nothing") {
        Film film = lit_object(10, 90, 0.1f, 16);
        const double noise = *relative_noise(film);
        for (std::size_t i = 0; i < film.pixel_count(); ++i) {
            film.mean[i] *= 1024.0f; // exact
            film.variance[i] *= 1024.0f * 1024.0f;
        }
        CHECK(*relative_noise(film) == Approx(noise).epsilon(1e-12));
        film.mean.resize(1000, glm::vec3(0.0f));
        film.variance.resize(1000, glm::vec3(0.0f));
        film.samples.resize(1000, 16);
        CHECK(*relative_noise(film) == Approx(noise).epsilon(1e-12));
    }
    SECTION("pixels of a single sample tell nothing, and black pictures have none") {
        Film film = lit_object(2, 0, 0.0f, 100);
        film.mean[1] = glm::vec3(1000.0f);
        film.samples[1] = 1;
        CHECK(*relative_noise(film) == Approx(0.05));
        CHECK_FALSE(relative_noise(lit_object(0, 4, 0.0f, 8)));
        CHECK_FALSE(relative_noise(lit_object(4, 4, 0.5f, 1)));
    }
    SECTION("one bright sample in each pixel is no more than 100 %") {
        Film film = lit_object(1, 0, 0.0f, 8);
        film.mean[0] = glm::vec3(1.0f / 8.0f); // of 1, 0, ... 0
        film.variance[0] = glm::vec3((1.0f / 8.0f - 1.0f / 64.0f) / 7.0f);
        CHECK(*relative_noise(film) == Approx(1.0));
    }
}
