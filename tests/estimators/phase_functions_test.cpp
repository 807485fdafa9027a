// Phase functions of every kind: evaluated as the reference does, normalised, drawn as evaluated; and clouds of them.
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <numeric>

#include "fournier_forand.h"
#include "kernel_constants.h"
#include "kernels/test_items.h"
#include "phase_params.h"
#include "phase_table.h"
#include "scatter.spv.h"
#include "support/agreement.h"
#include "support/images.h"
#include "support/kernel_runner.h"
#include "support/numbers.h"
#include "support/scenes.h"
#include "support/statistics.h"
#include "support/thorough.h"
#include "test_paths.h"
#include "tests/reference/medium.h"
#include "tests/reference/rng.h"

using namespace vkvol;
using std::numbers::pi;
using test_numbers::ulp;

namespace {

double random(std::uint32_t i, std::uint32_t which) {
    return reference::pcg4d({i, which, 7, 9})[0] * 0x1p-32;
}

glm::vec3 random_direction(std::uint32_t i) {
    const double z = 2.0 * random(i, 1) - 1.0, phi = 2.0 * pi * random(i, 2), s = std::sqrt(1.0 - z * z);
    return glm::normalize(glm::vec3(s * std::cos(phi), s * std::sin(phi), z));
}

std::vector<shared::ScatterOutput> scatter(const NamedPhase& phase, const std::vector<shared::ScatterInput>& inputs) {
    const Volume volume = phase.of(Volume{});
    LoadedMedium loaded;
    loaded.phase_nodes = phase_table(volume).nodes;
    KernelScene kernel;
    kernel.frame.media[0].phase = phase_params(volume, loaded.phase_nodes);
    kernel.volume = &loaded;
    Specialization constants{};
    constants[SPEC_PHASE] = kinds_of(volume, loaded, {}).phase;
    return KernelRunner(scatter_spv, constants, kernel).run<shared::ScatterOutput>(inputs);
}

// How far one may be from its closed form, as host/assets/fournier_forand.h has it.
double between_nodes(const NamedPhase& phase) {
    return phase.kind == PhaseFunction::fournier_forand ? 2e-4 : 0.0;
}

// 1 - mu, with all digits.
double from_forward(const glm::vec3& before, const glm::vec3& after) {
    const glm::dvec3 apart =
        glm::dvec3(before) / glm::length(glm::dvec3(before)) - glm::dvec3(after) / glm::length(glm::dvec3(after));
    return 0.5 * glm::dot(apart, apart);
}

// A medium with the phase function's numbers as kernels have them.
reference::Medium medium_of(const NamedPhase& phase) {
    reference::Medium result = reference::load(phase.of(medium(Sphere{}, 1.0, 1.0)));
    for (double* number : {&result.g, &result.g2, &result.share, &result.alpha})
        *number = static_cast<float>(*number);
    return result;
}

// By midpoints in y of x = 2 y^4, which resolves forward peaks: calls f(mu, weight).
template <class F> void over_cosines(int count, const F& f) {
    for (int i = 0; i < count; ++i) {
        const double y = (i + 0.5) / count;
        f(1.0 - 2.0 * std::pow(y, 4), 8.0 * std::pow(y, 3) / count);
    }
}

} // namespace

TEST_CASE("phase functions of every kind equal the reference's", "[gpu][phase]") {
    for (const NamedPhase& phase : all_phases()) {
        const reference::Medium medium = medium_of(phase);
        std::vector<shared::ScatterInput> inputs;
        for (std::uint32_t i = 0; i < 4000; ++i) // dense towards both ends
            inputs.push_back({random_direction(i),
                              {0.5f, float(random(i, 3))},
                              float(i < 2000 ? 2.0 * std::pow(10.0, -8.0 * i / 2000.0)
                                             : 2.0 - 2.0 * std::pow(10.0, -6.0 * (i - 2000) / 2000.0))});
        const auto outputs = scatter(phase, inputs);
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            const double x = from_forward(inputs[i].before, outputs[i].at);
            if (x < 1e-9 && phase.kind == PhaseFunction::fournier_forand)
                continue; // spread out
            const double exact = reference::phase_eval(medium, 1.0 - x);
            // Two unit vectors are of length 1 to 1.5 ulp, and what is between them known to 2 ulp of it: x to
            // 2 ulp sqrt(2 x) + 4 ulp x. What the value's slope makes of that, and 24 roundings.
            const double known = 2.0 * ulp * std::sqrt(2.0 * x) + 4.0 * ulp * x, step = std::max(known, 1e-12);
            const double low = reference::phase_eval(medium, 1.0 - std::min(x + step, 2.0)),
                         high = reference::phase_eval(medium, 1.0 - std::max(x - step, 0.0));
            CAPTURE(phase.name, x, exact, outputs[i].at_eval);
            REQUIRE(std::abs(outputs[i].at_eval - exact) <=
                    (24 * ulp + between_nodes(phase)) * exact +
                        2.0 * std::max(std::abs(low - exact), std::abs(high - exact)));
            if (reference::has_phase_twice(medium)) {
                const double twice = reference::phase_eval_twice(medium, 1.0 - x);
                REQUIRE(outputs[i].at_eval_twice == Approx(twice).epsilon(24 * ulp + 8.0 * known / std::max(x, 1e-3)));
            }
        }
    }
}

TEST_CASE("phase functions of every kind integrate to 1, and have the mean cosine that is stated", "[cpu][phase]") {
    for (const NamedPhase& phase : all_phases()) {
        const reference::Medium medium = medium_of(phase);
        double all = 0.0, mean = 0.0;
        // Midpoints err by h^2 / 24 times the integrand's slope from end to end: 1e-9 of the peaks here, which are some
        // 1e5 high; a table's kinks add as much.
        over_cosines(200000, [&](double mu, double weight) {
            const double p = 2.0 * pi * reference::phase_eval(medium, mu) * weight;
            all += p;
            mean += p * mu;
        });
        const Volume volume = phase.of(Volume{});
        CAPTURE(phase.name, all, mean);
        CHECK(all == Approx(1.0).margin(1e-5));
        CHECK(mean_cosine(volume, phase_table(volume).nodes) == Approx(mean).margin(1e-5 + between_nodes(phase)));
    }
}

TEST_CASE("the host's values of phase functions are the reference's", "[cpu][phase]") {
    for (const NamedPhase& phase : all_phases()) {
        const reference::Medium medium = medium_of(phase);
        const Volume volume = phase.of(Volume{});
        const std::vector<shared::PhaseNode> nodes = phase_table(volume).nodes;
        over_cosines(1000, [&](double mu, double) {
            if (mu > 1.0 - 1e-9 && phase.kind == PhaseFunction::fournier_forand)
                return; // spread out
            CAPTURE(phase.name, mu);
            const double exact = reference::phase_eval(medium, mu), value = phase_value(volume, nodes, mu);
            // Four roundings of 1 + g^2 - 2 g mu, 3e-5 at least, to the power of 3/2.
            const double known = nodes.empty() ? 1e-10 : 24 * ulp + between_nodes(phase);   // as a kernel's, of a table
            CHECK(value == Approx(exact).epsilon(known).margin(nodes.empty() ? 0.0 : ulp)); // where it begins from 0
        });
    }
}

TEST_CASE("directions are drawn from phase functions of every kind as these are evaluated", "[gpu][phase]") {
    constexpr std::uint32_t count = 1 << 18;
    constexpr int bins = 64;
    std::vector<NamedPhase> phases = all_phases();
    phases.push_back({"fournierForand, sharp", PhaseFunction::fournier_forand}); // too much so to be compared in clouds
    for (const NamedPhase& phase : phases) {
        const reference::Medium medium = medium_of(phase);
        std::vector<shared::ScatterInput> inputs;
        for (std::uint32_t i = 0; i < count; ++i)
            inputs.push_back(
                {random_direction(i), {float(random(i, 3) * 0.999999), float(random(i, 4) * 0.999999)}, 1.0f});
        // Bins even in y, where x = 2 y^4; in each as many midpoints as the integral needs.
        std::vector<double> observed(bins, 0.0), expected(bins, 0.0);
        const auto bin = [](double x) { return std::min(int(std::pow(0.5 * x, 0.25) * bins), bins - 1); };
        over_cosines(bins * 2000, [&](double mu, double weight) {
            expected[std::size_t(bin(1.0 - mu))] += count * 2.0 * pi * reference::phase_eval(medium, mu) * weight;
        });
        // Midpoints do not do where a peak has no bound: the first bin has the rest.
        expected.front() = count - std::accumulate(expected.begin() + 1, expected.end(), 0.0);
        for (const auto& [i, o] : [&] {
                 std::vector<std::pair<std::size_t, shared::ScatterOutput>> all;
                 for (const shared::ScatterOutput& output : scatter(phase, inputs))
                     all.emplace_back(all.size(), output);
                 return all;
             }()) {
            const double x = from_forward(inputs[i].before, o.drawn);
            observed[std::size_t(bin(x))] += 1.0;
            REQUIRE(glm::length(o.drawn) == Approx(1.0).epsilon(4 * ulp));
            REQUIRE(o.drawn_eval > 0.0f);
        }
        CAPTURE(phase.name);
        CHECK(chi_square_test_p(observed, expected) > sidak(1e-3, double(phases.size())));
    }
}

// The inverse of the distribution function, to what single precision knows of u.
TEST_CASE("Draine's phase function is drawn by its inverse", "[gpu][phase][hard]") {
    for (const double g : {0.0, 0.05, -0.3, 0.6, 0.9, -0.99, 0.9999})
        for (const double alpha : {0.0, 1.0, 20.0, 250.0}) {
            const NamedPhase phase{"draine", PhaseFunction::draine, g, PhaseDetails{.alpha = alpha}};
            std::vector<shared::ScatterInput> inputs;
            for (int i = 0; i < 2000; ++i)
                inputs.push_back({{0.0f, 0.0f, 1.0f}, {float(i / 2000.0), 0.3f}, 1.0f});
            const auto outputs = scatter(phase, inputs);
            for (std::size_t i = 0; i < inputs.size(); ++i) {
                const double x = from_forward(inputs[i].before, outputs[i].drawn), u = inputs[i].u.x;
                const double wanted = reference::draine_sample_cosine(float(g), alpha, g < 0.0 ? u : 1.0 - u);
                // Some twenty roundings of terms below 3 norms, at the density there; and of the direction.
                const double density = 2.0 * pi * reference::draine_eval(float(g), alpha, wanted);
                CAPTURE(g, alpha, u, 1.0 - x, wanted);
                REQUIRE(std::abs(1.0 - x - wanted) * density <=
                        30 * ulp + density * (2.0 * ulp * std::sqrt(2.0 * x) + 4.0 * ulp * x));
            }
        }
}

// The fit leaves out bows and glories, and rounds the peak. Between these it is Mie's theory within a tenth: here as
// tools/mie.py computes it.
TEST_CASE("droplets scatter as Mie's theory says", "[cpu][phase]") {
    const PhaseTable theory = load_phase_table(VKVOL_SOURCE_DIR "/scenes/gallery/fogbow.txt");
    const NamedPhase water{"droplets", PhaseFunction::droplets, 0.0, PhaseDetails{.diameter = 20.0}};
    const reference::Medium fit = medium_of(water);
    int seen = 0;
    for (const shared::PhaseNode& node : theory.nodes) {
        const double degrees = std::acos(1.0 - node.x) / pi * 180.0;
        if (degrees < 6.0 || degrees > 60.0)
            continue;
        CAPTURE(degrees);
        CHECK(reference::phase_eval(fit, 1.0 - node.x) == Approx(node.value).epsilon(0.1));
        ++seen;
    }
    CHECK(seen > 100);
    const double mean = mean_cosine(water.of(Volume{}), {});
    Volume table;
    table.phase = PhaseFunction::table;
    CHECK(mean_cosine(table, theory.nodes) == Approx(mean).epsilon(0.02)); // what is left out lies backward
}

// Moments g^l, as many as are above 1e-6: Henyey and Greenstein's, with a peak narrower than the angles that suffice
// for others.
TEST_CASE("many moments keep a narrow peak", "[cpu][phase]") {
    const double g = 0.999;
    std::string moments;
    for (int l = 0; std::pow(g, l) > 1e-6; ++l)
        moments += fmt::format("{:.17g}\n", std::pow(g, l));
    const PhaseTable table = load_phase_table(write_text(moments));
    Volume volume;
    volume.phase = PhaseFunction::table;
    CHECK(1.0 - mean_cosine(volume, table.nodes) == Approx(1.0 - g).epsilon(2e-3));
    const double straight_on = (1.0 + g) / (4.0 * pi * (1.0 - g) * (1.0 - g));
    CHECK(table.nodes.front().value == Approx(straight_on).epsilon(2e-3));
}

// Of particles in water, from those that hardly scatter backward to those that do so by half.
TEST_CASE("nodes of Fournier and Forand's phase function are its closed form, and scatter backward what is stated",
          "[cpu][phase]") {
    for (const double index : {1.001, 1.05, 1.1, 1.33, 1.6})
        for (const double backscatter : {0.0001, 0.0183, 0.2, 0.49}) {
            CAPTURE(index, backscatter);
            const std::vector<shared::PhaseNode> nodes = fournier_forand_nodes(index, backscatter);
            double most = 0.0, most_share = 0.0, backward = 0.0;
            for (std::size_t i = 1; i < nodes.size(); ++i) {
                const shared::PhaseNode &a = nodes[i - 1], &b = nodes[i];
                for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
                    const double x = std::lerp(double(a.x), double(b.x), t);
                    const double exact = reference::fournier_forand_eval(index, backscatter, 1.0 - x);
                    if (i > 1)
                        most = std::max(most, std::abs(std::lerp(double(a.value), double(b.value), t) / exact - 1.0));
                }
                const double share = reference::fournier_forand_share(index, backscatter, 1.0 - b.x);
                most_share = std::max(most_share, std::abs(share - b.share));
                if (b.x > 1.0f) {
                    const double from = std::max(1.0, double(a.x));
                    const double at = std::lerp(double(a.value), double(b.value), (from - a.x) / (double(b.x) - a.x));
                    backward += pi * (at + b.value) * (b.x - from);
                }
            }
            CHECK(most < 2e-4);
            CHECK(most_share < 2e-4);
            CHECK(backward == Approx(backscatter).epsilon(2e-4));
        }
}

// Indices, powers of the sizes and parts that go backward as Mobley states them together (Ocean Optics Web Book, "The
// Fournier-Forand Phase Function", table 1; the last: as fitted to Petzold's measurements). Of the parts the last digit
// may be off by half.
TEST_CASE("particles in water have the sizes that are published for what they scatter backward", "[cpu][phase]") {
    struct Row {
        double index, power, backscatter, half;
    };
    for (const Row& row : {Row{1.021, 3.0742, 0.0001, 0.00005},
                           {1.04, 3.201, 0.001, 0.0005},
                           {1.08, 3.483, 0.01, 0.005},
                           {1.175, 4.065, 0.1, 0.05},
                           {1.15, 4.874, 0.4, 0.05},
                           {1.1, 3.5835, 0.0183, 0.00005}}) {
        CAPTURE(row.index, row.power, row.backscatter);
        const auto power = [&](double part) {
            return 3.0 - 2.0 * reference::fournier_forand_exponent(row.index, part);
        };
        CHECK(row.power > power(row.backscatter - row.half));
        CHECK(row.power < power(row.backscatter + row.half));
    }
}

TEST_CASE("two of two phase functions are their convolution", "[cpu][phase]") {
    NamedPhase phase = all_phases()[2];
    REQUIRE(phase.kind == PhaseFunction::double_henyey_greenstein);
    phase.g = 0.6;
    const reference::Medium medium = medium_of(phase);
    constexpr int cosines = 8000, azimuths = 128;
    for (const double mu : {-1.0, -0.3, 0.2, 0.9, 1.0}) {
        double sum = 0.0;
        for (int i = 0; i < cosines; ++i) {
            const double m = -1.0 + 2.0 * (i + 0.5) / cosines, s = std::sqrt((1.0 - m * m) * (1.0 - mu * mu));
            for (int j = 0; j < azimuths; ++j)
                sum += reference::phase_eval(medium, m) *
                       reference::phase_eval(medium, m * mu + s * std::cos(2.0 * pi * j / azimuths));
        }
        sum *= 2.0 / cosines * 2.0 * pi / azimuths;
        CHECK(sum == Approx(reference::phase_eval_twice(medium, mu)).epsilon(1e-5)); // see phase_test.cpp
    }
}

TEST_CASE("clouds of every phase function equal the reference's", "[gpu][phase][agreement]") {
    static const GridFile file = write_grid(cloud_grid());
    for (const NamedPhase& phase : all_phases()) {
        if (phase.kind == PhaseFunction::henyey_greenstein || phase.kind == PhaseFunction::rayleigh)
            continue; // elsewhere
        Scene scene = scene_of(phase.of(medium(file, 2.0, 0.9)), 13.0, 12);
        scene.background = {0.3, 0.5, 0.9};
        scene.lights = {sunlight()};
        scene.settings.spp = 256;
        const bool is_first = phase.name == "droplets 20" ||
                              (thorough() && (phase.name == "doubleHenyeyGreenstein" || phase.name == "table"));
        for (const char* integrator : {"deltaTracking", "ratioTracking", "cachedRatioTracking"}) {
            if (!is_first && integrator != std::string("cachedRatioTracking"))
                continue;
            scene.settings.integrator = integrator;
            CHECK_AGREEMENT(agree(render_here(scene, 21).film, render_reference(scene, 22),
                                  fmt::format("{}, {}", phase.name, integrator)));
        }
    }
}
