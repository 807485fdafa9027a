#pragma once

#include "film.h"
#include "path.h"

namespace reference {

// Samples [sample_offset, sample_offset + spp) of every pixel of the crop. The result does not depend on `threads`.
vkvol::Film render(const World& world, vkvol::Crop crop, std::uint32_t spp, std::uint32_t seed, unsigned threads,
                   std::uint32_t sample_offset = 0);
vkvol::Film render(const vkvol::Scene& scene, vkvol::Crop crop, std::uint32_t spp, std::uint32_t seed, unsigned threads,
                   std::uint32_t sample_offset = 0);

} // namespace reference
