// What moves while a picture is taken. Every sample has a moment at which it sees the scene as it is then; samples that
// follow each other share one, since a scene is made ready anew for each: a render of n samples per pixel has about
// 6 sqrt(n) moments, and none more than samples.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace vkvol {

struct RenderSettings;
struct Scene;

// Times are in frames, from the scene's own.
struct MotionBlur {
    double open = 0.0, close = 0.0;        // while light is taken in, open < close
    std::function<Scene(double)> scene_at; // as its file has it then. Throws InputError
};

// Samples with one moment.
struct Moment {
    std::uint64_t first = 0, end = 0; // their numbers
    std::uint64_t index = 0;          // of the moment
};

// The moment of a sample, by its number alone: parts of a render have the moments of the whole.
Moment moment_of_sample(std::uint64_t sample);

// Its time: evenly distributed over seeds, and spread evenly for one (van der Corput 1935, turned at random after
// Cranley and Patterson 1976), so that the mean of many samples is that over the time without bias.
double time_of(const MotionBlur& blur, const Moment& moment, std::uint32_t seed);

// By which two scenes that move are told apart, and what is wrong with one is found before it is rendered.
std::vector<double> telling_times(const MotionBlur& blur);

// With the samples and the integrator of `settings`, which a command line may have asked for.
RenderSettings asked_of(RenderSettings then, const RenderSettings& settings);

// As it is then: but for samples, size, layers and the integrator, which are the scene's. Throws InputError, with the
// time, for what cannot be, and where sensors would have other pixels then.
Scene scene_of_time(const Scene& scene, double time);

} // namespace vkvol
