#include "motion_blur.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/format.h>

#include "error.h"
#include "scene.h"

namespace vkvol {

namespace {

constexpr std::uint64_t alone = 16; // samples, the first, that have a moment each

// Bits mirrored about the binary point: 1, 2, 3 become 1/2, 1/4, 3/4.
double van_der_corput(std::uint64_t index) {
    double value = 0.0;
    for (double bit = 0.5; index > 0; index >>= 1u, bit *= 0.5)
        if (index & 1u)
            value += bit;
    return value;
}

// In [0, 1), of all seeds evenly: the finalizer of SplitMix64 (Steele, Lea and Flood 2014).
double turn_of(std::uint32_t seed) {
    std::uint64_t z = (seed + 1ull) * 0x9e3779b97f4a7c15ull;
    z = (z ^ z >> 30u) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ z >> 27u) * 0x94d049bb133111ebull;
    return double((z ^ z >> 31u) >> 11u) * 0x1p-53;
}

} // namespace

// From 16 samples on two share a moment, from 64 on four, and so forth.
Moment moment_of_sample(std::uint64_t sample) {
    if (sample < alone)
        return {sample, sample + 1, sample};
    std::uint64_t begin = alone, moments = alone, together = 2;
    while (sample >= 4 * begin) {
        moments += 3 * begin / together;
        begin *= 4;
        together *= 2;
    }
    const std::uint64_t which = (sample - begin) / together;
    return {begin + which * together, begin + (which + 1) * together, moments + which};
}

double time_of(const MotionBlur& blur, const Moment& moment, std::uint32_t seed) {
    const double part = van_der_corput(moment.index) + turn_of(seed);
    return blur.open + (blur.close - blur.open) * (part - std::floor(part));
}

namespace {

// By where in its frame the picture is, in units of its own size, which a command line may have changed since.
Picture with_window_of(const Picture& then, const Picture& picture) {
    const auto window = [](const Picture& p) {
        return glm::dvec4(p.start_x / p.width, p.start_y / p.height, p.reference_width / p.width,
                          p.reference_height / p.height);
    };
    const glm::dvec4 moved = window(then);
    if (glm::all(glm::lessThan(glm::abs(moved - window(picture)), glm::dvec4(1e-9)))) // rounding
        return picture;
    Picture placed = picture;
    placed.start_x = moved.x * picture.width;
    placed.start_y = moved.y * picture.height;
    placed.reference_width = moved.z * picture.width;
    placed.reference_height = moved.w * picture.height;
    return placed;
}

} // namespace

// Its ends, its middle, and two that no simple motion goes through like these.
std::vector<double> telling_times(const MotionBlur& blur) {
    std::vector<double> times;
    for (const double part : {0.0, 0.2360679775, 0.5, 0.7360679775, 1.0})
        times.push_back(blur.open + (blur.close - blur.open) * part);
    return times;
}

RenderSettings asked_of(RenderSettings then, const RenderSettings& settings) {
    then.spp = settings.spp;
    then.integrator = settings.integrator;
    then.choices = settings.choices;
    return then;
}

Scene scene_of_time(const Scene& scene, double time) {
    const auto fail = [&](const std::string& message) {
        throw InputError(
            fmt::format("{} ({:+.6g} frames from the picture's, which its <motionBlur> includes)", message, time));
    };
    Scene then;
    try {
        then = scene.motion_blur->scene_at(time);
    } catch (const InputError& error) {
        fail(error.what());
    }
    if (then.camera.points.size() != scene.camera.points.size() || then.camera.cells != scene.camera.cells)
        fail("the sensor has other pixels; let it keep them");
    if (then.camera.projection != scene.camera.projection)
        fail("the camera has another projection; let it keep its own");
    then.picture = with_window_of(then.picture, scene.picture);
    then.settings = asked_of(then.settings, scene.settings);
    then.layers = scene.layers;
    then.holds_out = scene.holds_out;
    then.has_camera = scene.has_camera;
    if (!scene.has_camera) // which it has got since
        then.camera = scene.camera;
    then.expected = scene.expected;
    then.motion_blur = scene.motion_blur;
    then.warnings = scene.warnings; // those of that time are the same, or come too late
    return then;
}

} // namespace vkvol
