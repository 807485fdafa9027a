// The scenes of scenes/hard, each with the mean that it says it has: a few samples of each, on the device and by the
// reference. tools/validate.sh hard takes more.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <regex>
#include <sstream>

#include "scene_xml.h"
#include "support/images.h"
#include "support/statistics.h"
#include "support/test_device.h"
#include "test_paths.h"

using namespace vkvol;

namespace {

std::vector<std::filesystem::path> hard_scene_files() {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(VKVOL_SOURCE_DIR "/scenes/hard"))
        if (entry.path().extension() == ".xml")
            files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

// With its density field from where the build has made it.
Scene load_hard_scene(const std::filesystem::path& file) {
    std::stringstream text;
    text << std::ifstream(file).rdbuf();
    const std::string xml = text.str();
    SceneOverrides overrides;
    std::smatch match;
    if (std::regex_search(xml, match, std::regex("<densityField[^>]*>([^<]*)<")))
        overrides.grid = std::filesystem::path(VKVOL_TEST_FIELDS) / match[1].str();
    return parse_scene(xml, file, {}, overrides);
}

// As tools/hard_cases.py judges. All comparisons together fail by chance with probability 0.1 %.
void check_mean(const std::string& name, const Film& film, const Expected& expected, double comparisons) {
    const ImageMean mean = image_mean(film);
    REQUIRE(mean.standard_error);
    for (int channel = 0; channel < 3; ++channel) {
        const double value = mean.value[channel], error = (*mean.standard_error)[channel];
        const double excess = std::abs(value - expected.mean[channel]) - expected.bias[channel] -
                              0x1p-23 * expected.mean[channel]; // pixels are kept in single precision
        INFO(name << ", channel " << channel << ": " << value << " +- " << error << ", expected "
                  << expected.mean[channel] << " +- " << expected.bias[channel]);
        CHECK(std::isfinite(value));
        if (excess > 0.0)
            CHECK((!expected.exact && normal_p(excess / error) > sidak(1e-3, comparisons)));
    }
}

} // namespace

TEST_CASE("hard scenes have the means that they derive", "[gpu][hard][hard_scenes]") {
    const auto files = hard_scene_files();
    REQUIRE(files.size() >= 58);
    for (const std::filesystem::path& file : files) {
        INFO(file.filename().string());
        Scene scene = load_hard_scene(file);
        REQUIRE(scene.expected);
        // Enough for the normal limit: each has at least 144 pixels.
        scene.settings.spp = std::min(scene.settings.spp, 64u);
        const std::string name = file.stem().string();
        const double comparisons = 6.0 * static_cast<double>(files.size());
        RenderJob job;
        job.crop = {0, scene.picture.width, 0, scene.picture.height};
        job.seed = 51;
        job.disk_cache = false;
        const RenderResult result = render(test_device(), scene, job);
        CHECK(result.counts.step_caps + result.counts.non_finite + result.counts.queue_overflows == 0);
        // Majorants are violated where that is the point.
        CHECK((result.counts.majorant_violations > 0) == (scene.settings.majorant_scale < 1.0));
        check_mean(name + " on the device", result.film, *scene.expected, comparisons);
        check_mean(name + " by the reference", render_reference(scene, 52), *scene.expected, comparisons);
    }
}

// What has one closed form has it whatever the estimators.
TEST_CASE("a constant grid scatters as its closed form whatever the integrator", "[gpu][hard][hard_scenes][long]") {
    Scene scene = load_hard_scene(VKVOL_SOURCE_DIR "/scenes/hard/32-constant-grid-scattering.xml");
    scene.settings.spp = 64;
    const std::vector<const char*> integrators = {
        "ratioTracking",   "cachedRatioTracking", "ratioNEE",         "deltaTrackingNEE",      "residualRatioTracking",
        "regularTracking", "weightedTracking",    "spectralTracking", "decompositionTracking", "unbiasedRayMarching"};
    for (const char* integrator : integrators) {
        scene.settings.integrator = integrator;
        check_mean(integrator, render_here(scene, 53).film, *scene.expected, 3.0 * double(integrators.size()));
    }
}
