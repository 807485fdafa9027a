#include "images.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <limits>
#include <thread>

#include "image_io.h"
#include "statistics.h"
#include "test_device.h"
#include "tests/reference/reference.h"
#include "thorough.h"

namespace vkvol {

namespace {

constexpr double significance = 0.01;
constexpr double most_comparisons = 1000.0; // some 600, and more of them with VKVOL_THOROUGH=1

// Single precision: a sample of a path with some tens of multiplications is known to 1e-6, the film's mean to 6e-8.
constexpr double rounding = 1e-5;

// Gathers z per pixel and channel, and their sum over the picture.
class Judge {
public:
    explicit Judge(const Film& like) : z_(like) {
        std::fill(z_.mean.begin(), z_.mean.end(), glm::vec3(0.0f));
        std::fill(z_.variance.begin(), z_.variance.end(), glm::vec3(0.0f));
    }

    // `p`: of a difference at least as large, from the difference and the variance that is expected of it.
    void add(std::size_t pixel, int channel, double difference, double variance, double scale, double p) {
        z_.mean[pixel][channel] = static_cast<float>(difference / std::sqrt(variance + 1e-30));
        difference_[channel] += difference;
        variance_[channel] += variance;
        scale_[channel] += scale;
        tests_ += 1.0;
        if (!std::isnan(worst_p_) && !(p >= worst_p_)) { // NaN too, for good
            worst_p_ = p;
            worst_ = pixel;
        }
    }

    void add(std::size_t pixel, int channel, double difference, double variance, double scale) {
        add(pixel, channel, difference, variance, scale, normal_p(z_of(difference, variance, scale)));
    }

    // Notes the variance of the difference of the sums over all pixels, which need not be independent of each other.
    void know_variance_of_sum(std::initializer_list<const Film*> films) {
        glm::dvec3 variance(0.0);
        for (const Film* film : films) {
            const std::optional<glm::dvec3> one = variance_of_sum(*film);
            if (!one)
                return;
            variance += *one;
        }
        variance_ = variance;
    }

    Agreement judge(const std::string& name, const Film& film, const Film* other) const {
        // Half of the share for the pixels, half for the means.
        const double share = sidak(significance, most_comparisons);
        const double pixel_limit = sidak(share, 2.0 * tests_), mean_limit = sidak(share, 6.0);
        Agreement result;
        result.ok = worst_p_ >= pixel_limit;
        result.report = fmt::format("{}: worst pixel ({}, {}) z {:.2f}, p {:.2g} of at least {:.2g}; mean z", name,
                                    film.crop.x0 + int(worst_) % film.width(),
                                    film.crop.y0 + int(worst_) / film.width(), worst_z(), worst_p_, pixel_limit);
        for (int channel = 0; channel < 3; ++channel) {
            const double z = z_of(difference_[channel], variance_[channel], scale_[channel]);
            result.ok = result.ok && normal_p(z) >= mean_limit;
            result.report += fmt::format(" {:.2f}", std::copysign(z, difference_[channel]));
        }
        result.report += fmt::format(", p at least {:.2g}", mean_limit);
        if (!result.ok)
            result.report += "; images: " + leave_images(name, film, other);
        return result;
    }

private:
    // NaN, which nothing passes, of what is no number or has no end, on either side.
    static double z_of(double difference, double variance, double scale) {
        const double excess = std::abs(difference) - rounding * scale;
        if (!std::isfinite(excess))
            return NAN;
        return excess > 0.0 ? excess / std::sqrt(variance) : 0.0;
    }

    double worst_z() const {
        const glm::vec3 z = z_.mean[worst_];
        const int channel = std::abs(z.x) >= std::abs(z.y) && std::abs(z.x) >= std::abs(z.z) ? 0
                            : std::abs(z.y) >= std::abs(z.z)                                 ? 1
                                                                                             : 2;
        return z[channel];
    }

    std::string leave_images(std::string name, const Film& film, const Film* other) const {
        std::replace_if(
            name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c) && c != '.'; }, '_');
        const std::filesystem::path directory = std::filesystem::absolute("failed_images");
        std::filesystem::create_directories(directory);
        write_exr(directory / (name + ".device.exr"), film, {});
        if (other)
            write_exr(directory / (name + ".expected.exr"), *other, {});
        write_exr(directory / (name + ".z.exr"), z_, {});
        return (directory / (name + ".*.exr")).string();
    }

    Film z_;
    glm::dvec3 difference_{0.0}, variance_{0.0}, scale_{0.0};
    double tests_ = 0.0;
    double worst_p_ = 1.0;
    std::size_t worst_ = 0;
};

// n KL(q || p), the relative entropy of binomials.
double binomial_divergence(double n, double q, double p) {
    const auto term = [](double a, double b) { return a > 0.0 ? a * std::log(a / b) : 0.0; };
    return n * std::max(0.0, term(q, p) + term(1.0 - q, 1.0 - p));
}

RenderResult render_one(const Scene& scene, const RenderJob& job) {
    RenderResult result = render(test_device(), scene, job);
    CHECK(result.counts.step_caps == 0);
    CHECK(result.counts.majorant_violations == 0);
    CHECK(result.counts.non_finite == 0);
    CHECK(result.counts.queue_overflows == 0);
    return result;
}

} // namespace

RenderResult render_here(const Scene& scene, std::uint32_t seed, RenderJob job) {
    job.seed = seed;
    job.disk_cache = false;
    if (job.crop.x1 == 0)
        job.crop = {0, scene.picture.width, 0, scene.picture.height};
    const bool either = job.plan.schedule == Schedule::automatic;
    if (either) // a GPU's compiler may round the schedules' kernels differently: each then has half of the pictures
        job.plan.schedule = test_device().is_cpu() || seed % 2 == 0 ? Schedule::fused : Schedule::staged;
    RenderResult result = render_one(scene, job);
    const bool to_the_end = !job.time_limit && !job.interrupted && !job.checkpoint && !job.resume && !job.trace;
    if (either && to_the_end && test_device().is_cpu() && has_its_turn()) {
        // Look-ups and cells also count where batches end: see sky.comp.
        job.plan.schedule = Schedule::staged;
        const RenderResult staged = render_one(scene, job);
        CHECK(same_bits(staged.film, result.film));
        CHECK(staged.counts.paths == result.counts.paths);
        CHECK(staged.counts.real_collisions == result.counts.real_collisions);
        CHECK(staged.counts.null_collisions == result.counts.null_collisions);
        // Lamps beside the medium may be seen without shadow rays: there, too, a pixel's batch decides.
        if (std::none_of(scene.lights.begin(), scene.lights.end(), is_lamp))
            CHECK(staged.counts.shadow_rays == result.counts.shadow_rays);
        CHECK(staged.counts.depth_caps == result.counts.depth_caps);
    }
    return result;
}

Film render_reference(const Scene& scene, std::uint32_t seed) {
    const Crop whole{0, scene.picture.width, 0, scene.picture.height};
    return reference::render(scene, whole, scene.settings.spp, seed, std::thread::hardware_concurrency());
}

Agreement agree(const Film& film, const Film& other, const std::string& name) {
    REQUIRE(film.pixel_count() == other.pixel_count());
    Judge judge(film);
    for (std::size_t i = 0; i < film.pixel_count(); ++i)
        for (int channel = 0; channel < 3; ++channel) {
            const double a = film.mean[i][channel], b = other.mean[i][channel];
            judge.add(i, channel, a - b, double(film.variance[i][channel]) + other.variance[i][channel],
                      std::max(std::abs(a), std::abs(b)));
        }
    judge.know_variance_of_sum({&film, &other});
    return judge.judge(name, film, &other);
}

void check_against_reference(const Scene& scene, const std::string& name) {
    CHECK_AGREEMENT(agree(render_here(scene, 1).film, render_reference(scene, 2), name));
}

Agreement agree_with_means(const Film& film, const std::vector<Rgb>& means, const std::string& name) {
    REQUIRE(film.pixel_count() == means.size());
    Judge judge(film);
    Film expected = film;
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        expected.mean[i] = means[i];
        for (int channel = 0; channel < 3; ++channel)
            judge.add(i, channel, film.mean[i][channel] - means[i][channel], film.variance[i][channel],
                      std::abs(means[i][channel]));
    }
    judge.know_variance_of_sum({&film});
    return judge.judge(name, film, &expected);
}

void check_means(const Scene& scene, double expected, const std::string& name) {
    const std::vector<Rgb> means(std::size_t(scene.picture.width * scene.picture.height), Rgb(expected));
    CHECK_AGREEMENT(agree_with_means(render_here(scene, 3).film, means, name));
}

Agreement agree_with_escapes(const Film& film, const std::vector<double>& p, const Rgb& if_escaped,
                             const Rgb& otherwise, const std::string& name) {
    REQUIRE(film.pixel_count() == p.size());
    Judge judge(film);
    Film expected = film;
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        expected.mean[i] = p[i] * if_escaped + (1.0 - p[i]) * otherwise;
        const double n = film.samples[i];
        for (int channel = 0; channel < 3; ++channel) {
            const double span = if_escaped[channel] - otherwise[channel];
            if (span == 0.0) {
                REQUIRE(film.mean[i][channel] == Approx(otherwise[channel]).epsilon(rounding));
                continue;
            }
            // An exact count but for the rounding of the film and of each sample, a product of hundreds of numbers that
            // are known to 6e-8 each, for which 1e-4 has room: else samples have other values.
            const double counted = (film.mean[i][channel] - otherwise[channel]) / span * n;
            const double escapes = std::round(counted);
            const double most = std::max(if_escaped[channel], otherwise[channel]);
            // A third of a sample, where there are so many that their roundings could hide other values.
            REQUIRE(std::abs(counted - escapes) <= std::min(10.0 * rounding * n * most / std::abs(span), 1.0 / 3.0));
            judge.add(i, channel, escapes / n - p[i], p[i] * (1.0 - p[i]) / n, 1.0,
                      2.0 * std::exp(-binomial_divergence(n, escapes / n, p[i])));
        }
    }
    return judge.judge(name, film, &expected);
}

const FilmLayer& layer_of(const Film& film, const char* name) {
    const FilmLayer* layer = film.layer(name);
    INFO(name);
    REQUIRE(layer);
    return *layer;
}

Film as_film(Film film, const std::string& name) {
    const FilmLayer& layer = layer_of(film, name.c_str());
    film.mean = layer.mean;
    film.variance = layer.variance;
    return film;
}

void check_same_mean(const Film& a, const Film& b, const std::string& name) {
    INFO(name);
    REQUIRE(a.mean.size() == b.mean.size());
    const std::optional<glm::dvec3> of_a = variance_of_sum(a), of_b = variance_of_sum(b);
    REQUIRE((of_a && of_b));
    for (int channel = 0; channel < 3; ++channel) {
        double difference = 0.0, sum = 0.0;
        const double variance = (*of_a)[channel] + (*of_b)[channel];
        for (std::size_t i = 0; i < a.mean.size(); ++i) {
            difference += double(a.mean[i][channel]) - b.mean[i][channel];
            sum += b.mean[i][channel];
        }
        CAPTURE(channel, difference, std::sqrt(variance));
        CHECK(std::abs(difference) < 4.0 * std::sqrt(variance)); // one in 16,000
        CHECK(std::sqrt(variance) < 0.1 * std::abs(sum));        // else it says nothing
    }
}

bool same_bits(const Film& a, const Film& b) {
    const auto same = [](const auto& x, const auto& y) {
        return x.size() == y.size() && (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof x[0]) == 0);
    };
    const auto same_layer = [&](const FilmLayer& x, const FilmLayer& y) {
        return x.name == y.name && same(x.mean, y.mean) && same(x.variance, y.variance);
    };
    return same(a.mean, b.mean) && same(a.variance, b.variance) && same(a.samples, b.samples) &&
           std::equal(a.layers.begin(), a.layers.end(), b.layers.begin(), b.layers.end(), same_layer);
}

double mean_of(const Film& film) {
    double sum = 0.0;
    for (const glm::vec3& pixel : film.mean)
        sum += double(pixel.x) + pixel.y + pixel.z;
    return sum / (3.0 * static_cast<double>(film.pixel_count()));
}

} // namespace vkvol
