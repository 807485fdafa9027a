// A map of the sky, made ready to be looked up and drawn from: see shaders/lights/sky.glsl.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "lights.h"
#include "radiance_map.h"
#include "shared/frame.h"

namespace vkvol {

struct SkyMap {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<glm::vec4> texels; // radiance; and the density that is drawn with, per steradian (at the horizon)
    std::vector<shared::AliasEntry> alias; // of rows, then of the columns of each row
    Rgb fluence{0.0};                      // integral of the radiance over all directions
    double unevenness = 1.0;               // mean of the radiance's square over all directions, over that of its mean
    std::size_t mended = 0;                // texels that were negative or not finite
    std::vector<std::string> warnings;     // of the file
};

// Opens the file. Throws InputError, also for a map without light.
SkyMap load_sky(const SkyLight& light);

// The map that was made last, so that it is not read and made anew for each moment of a scene that moves, or frame.
class SkyCache {
public:
    // As load_sky, or what that made of the same before, if its file has not changed since.
    std::shared_ptr<const SkyMap> take(const SkyLight& light);

private:
    SkyLight light_; // it is of, if there is one
    std::uintmax_t bytes_ = 0;
    std::filesystem::file_time_type changed_;
    std::shared_ptr<const SkyMap> map_;
};

// Makes the sky of a map that has some light, times `scale`; one of equal areas is square.
SkyMap make_sky(const RadianceMap& map, const Rgb& scale, SkyMapping mapping = SkyMapping::equirectangular);

} // namespace vkvol
