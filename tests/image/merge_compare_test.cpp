#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <random>

#include "compare.h"
#include "error.h"
#include "merge.h"
#include "metadata.h"
#include "support/statistics.h"

using namespace vkvol;

namespace {

constexpr int edge = 32;

// Sample k of a pixel, channel c: skewed, and dark most of the time, like sunlight found by chance.
double sample_value(std::mt19937& random, double brightness) {
    const double u = std::generate_canonical<double, 32>(random);
    return brightness * (u < 0.9 ? 0.2 * u : 10.0 * u);
}

struct Samples {
    std::vector<std::vector<std::array<double, 3>>> of_pixel;
};

Samples draw(unsigned seed, int count, double brightness = 1.0, std::size_t pixels = edge * edge) {
    std::mt19937 random(seed);
    Samples samples;
    samples.of_pixel.resize(pixels);
    for (auto& pixel : samples.of_pixel)
        for (int k = 0; k < count; ++k)
            pixel.push_back(
                {sample_value(random, brightness), sample_value(random, brightness), sample_value(random, brightness)});
    return samples;
}

// The statistics by their definition.
Film film_of(const Samples& samples, Crop crop = {0, edge, 0, edge}) {
    Film film;
    film.picture_width = film.picture_height = edge;
    film.crop = crop;
    for (const auto& pixel : samples.of_pixel) {
        const double n = double(pixel.size());
        glm::dvec3 mean(0), squares(0);
        for (const auto& sample : pixel)
            mean += glm::dvec3(sample[0], sample[1], sample[2]) / n;
        for (const auto& sample : pixel) {
            const glm::dvec3 d = glm::dvec3(sample[0], sample[1], sample[2]) - mean;
            squares += d * d;
        }
        film.mean.emplace_back(mean);
        film.variance.emplace_back(n > 1 ? squares / (n * (n - 1)) : glm::dvec3(0));
        film.samples.push_back(std::uint32_t(pixel.size()));
    }
    return film;
}

MergeInput input(const std::string& name, const Film& film, int offset, int spp, int seed = 0) {
    return {name,
            film,
            {{"vkvol/sceneHash", "abc"},
             {"vkvol/integrator", "ratioTracking"},
             {"vkvol/seed", seed},
             {"vkvol/sampleOffset", offset},
             {"samplesPerPixel", spp},
             {"renderTimeSeconds", 1.5f}}};
}

CompareOptions options_at(double significance = 0.01) {
    CompareOptions options;
    options.significance = significance;
    return options;
}

void check_same_statistics(const Film& merged, const Film& expected) {
    REQUIRE(merged.pixel_count() == expected.pixel_count());
    CHECK(merged.samples == expected.samples);
    double worst_mean = 0.0, worst_variance = 0.0;
    for (std::size_t i = 0; i < merged.pixel_count(); ++i)
        for (int c = 0; c < 3; ++c) {
            const double mean = expected.mean[i][c], variance = expected.variance[i][c];
            worsen(worst_mean, std::abs(merged.mean[i][c] / mean - 1));
            worsen(worst_variance, variance > 0 ? std::abs(merged.variance[i][c] / variance - 1) : 0.0);
        }
    CHECK(worst_mean < 3e-7); // rounding to float, once in the inputs and once in the result
    CHECK(worst_variance < 2e-6);
}

} // namespace

TEST_CASE("merging unequal sample counts equals pooling the samples", "[cpu][merge]") {
    const Samples a = draw(1, 3), b = draw(2, 17), c = draw(3, 1);
    Samples all = a;
    for (std::size_t i = 0; i < all.of_pixel.size(); ++i)
        for (const Samples* more : {&b, &c})
            all.of_pixel[i].insert(all.of_pixel[i].end(), more->of_pixel[i].begin(), more->of_pixel[i].end());
    const MergeResult merged =
        merge_films({input("a", film_of(a), 0, 3), input("b", film_of(b), 3, 17), input("c", film_of(c), 20, 1)});
    check_same_statistics(merged.film, film_of(all));
    CHECK((merged.metadata.at("samplesPerPixel") == Metadata::mapped_type(21)));
    CHECK((merged.metadata.at("vkvol/ranges") == Metadata::mapped_type("0:0-21")));
    CHECK(merged.metadata.count("vkvol/seed") == 0);
    CHECK((merged.metadata.at("renderTimeSeconds") == Metadata::mapped_type(4.5f)));
}

TEST_CASE("merging two single samples by hand", "[cpu][merge]") {
    Samples a = draw(1, 1, 1.0, 1), b = a;
    a.of_pixel[0][0] = {1, 2, 3};
    b.of_pixel[0][0] = {3, 2, 7};
    const Crop one{0, 1, 0, 1};
    const Film film = merge_films({input("a", film_of(a, one), 0, 1), input("b", film_of(b, one), 1, 1)}).film;
    CHECK(film.mean[0] == glm::vec3(2, 2, 5));
    CHECK(film.variance[0] == glm::vec3(1, 0, 4)); // s^2 = 2, 0, 8; over n = 2
    CHECK(film.samples[0] == 2);
}

TEST_CASE("disjoint windows are put side by side", "[cpu][merge]") {
    const Samples whole = draw(4, 5);
    const auto window = [&](Crop crop) {
        Samples part;
        for (int y = crop.y0; y < crop.y1; ++y)
            for (int x = crop.x0; x < crop.x1; ++x)
                part.of_pixel.push_back(whole.of_pixel[std::size_t(y * edge + x)]);
        return film_of(part, crop);
    };
    const MergeResult merged =
        merge_films({input("a", window({0, 10, 0, edge}), 0, 5), input("b", window({10, edge, 0, 7}), 0, 5),
                     input("c", window({10, edge, 7, edge}), 0, 5)});
    check_same_statistics(merged.film, film_of(whole));
    CHECK((merged.metadata.at("samplesPerPixel") == Metadata::mapped_type(5)));
    CHECK_THROWS_WITH(
        merge_films({input("a", window({0, 10, 0, edge}), 0, 5), input("b", window({9, edge, 0, edge}), 0, 5)}),
        Catch::Contains("windows overlap"));
}

TEST_CASE("a merged layer of which a part has no variance has none", "[cpu][merge]") {
    std::vector<MergeInput> inputs;
    for (int i = 0; i < 2; ++i) {
        Film film = film_of(draw(unsigned(3 + i), 4));
        film.layers = {FilmLayer{"direct", film.mean, film.variance}};
        inputs.push_back(input(i == 0 ? "a" : "b", film, 4 * i, 4));
    }
    CHECK_FALSE(merge_films(inputs).film.layers.at(0).variance.empty());
    inputs[1].film.layers[0].variance.clear();
    CHECK(merge_films(inputs).film.layers.at(0).variance.empty());
}

TEST_CASE("what does not belong together is not merged", "[cpu][merge]") {
    const Film film = film_of(draw(1, 4));
    const MergeInput a = input("a.exr", film, 0, 4);
    const auto with = [&](const char* key, const Metadata::mapped_type& value) {
        MergeInput b = input("b.exr", film, 4, 4);
        b.metadata[key] = value;
        return b;
    };
    CHECK_NOTHROW(merge_films({a, input("b.exr", film, 4, 4)}));
    CHECK_NOTHROW(merge_films({a, input("b.exr", film, 0, 4, 1)}));
    CHECK_THROWS_WITH(merge_films({a, with("vkvol/sceneHash", "other")}),
                      "a.exr and b.exr do not belong together: vkvol/sceneHash is 'abc' and 'other'");
    CHECK_THROWS_WITH(merge_films({a, with("vkvol/integrator", "deltaTracking")}), Catch::Contains("vkvol/integrator"));
    CHECK_THROWS_WITH(merge_films({a, with("vkvol/layersOf", "light of 'key'; ")}), Catch::Contains("vkvol/layersOf"));
    CHECK_THROWS_WITH(merge_films({a, with("vkvol/sampleOffset", 3)}), Catch::Contains("the same samples"));
    CHECK_THROWS_WITH(merge_films({a, a}), Catch::Contains("the same samples"));
    MergeInput larger = input("b.exr", film, 4, 4);
    larger.film.picture_width = 64;
    CHECK_THROWS_WITH(merge_films({a, larger}), Catch::Contains("32x32 and 64x32"));
    MergeInput unknown = input("b.exr", film, 4, 4);
    unknown.film.samples.assign(film.pixel_count(), 0);
    CHECK_THROWS_WITH(merge_films({a, unknown}), Catch::Contains("how many samples"));
    CHECK_THROWS_AS(merge_films({}), InputError);
    // A merged image remembers its range: its parts cannot be merged into it again.
    const MergeResult both = merge_films({a, input("b.exr", film, 4, 4)});
    CHECK_THROWS_WITH(merge_films({{"both", both.film, both.metadata}, a}), Catch::Contains("the same samples"));
}

TEST_CASE("compare: error figures by hand", "[cpu][merge][compare]") {
    Film a;
    a.picture_width = 2;
    a.picture_height = 1;
    a.crop = {0, 2, 0, 1};
    a.mean = {{1, 1, 1}, {2, 2, 2}};
    a.variance.resize(2);
    a.samples = {1, 1};
    Film b = a;
    b.mean = {{1, 1, 1}, {1, 2, 4}};
    const Comparison result = compare_films(a, b, options_at());
    CHECK(result.mse == Approx((1.0 + 4.0) / 6));
    CHECK(result.relmse == Approx((1 / 1.01 + 4 / 16.01) / 6));
    CHECK(result.psnr == Approx(10 * std::log10(16.0 / (5.0 / 6))));
    CHECK(result.max_abs_difference == 2.0);
    CHECK(result.mean_ratio[0] == Approx(1.5));
    CHECK(result.mean_ratio[1] == 1.0);
    CHECK(result.mean_ratio[2] == Approx(0.6));
    CHECK(result.identical_pixels == 1);
    CHECK_FALSE(result.has_variance);
    CHECK(result.different);
    CHECK_FALSE(compare_films(a, a, options_at()).different);
    CompareOptions loose;
    loose.max_relmse = 0.3;
    CHECK_FALSE(compare_films(a, b, loose).different);
    loose.max_relmse = 0.2;
    CHECK(compare_films(a, b, loose).different);
}

// Two-sided limits from tables of the normal distribution: 1 % shared by 1 and by 100 comparisons.
TEST_CASE("compare: limits are those of tables", "[cpu][merge][compare]") {
    const auto limit_of = [](std::size_t pixels) {
        Film film;
        film.picture_width = static_cast<int>(pixels);
        film.picture_height = 1;
        film.crop = {0, static_cast<int>(pixels), 0, 1};
        film.mean.assign(pixels, glm::vec3(1.0f));
        film.variance.assign(pixels, glm::vec3(0.01f));
        film.samples.assign(pixels, 1000000);
        return compare_films(film, film, options_at()).z_bound;
    };
    CHECK(limit_of(1) == Approx(3.1435).epsilon(1e-4));   // half of it by three channels
    CHECK(limit_of(100) == Approx(4.3049).epsilon(1e-4)); // by three hundred
}

TEST_CASE("compare: noise alone is no difference", "[cpu][merge][compare]") {
    // At significance 0.01 one of a hundred pairs may be called different; more than 4 of 100 happen once in 300.
    for (const auto& [n_a, n_b] : {std::pair{4, 4}, {16, 16}, {8, 256}, {2, 32}, {64, 1}}) {
        int different = 0;
        for (unsigned i = 0; i < 100; ++i)
            different += compare_films(film_of(draw(1000 + i, n_a, 1.0, 256), {0, 16, 0, 16}),
                                       film_of(draw(5000 + i, n_b, 1.0, 256), {0, 16, 0, 16}), options_at())
                                 .different
                             ? 1
                             : 0;
        INFO(n_a << " against " << n_b);
        CHECK(different <= 4);
    }
}

// Where both have one sample nothing is known of its variance; where one has none, nothing of the pixel.
TEST_CASE("compare: interrupted pictures differ by noise alone", "[cpu][merge][compare]") {
    for (unsigned seed = 0; seed < 30; ++seed) {
        Samples a = draw(2 * seed, 8), b = draw(2 * seed + 1, 8);
        for (std::size_t i = 0; i < a.of_pixel.size(); i += 2)
            for (Samples* each : {&a, &b})
                each->of_pixel[i].resize(1);
        for (std::size_t i = 1; i < a.of_pixel.size(); i += 8)
            b.of_pixel[i].clear();
        const Comparison result = compare_films(film_of(a), film_of(b), options_at(1e-4));
        CAPTURE(seed, result.reason, result.mean_z[0]);
        CHECK_FALSE(result.different);
    }
}

// By a table of Student's t: what happens by chance once in a hundred times is 9.925 standard errors with 2 degrees of
// freedom, 4.604 with 4 and 2.576 with any number. Wallace's formula is 3 % below at the worst of these.
TEST_CASE("compare: means of few samples are judged by Student's t", "[cpu][merge][compare]") {
    for (const auto& [samples, table] : {std::pair{2u, 9.925}, {3u, 4.604}, {1u << 30, 2.576}}) {
        Film a = film_of(draw(1, 2, 1.0, 1), {0, 1, 0, 1});
        a.samples = {samples};
        a.mean = {glm::vec3(0.0f)};
        a.variance = {glm::vec3(1.0f)};
        Film b = a;
        b.mean = {glm::vec3(float(table * std::sqrt(2.0)))};
        CAPTURE(samples);
        CHECK(compare_films(a, b, options_at()).mean_z[0] == Approx(2.576).epsilon(0.03));
        a.is_correlated = b.is_correlated = true;
        a.sum_variance = b.sum_variance = glm::dvec3(1.0);
        CHECK(compare_films(a, b, options_at()).mean_z[0] == Approx(2.576).epsilon(0.03));
    }
}

// An image of unknown making may be exact, but the other's variance is known from its samples alone.
TEST_CASE("compare: against what has no samples the others' number counts", "[cpu][merge][compare]") {
    int different = 0;
    std::mt19937 random(1);
    std::normal_distribution<double> normal(1.0, 0.3); // skewed samples are beyond any table's judgement
    for (unsigned i = 0; i < 100; ++i) {
        Samples samples = draw(1, 8, 1.0, 256);
        for (auto& pixel : samples.of_pixel)
            for (auto& sample : pixel)
                sample = {normal(random), normal(random), normal(random)};
        const Film noisy = film_of(samples, {0, 16, 0, 16});
        Film exact = noisy;
        exact.mean.assign(256, glm::vec3(1.0f));
        exact.variance.assign(256, glm::vec3(0.0f));
        exact.samples.assign(256, 0u);
        different += compare_films(noisy, exact, options_at()).different ? 1 : 0;
    }
    CHECK(different <= 4); // as above
}

// Of eight passes of 100 samples the variance is known as well as of eight samples.
TEST_CASE("compare: variances of passes are known from these", "[cpu][merge][compare]") {
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal;
    int different = 0, by_samples = 0;
    for (int i = 0; i < 100; ++i) {
        Film a, b;
        a.picture_width = a.picture_height = 64;
        a.crop = {0, 64, 0, 64};
        a.samples.assign(4096, 800u);
        b = a;
        for (int pixel = 0; pixel < 4096; ++pixel) {
            std::vector<double> means(8);
            double mean = 0.0, squares = 0.0;
            for (double& each : means)
                mean += (each = 1.0 + normal(random)) / 8.0;
            for (const double each : means)
                squares += (each - mean) * (each - mean);
            a.mean.emplace_back(float(mean));
            a.variance.emplace_back(float(squares / 7.0 / 8.0));
            b.mean.emplace_back(1.0f);
            b.variance.emplace_back(1e-8f);
        }
        by_samples += compare_films(a, b, options_at()).different ? 1 : 0;
        a.passes = 8;
        different += compare_films(a, b, options_at()).different ? 1 : 0;
    }
    CHECK(by_samples > 20);
    CHECK(different <= 4); // as above
}

// Its difference would count, and no variance.
TEST_CASE("compare: single samples beside an image of unknown making are not judged", "[cpu][merge][compare]") {
    const Film noisy = film_of(draw(7, 1, 1.0, 256), {0, 16, 0, 16});
    Film exact = noisy;
    exact.mean.assign(256, glm::vec3(100.0f));
    exact.variance.assign(256, glm::vec3(0.0f));
    exact.samples.assign(256, 0u);
    CHECK(compare_films(noisy, exact, options_at()).mean_z[0] == 0.0);
}

// Pixels that share samples: of one window by the numbers of samples, windows side by side add up.
TEST_CASE("variances of sums are merged, and compared by", "[cpu][merge][compare]") {
    const auto with = [](Film film, glm::dvec3 variance) {
        film.is_correlated = true;
        film.sum_variance = variance;
        return film;
    };
    const auto long_rendered = [](Film film) {
        film.samples.assign(film.pixel_count(), 1u << 30);
        return film;
    };
    const Film some = with(film_of(draw(1, 4)), {8.0, 4.0, 2.0}), more = with(film_of(draw(2, 12)), {4.0, 4.0, 2.0});
    const MergeResult merged = merge_films({input("a", some, 0, 4), input("b", more, 4, 12)});
    REQUIRE(merged.film.sum_variance);
    CHECK(merged.film.sum_variance->x == Approx((16.0 * 8.0 + 144.0 * 4.0) / 256.0));
    CHECK(merged.film.sum_variance->z == Approx(160.0 * 2.0 / 256.0));
    Film read;
    read_facts(merged.metadata, read);
    REQUIRE(read.sum_variance);
    CHECK(*read.sum_variance == *merged.film.sum_variance);
    // The sums differ by their noise as independent pixels, which is far above the variance of 8 that they say.
    const Comparison result =
        compare_films(long_rendered(some), long_rendered(with(film_of(draw(3, 4)), {1e-3, 1e-3, 1e-3})), options_at());
    CHECK(result.has_mean_z);
    double sum = 0.0;
    for (std::size_t i = 0; i < some.pixel_count(); ++i)
        sum += double(some.mean[i].x) - film_of(draw(3, 4)).mean[i].x;
    CHECK(result.mean_z[0] == Approx(std::abs(sum) / std::sqrt(8.001)).epsilon(1e-3));
    // Where pixels have no sample the others' number counts.
    Film holed = some;
    holed.samples.front() = 0;
    CHECK(merge_films({input("a", holed, 0, 4), input("b", more, 4, 12)}).film.sum_variance->x ==
          Approx(merged.film.sum_variance->x));
    Film unknown = some;
    unknown.sum_variance.reset();
    CHECK_FALSE(compare_films(some, unknown, options_at()).has_mean_z);
    CHECK_FALSE(merge_films({input("a", some, 0, 4), input("b", unknown, 4, 4)}).film.sum_variance);
}

TEST_CASE("films without noise are the same but for rounding, and films of nothing in common are not", "[cpu][merge]") {
    Film film = film_of(draw(3u, 64));
    for (glm::vec3& variance : film.variance)
        variance = glm::vec3(0.0f);
    Film other = film;
    other.mean.front() *= 1.0f + 2e-7f;
    CHECK_FALSE(compare_films(film, other, options_at()).different);
    other.mean.front() *= 1.01f;
    CHECK(compare_films(film, other, options_at()).different);
    std::fill(film.samples.begin() + 1, film.samples.end(), 0u);
    other.samples.front() = 0;
    CHECK(compare_films(film, other, options_at()).different);
}

TEST_CASE("denoised films are not merged", "[cpu][merge]") {
    Film film = film_of(draw(3u, 4));
    film.layers.push_back({"noisy", film.mean, film.variance});
    CHECK_THROWS_WITH(merge_films({input("a", film, 0, 4)}), Catch::Contains("denoised"));
}

TEST_CASE("depths of single samples know their scatter once merged", "[cpu][merge]") {
    const float weight = GENERATE(1.0f, 0.25f); // alike, of all: how much of each sample collides changes nothing
    std::vector<MergeInput> parts;
    double mean = 0.0, squares = 0.0;
    for (int k = 0; k < 16; ++k) {
        Film film = film_of(draw(unsigned(k), 1));
        const float depth = 3.0f + 0.25f * float(k % 5);
        film.layers.push_back({"depth", std::vector<glm::vec3>(film.pixel_count(), glm::vec3(depth)),
                               std::vector<glm::vec3>(film.pixel_count(), glm::vec3(0.0f))});
        film.layers.push_back({"coverage", std::vector<glm::vec3>(film.pixel_count(), glm::vec3(weight)),
                               std::vector<glm::vec3>(film.pixel_count(), glm::vec3(0.0f))});
        parts.push_back(input(std::to_string(k), film, k, 1));
        mean += depth / 16.0;
        squares += depth * depth / 16.0;
    }
    const Film merged = merge_films(parts).film;
    CHECK(merged.layer("depth")->mean[5].x == Approx(mean));
    CHECK(merged.layer("depth")->variance[5].x == Approx((squares - mean * mean) / 15.0).epsilon(1e-4));
}

// Of samples that all collide alike the error of a mean depth is that of any mean, in one go or in parts.
TEST_CASE("depths of parts have the error of the whole", "[cpu][merge]") {
    const auto [parts, samples] = GENERATE(std::pair(2, 1), std::pair(32, 2), std::pair(4, 16));
    const int all = parts * samples;
    const float weight = 0.5f;
    std::mt19937 random(7);
    std::normal_distribution<float> depth(4.0f, 1.0f);
    double sum = 0.0, squares = 0.0;
    std::vector<MergeInput> inputs;
    for (int k = 0; k < parts; ++k) {
        double part = 0.0, part_squares = 0.0;
        for (int i = 0; i < samples; ++i) {
            const double d = depth(random);
            part += d / samples;
            part_squares += d * d / samples;
        }
        sum += part * samples;
        squares += part_squares * samples;
        const double variance = samples > 1 ? (part_squares - part * part) / (samples - 1) : 0.0;
        Film film = film_of(draw(unsigned(k), samples));
        const auto everywhere = [&](double value) {
            return std::vector<glm::vec3>(film.pixel_count(), glm::vec3(float(value)));
        };
        film.layers.push_back({"depth", everywhere(part), everywhere(variance)});
        film.layers.push_back({"coverage", everywhere(weight), everywhere(0.0)});
        inputs.push_back(input(std::to_string(k), film, k * samples, samples));
    }
    const double mean = sum / all;
    const Film merged = merge_films(inputs).film;
    CHECK(merged.layer("depth")->mean[5].x == Approx(mean));
    CHECK(merged.layer("depth")->variance[5].x == Approx((squares / all - mean * mean) / (all - 1)).epsilon(1e-4));
}

TEST_CASE("depths are merged by how many collisions they are of", "[cpu][merge]") {
    const auto seen = [](unsigned seed, int samples, float depth, float coverage) {
        Film film = film_of(draw(seed, samples));
        film.layers.push_back({"depth", std::vector<glm::vec3>(film.pixel_count(), glm::vec3(depth)),
                               std::vector<glm::vec3>(film.pixel_count(), glm::vec3(0.1f))});
        film.layers.push_back({"coverage", std::vector<glm::vec3>(film.pixel_count(), glm::vec3(coverage)), {}});
        return film;
    };
    const Film merged =
        merge_films({input("a", seen(1, 4, 2.0f, 0.5f), 0, 4), input("b", seen(2, 12, 6.0f, 0.25f), 4, 12)}).film;
    CHECK(merged.layer("depth")->mean[5].x == Approx((4 * 0.5 * 2.0 + 12 * 0.25 * 6.0) / (4 * 0.5 + 12 * 0.25)));
}

TEST_CASE("compare: real differences are found", "[cpu][merge][compare]") {
    const Film reference = film_of(draw(1, 256));
    CHECK(compare_films(film_of(draw(2, 64, 1.05)), reference, options_at()).different); // 5 % brighter
    Film spot = film_of(draw(3, 64));
    CHECK_FALSE(compare_films(spot, reference, options_at()).different);
    spot.mean[77].y += 10.0f; // one pixel
    const Comparison result = compare_films(spot, reference, options_at());
    CHECK(result.different);
    CHECK(result.beyond_bound == 1);
    // Without any noise in both: 64 samples of the same value each.
    Film flat = reference, other = reference;
    flat.variance.assign(flat.pixel_count(), glm::vec3(0));
    other.variance = flat.variance;
    other.variance[0] = glm::vec3(1);
    other.mean[5].x += 0.01f;
    CHECK(compare_films(flat, other, options_at()).beyond_bound == 1);
    Film broken = reference;
    broken.mean[3].z = std::numeric_limits<float>::quiet_NaN();
    CHECK(compare_films(broken, reference, options_at()).different);
    CHECK(compare_films(broken, reference, options_at()).non_finite == 1);
}

TEST_CASE("compare: only equal windows", "[cpu][merge][compare]") {
    const Film a = film_of(draw(1, 2));
    Film b = a;
    b.picture_width = 33;
    CHECK_THROWS_WITH(compare_films(a, b, options_at()), Catch::Contains("cannot be compared"));
    b = a;
    b.crop = {1, edge + 1, 0, edge};
    CHECK_THROWS_AS(compare_films(a, b, options_at()), InputError);
}
