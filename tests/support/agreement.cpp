#include "agreement.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <iostream>

#include "error.h"
#include "integrators.h"
#include "method.h"
#include "scene_facts.h"
#include "scenes.h"
#include "shared/constants.h"
#include "statistics.h"
#include "test_device.h"

namespace vkvol {

namespace {

constexpr int pixels = 7; // along an edge of the picture

Scene picture_of(const Volume& volume, double width, std::uint32_t spp) {
    Scene scene = scene_of(volume, width, pixels, 25.0, glm::dvec3(0.0), {10.0, 25.0, -5.0});
    scene.background = {0.3, 0.5, 0.9};
    scene.lights = {sunlight({3.0, 2.5, 1.5})};
    scene.settings.spp = spp;
    scene.settings.filter = Filter::trilinear;
    return scene;
}

// Voxels of density 30 amid a thin haze, far apart: majorants are loose everywhere.
GridFile spike_file() {
    GridRecipe grid{{-10, -9, -8}, {9, 8, 7}, nullptr, Storage::float32};
    grid.value = [](glm::ivec3 i) { return i.x % 6 == 0 && i.y % 5 == 0 && i.z % 7 == 0 ? 30.0f : 0.2f; };
    grid.linear = glm::dmat3(0.4);
    grid.translation = -center_of(grid);
    return write_grid(grid);
}

GridFile fire_file() {
    GridRecipe heat;
    heat.first = {-6, -5, -4};
    heat.last = {9, 8, 7};
    heat.value = [](glm::ivec3 i) { return 1.5f * cloud_noise(i + 40) + 0.1f; };
    heat.linear = glm::dmat3(0.5);
    heat.translation = -center_of(heat);
    heat.name = "temperature";
    return write_grids({cloud_grid(), heat});
}

// Two cubes, one of them turned: a body of two parts.
std::filesystem::path mesh_file() {
    const std::filesystem::path path = cloud_file().path.parent_path() / "two_cubes.obj";
    std::ofstream out(path);
    for (int cube = 0; cube < 2; ++cube)
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 c = 2.0 * glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2) - 1.0;
            const double s = std::sin(0.5 * cube), k = std::cos(0.5 * cube);
            const glm::dvec3 v = glm::dvec3(k * c.x - s * c.y, s * c.x + k * c.y, c.z) + 2.2 * (2.0 * cube - 1.0);
            out << fmt::format("v {} {} {}\n", v.x, v.y, 0.5 * v.z);
        }
    constexpr int faces[6][4] = {{1, 3, 4, 2}, {5, 6, 8, 7}, {1, 2, 6, 5}, {3, 7, 8, 4}, {1, 5, 7, 3}, {2, 4, 8, 6}};
    for (int cube = 0; cube < 2; ++cube)
        for (const auto& f : faces)
            out << fmt::format("f {} {} {} {}\n", f[0] + 8 * cube, f[1] + 8 * cube, f[2] + 8 * cube, f[3] + 8 * cube);
    return path;
}

} // namespace

std::vector<NamedScene> agreement_scenes() {
    std::vector<NamedScene> scenes;
    const auto ball = [](double g) {
        return picture_of(medium(Sphere{{0.1, -0.1, 0.0}, 1.0}, 4.0, 0.95, g), 2.6, 500);
    };
    scenes.push_back(
        {"homogeneous slab", picture_of(medium(Box{glm::dvec3(0.0), {8.0, 8.0, 1.0}}, 2.0, 0.9, 0.3), 3.0, 500)});
    scenes.push_back({"sphere, g 0.8", ball(0.8)});
    scenes.push_back({"sphere, g -0.8", ball(-0.8)});
    scenes.push_back({"thin cloud", picture_of(medium(cloud_file(), 0.4, 0.95, 0.3), 11.0, 1000)});
    scenes.push_back({"thick cloud", picture_of(medium(cloud_file(), 4.0, 0.95, 0.3), 11.0, 1000)});
    scenes.push_back({"spikes", picture_of(medium(spike_file(), 0.5, 0.9), 9.0, 1000)});
    Volume chromatic = medium(cloud_file(), 1.0, 0.9);
    chromatic.sigma_a = {0.02, 0.1, 0.3};
    chromatic.sigma_s = {0.6, 1.2, 2.4};
    scenes.push_back({"chromatic cloud", picture_of(chromatic, 11.0, 1000)});
    Volume fire = medium(fire_file(), 0.8, 0.3);
    fire.temperature.color = {2.0, 0.7, 0.15};
    scenes.push_back({"fire", picture_of(fire, 11.0, 1000)});
    Volume noise = medium(MeshFiles{{mesh_file()}}, 1.5, 0.9, 0.2);
    noise.noise = Noise{1.8, 3, 0.5, 2.0};
    scenes.push_back({"noise in a mesh", picture_of(noise, 9.0, 400)});
    Scene several = picture_of(medium(cloud_file(), 0.6, 0.95, 0.3), 9.0, 400);
    Volume noisy = medium(Sphere{{1.0, -0.5, 0.5}, 2.5}, 0.7, 0.8, -0.3);
    noisy.noise = Noise{1.1, 2, 0.5, 2.0};
    several.volumes.push_back(noisy);
    several.volumes.push_back(medium(Box{{-1.5, 1.0, 0.0}, {3.0, 2.0, 4.0}}, 0.3, 0.5));
    scenes.push_back({"several media", several});
    Volume scan = medium(cloud_file(), 1.0, 1.0, 0.3);
    scan.map.points = {{0.0, 0.02, Rgb(0.9), Rgb(0.0)},
                       {0.25, 0.3, {0.9, 0.5, 0.3}, Rgb(0.0)},
                       {0.5, 2.0, {0.8, 0.6, 0.5}, {0.5, 0.1, 0.02}},
                       {0.5, 0.6, {1.0, 0.95, 0.9}, Rgb(0.0)},
                       {0.9, 1.5, {0.4, 0.5, 0.9}, {0.0, 0.0, 0.2}}};
    scan.map.is_transfer = true;
    scenes.push_back({"transfer function", picture_of(scan, 11.0, 1000)});
    Volume air = medium(Everywhere{}, 0.6, 0.9, 0.3);
    air.layers = Layers{1, -2.0, 18.0, 1.0, 0.0};
    scenes.push_back({"atmosphere", picture_of(air, 11.0, 400)});
    return scenes;
}

std::vector<Combination> unbiased_combinations(const Scene& scene) {
    std::vector<Combination> all;
    const auto consider = [&](int flight, int transmittance, int nee, int emission) {
        Scene trial = scene;
        trial.settings.integrator = "ratioTracking";
        trial.settings.choices = {SCATTERING_MULTIPLE, flight, transmittance, nee, emission};
        try {
            const Method method = choose_method(trial);
            const bool as_chosen = method.free_flight == flight && method.nee == nee &&
                                   method.emission_at == emission && method.transmittance == transmittance;
            if (as_chosen && method.biased.empty())
                all.push_back({method.integrator.substr(std::string("ratioTracking:scattering=multiple:").size()),
                               trial.settings.choices});
        } catch (const InputError&) { // not in this medium
        }
    };
    const bool glows = emits(scene);
    for (int flight = 0; flight < FREE_FLIGHT_COUNT; ++flight)
        for (int emission = 0; emission <= (glows ? EMISSION_AT_STEPS : EMISSION_AT_COLLISIONS); ++emission) {
            for (int transmittance = 0; transmittance < TRANSMITTANCE_COUNT; ++transmittance)
                for (const int nee : {NEE_COLLISIONS, NEE_TENTATIVE, NEE_CACHED})
                    consider(flight, transmittance, nee, emission);
        }
    return all;
}

namespace {

// Variances of every estimate, pixel and channel. An estimate that by chance met none of a pixel's rare bright samples
// takes itself for exact, so no variance is taken for less than the median of all estimates' there.
std::vector<std::vector<glm::dvec3>> known_variances(const std::vector<Estimate>& estimates) {
    std::vector<std::vector<glm::dvec3>> variances;
    for (const Estimate& estimate : estimates)
        variances.emplace_back(estimate.film.variance.begin(), estimate.film.variance.end());
    if (estimates.size() < 3)
        return variances; // of two the median would be the larger
    std::vector<double> all(estimates.size());
    for (std::size_t i = 0; i < variances.front().size(); ++i)
        for (int channel = 0; channel < 3; ++channel) {
            for (std::size_t a = 0; a < all.size(); ++a)
                all[a] = variances[a][i][channel];
            std::nth_element(all.begin(), all.begin() + std::ptrdiff_t(all.size() / 2), all.end());
            for (auto& variance : variances)
                variance[i][channel] = std::max(variance[i][channel], all[all.size() / 2]);
        }
    return variances;
}

} // namespace

PairwiseAgreement compare_all(const std::vector<Estimate>& estimates) {
    constexpr double rounding = 1e-5; // of single precision along a path, relative
    const std::vector<std::vector<glm::dvec3>> variances = known_variances(estimates);
    PairwiseAgreement result;
    const auto worst = [](double z, const std::string& pair, double& most, std::string& whose) {
        if (!std::isnan(most) && !(z <= most)) { // NaN too, for good
            most = z;
            whose = pair;
        }
    };
    for (std::size_t a = 0; a < estimates.size(); ++a)
        for (std::size_t b = a + 1; b < estimates.size(); ++b) {
            const Film &one = estimates[a].film, &other = estimates[b].film;
            const std::string pair = estimates[a].name + " / " + estimates[b].name;
            const std::optional<glm::dvec3> of_one = variance_of_sum(one), of_other = variance_of_sum(other);
            for (int channel = 0; channel < 3; ++channel) {
                double difference = 0.0, variance = 0.0, scale = 0.0;
                for (std::size_t i = 0; i < one.pixel_count(); ++i) {
                    const double x = one.mean[i][channel], y = other.mean[i][channel];
                    const double v = variances[a][i][channel] + variances[b][i][channel];
                    const double size = std::max(std::abs(x), std::abs(y));
                    const double excess = std::max(std::abs(x - y) - rounding * size, 0.0);
                    worst(excess == 0.0 ? 0.0 : excess / std::sqrt(v), pair, result.pixel_z, result.pixel_pair);
                    difference += x - y;
                    variance += double(one.variance[i][channel]) + other.variance[i][channel]; // many pixels: known
                    scale += size;
                }
                if (of_one && of_other) // pixels need not be independent
                    variance = (*of_one)[channel] + (*of_other)[channel];
                const double excess = std::max(std::abs(difference) - rounding * scale, 0.0);
                worst(excess == 0.0 ? 0.0 : excess / std::sqrt(variance), pair, result.mean_z, result.mean_pair);
                result.tests += one.pixel_count() + 1;
            }
            ++result.pairs;
        }
    return result;
}

void check_rows(const std::string& about, const std::string& heading, const std::vector<AgreementRow>& rows,
                double alpha) {
    double means = 0.0, pixels = 0.0;
    for (const AgreementRow& row : rows) {
        means += 3.0 * double(row.means.pairs);
        pixels += double(row.pixels.tests) - 3.0 * double(row.pixels.pairs);
    }
    const double mean_limit = z_limit(alpha / 2.0, means), pixel_limit = z_limit(alpha / 2.0, pixels);
    std::cout << fmt::format("{}, {}\n{}\nMeans of pictures and pixels, three channels; {:.0f} and {:.0f} tests, "
                             "significance {} over all (Sidak).\n\n{} {:>5} {:>18} {:>19}  verdict\n",
                             test_device().info().name, test_device().info().driver, about, means, pixels, alpha,
                             heading, "pairs", "largest mean z", "largest pixel z");
    for (const AgreementRow& row : rows) {
        const bool ok = row.means.mean_z <= mean_limit && row.pixels.pixel_z <= pixel_limit; // NaN is not
        std::cout << fmt::format("{} {:>5} {:>8.2f} (of {:.2f}) {:>9.2f} (of {:.2f})  {}\n", row.what, row.means.pairs,
                                 row.means.mean_z, mean_limit, row.pixels.pixel_z, pixel_limit,
                                 ok ? "agree" : "DIFFER");
        if (!ok)
            std::cout << "    mean: " << row.means.mean_pair << "\n    pixel: " << row.pixels.pixel_pair << "\n";
        CHECK(ok);
    }
    std::cout << std::flush;
}

double z_limit(double alpha, double tests) {
    double low = 0.0, high = 40.0;
    const double share = sidak(alpha, tests);
    for (int i = 0; i < 100; ++i) {
        const double middle = 0.5 * (low + high);
        (normal_p(middle) > share ? low : high) = middle;
    }
    return high;
}

} // namespace vkvol
