// Procedural density against the reference, and its bound.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "error.h"
#include "kernels/test_items.h"
#include "noise.h"
#include "noise.spv.h"
#include "support/kernel_runner.h"
#include "support/numbers.h"
#include "support/statistics.h"
#include "tests/reference/reference_noise.h"

using namespace vkvol;
using shared::NoiseInput;
using shared::NoiseOutput;
using test_numbers::u;

namespace {

using Table = std::array<int, 256>;

Table unpack(const shared::NoiseParams& params) {
    Table table;
    for (int i = 0; i < 256; ++i)
        table[i] = static_cast<int>(params.permutation[i / 16][i / 4 % 4] >> 8 * (i % 4) & 255u);
    return table;
}

double fade(double t) {
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

double fbm(const Noise& noise, glm::dvec3 world) {
    double sum = 0.0, frequency = noise.frequency, amplitude = 1.0;
    for (int k = 0; k < noise.octaves; ++k, frequency *= noise.lacunarity, amplitude *= noise.gain)
        sum += amplitude * reference::perlin(frequency * world);
    return sum;
}

std::vector<NoiseOutput> run_noise(const Noise& noise, glm::dvec3 origin, const std::vector<NoiseInput>& inputs) {
    KernelScene scene;
    scene.frame.media[0].noise = make_noise(noise, origin);
    return KernelRunner(noise_spv, {}, scene).run<NoiseOutput>(inputs);
}

// Along an axis noise changes by at most 1 + 15/8 * 4 per unit: the gradients' components, and the fade curve's slope
// times the difference of averages of products that are at most 2. Times three axes, times what the map to noise space
// loses: its scale, its offset (at most 128) and its sum are rounded. Then the sum of products, all below 2.
double tolerance(const Noise& noise, glm::dvec3 render) {
    double sum = 0.0, frequency = noise.frequency, amplitude = 1.0;
    const double size = std::max({std::abs(render.x), std::abs(render.y), std::abs(render.z)});
    for (int k = 0; k < noise.octaves; ++k, frequency *= noise.lacunarity, amplitude *= noise.gain)
        sum += amplitude * (8.5 * 3.0 * u * (4.0 * frequency * size + 2.0 * 128.0) + (40.0 + 2.0 * k) * u);
    return sum;
}

// The largest value that noise can take at a point of the unit cell; see host/fields/noise.cpp.
double bound_of(glm::dvec3 p) {
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        double weight = 1.0, all = 0.0, least = 1.0;
        for (int axis = 0; axis < 3; ++axis) {
            const double d = corner >> axis & 1 ? 1.0 - p[axis] : p[axis];
            weight *= fade(1.0 - d);
            all += d;
            least = std::min(least, d);
        }
        sum += weight * (all - least);
    }
    return sum;
}

} // namespace

TEST_CASE("the permutation is Perlin's", "[noise]") {
    const Table table = unpack(make_noise({}, glm::dvec3(0.0)));
    std::array<bool, 256> seen{};
    for (const int value : table)
        seen[value] = true;
    for (const bool value : seen)
        CHECK(value);
    CHECK(table[0] == 151);
    CHECK(table[255] == 180);
    CHECK(reference::perlin({3.14, 42.0, 7.0}) == Approx(0.13691995878400012).epsilon(1e-12)); // his program's
}

TEST_CASE("noise agrees with double precision, near and far from the world's origin", "[gpu][noise]") {
    Noise noise;
    noise.octaves = GENERATE(1, 4, 9);
    noise.lacunarity = GENERATE(2.0, 2.137);
    noise.frequency = GENERATE(1.8, 37.3);
    const glm::dvec3 origin = GENERATE(glm::dvec3(0.0), glm::dvec3(-3.25, 1e3, 7.7), glm::dvec3(1e6 + 0.3, -2e5, 7e7));
    const double size = GENERATE(1.0, 50.0);
    CAPTURE(noise.octaves, noise.lacunarity, noise.frequency, origin.x, size);
    std::mt19937 engine(1);
    std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
    std::vector<NoiseInput> inputs;
    for (int i = 0; i < 2000; ++i)
        inputs.push_back({static_cast<float>(size) * glm::vec3(uniform(engine), uniform(engine), uniform(engine))});
    const auto outputs = run_noise(noise, origin, inputs);
    Noise first = noise;
    first.octaves = 1;
    double worst = 0.0;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const glm::dvec3 render(inputs[i].position);
        const double expected = std::max(0.0, (1.0 + fbm(noise, origin + render)) / 2.0);
        // The product of frequency and world position has roundings of its own in double precision.
        const double far = 8.5 * 3.0 * 0x1p-52 * std::pow(noise.lacunarity * noise.gain, noise.octaves - 1) *
                           noise.octaves * noise.frequency * (glm::length(origin) + size);
        const double eps = 0.5 * tolerance(noise, render) + far;
        worsen(worst, std::abs(outputs[i].density - expected) / eps);
        CHECK(std::abs(outputs[i].octave - fbm(first, origin + render)) <= tolerance(first, render) + 2.0 * far);
    }
    CHECK(worst <= 1.0);
}

TEST_CASE("lattice points of noise, and positions beyond all integers, are harmless", "[gpu][noise][hard]") {
    Noise noise;
    noise.frequency = 1.0;
    std::vector<NoiseInput> inputs;
    for (const float x : {-257.0f, -256.0f, -1.0f, -0.0f, 0.0f, 255.0f, 256.0f, 1e9f, -3e15f})
        for (const float y : {-1.0f, 0.0f, 255.0f})
            inputs.push_back({{x, y, 3.0f}});
    for (const NoiseOutput& o : run_noise(noise, glm::dvec3(0.0), inputs)) {
        CHECK(o.octave == 0.0f);
        CHECK(o.density == 0.5f);
    }
    noise.octaves = 16;
    noise.lacunarity = 100.0;
    CHECK_THROWS_AS(make_noise(noise, glm::dvec3(0.0)), InputError);
}

TEST_CASE("no noise exceeds the bound, which is tight", "[noise]") {
    // Branch and bound as derived in host/fields/noise.cpp, over x <= y <= z <= 1/2.
    struct Cell {
        glm::dvec3 centre;
        double half;
    };
    std::vector<Cell> cells{{glm::dvec3(0.25), 0.25}};
    double found = 0.0;
    glm::dvec3 peak(0.0);
    while (!cells.empty()) {
        const Cell cell = cells.back();
        cells.pop_back();
        const double value = bound_of(cell.centre);
        if (value > found) {
            found = value;
            peak = cell.centre;
        }
        double slopes = 0.0;
        for (int axis = 0; axis < 3; ++axis) {
            const double high = cell.centre[axis] + cell.half, low = cell.centre[axis] - cell.half;
            slopes += 1.0 + 30.0 * std::pow(high * (1.0 - high), 2.0) * (1.0 - 2.0 * low); // each factor at its largest
        }
        if (value + cell.half * slopes <= perlin_bound)
            continue;
        REQUIRE(cell.half > 1e-7);
        for (int corner = 0; corner < 8; ++corner) {
            const double half = cell.half / 2.0;
            const glm::dvec3 c =
                cell.centre + half * (2.0 * glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2) - 1.0);
            const bool wanted = c.x - half <= c.y + half && c.y - half <= c.z + half;
            if (wanted)
                cells.push_back({c, half});
        }
    }
    CHECK(found <= perlin_bound);
    CHECK(found > perlin_bound - 1e-4);
    CAPTURE(peak.x, peak.y, peak.z);

    // The lattice that there is: near the peak's 48 images within many cells.
    std::mt19937 engine(1);
    std::uniform_int_distribution<int> lattice(0, 255), image(0, 47);
    double most = 0.0;
    for (int i = 0; i < 2'000'000; ++i) {
        const int n = image(engine);
        glm::dvec3 p = peak;
        for (int turn = 0; turn < n % 3; ++turn)
            p = {p.y, p.z, p.x};
        if (n / 3 % 2 != 0)
            std::swap(p.x, p.y);
        for (int axis = 0; axis < 3; ++axis)
            if (n / 6 >> axis & 1)
                p[axis] = 1.0 - p[axis];
        p += glm::dvec3(lattice(engine), lattice(engine), lattice(engine));
        most = std::max(most, std::abs(reference::perlin(p)));
    }
    CHECK(most <= perlin_bound);
    CHECK(most > 0.9 * perlin_bound);
}

TEST_CASE("the bound of a sum of octaves", "[gpu][noise]") {
    Noise noise;
    CHECK(noise_bound(noise) == Approx((1.0 + perlin_bound) / 2.0));
    noise.octaves = 3;
    CHECK(noise_bound(noise) == Approx((1.0 + 1.75 * perlin_bound) / 2.0));
    noise.gain = 1.0;
    CHECK(noise_bound(noise) == Approx((1.0 + 3.0 * perlin_bound) / 2.0));
    std::mt19937 engine(1);
    std::uniform_real_distribution<float> uniform(-100.0f, 100.0f);
    std::vector<NoiseInput> inputs;
    for (int i = 0; i < 200'000; ++i)
        inputs.push_back({{uniform(engine), uniform(engine), uniform(engine)}});
    float low = 1.0f, high = 0.0f;
    for (const NoiseOutput& o : run_noise(noise, glm::dvec3(0.0), inputs)) {
        low = std::min(low, o.density);
        high = std::max(high, o.density);
    }
    CHECK(high <= noise_bound(noise));
    CHECK(high > 0.6 * noise_bound(noise));
    CHECK(low == 0.0f); // three octaves of full strength reach below -1
}
