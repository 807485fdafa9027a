// Rayleigh's phase function: normalised, sampled as it is evaluated, and what two of them come to.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "rayleigh.spv.h"
#include "support/images.h"
#include "support/kernel_runner.h"
#include "support/scenes.h"
#include "tests/reference/phase.h"

using namespace vkvol;
using std::numbers::pi;

TEST_CASE("Rayleigh's phase function equals the reference's, and is drawn by its inverse", "[gpu][phase]") {
    std::vector<glm::vec3> inputs;
    for (const float share : {1.0f, 0.9f, 0.1f})
        for (int i = 0; i < 4096; ++i)
            inputs.emplace_back(-1.0f + 2.0f * static_cast<float>(i) / 4095.0f, static_cast<float>(i) / 4096.0f, share);
    const auto outputs = KernelRunner(rayleigh_spv).run<glm::vec3>(inputs);
    constexpr double ulp = 0x1p-23;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const double mu = inputs[i].x, u = inputs[i].y, share = inputs[i].z;
        CAPTURE(mu, u, share);
        REQUIRE(outputs[i].x == Approx(reference::rayleigh_eval(share, mu)).epsilon(4 * ulp));
        REQUIRE(outputs[i].y == Approx(reference::rayleigh_eval_twice(share, mu)).epsilon(4 * ulp));
        // t <= 1.62 by pow, which Vulkan allows 16 ulp and what three roundings of log2(t) <= 0.7 come to; t - 1 / t
        // takes both errors over. With a share of 0.1 t and a / t are up to 4.2: three times as much.
        REQUIRE(outputs[i].z ==
                Approx(reference::rayleigh_sample_cosine(share, u)).margin((share < 0.5 ? 192 : 64) * ulp));
    }
}

TEST_CASE("Rayleigh's phase function integrates to 1, and twice is its convolution", "[cpu][phase]") {
    // Midpoints: of polynomials of degree 2 they err by h^2 / 12 times the second derivative.
    constexpr int cosines = 4000, azimuths = 16;
    const double share = GENERATE(1.0, 0.4);
    double integral = 0.0;
    for (int i = 0; i < cosines; ++i)
        integral += reference::rayleigh_eval(share, -1.0 + 2.0 * (i + 0.5) / cosines) * 2.0 * pi * 2.0 / cosines;
    CHECK(integral == Approx(1.0).epsilon(1e-6));
    for (const double mu : {-1.0, -0.3, 0.2, 0.8, 1.0}) {
        double sum = 0.0;
        for (int i = 0; i < cosines; ++i) {
            const double m = -1.0 + 2.0 * (i + 0.5) / cosines, s = std::sqrt((1.0 - m * m) * (1.0 - mu * mu));
            for (int j = 0; j < azimuths; ++j)
                sum += reference::rayleigh_eval(share, m) *
                       reference::rayleigh_eval(share, m * mu + s * std::cos(2.0 * pi * j / azimuths));
        }
        sum *= 2.0 / cosines * 2.0 * pi / azimuths;
        CHECK(sum == Approx(reference::rayleigh_eval_twice(share, mu)).epsilon(1e-6));
    }
}

TEST_CASE("a cloud that scatters by Rayleigh's phase function equals the reference's", "[gpu][phase][agreement][long]") {
    static const GridFile file = write_grid(cloud_grid());
    Scene scene = scene_of(medium(file, 2.0, 0.9, 0.0), 13.0, 16);
    scene.volumes.back().phase = PhaseFunction::rayleigh;
    scene.volumes.back().phase_details.depolarization = 0.3;
    scene.background = {0.3, 0.5, 0.9};
    scene.lights = {sunlight()};
    scene.settings.spp = 256;
    for (const char* integrator : {"deltaTracking", "ratioTracking", "cachedRatioTracking"}) {
        scene.settings.integrator = integrator;
        CHECK_AGREEMENT(
            agree(render_here(scene, 21).film, render_reference(scene, 22), std::string("rayleigh, ") + integrator));
    }
}
