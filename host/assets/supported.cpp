#include "supported.h"

#include <algorithm>

#include "error.h"
#include "shared/constants.h"

namespace vkvol {

void check_supported(const Scene& scene) {
    if (scene.volumes.size() > MOST_MEDIA)
        throw InputError("a scene with several volumes is not rendered by this version; keep one");
    const auto is_map = [](const Light& light) { return std::holds_alternative<SkyLight>(light); };
    if (std::count_if(scene.lights.begin(), scene.lights.end(), is_map) > 1)
        throw InputError("a scene with several maps of the sky is not rendered by this version; keep one");
}

} // namespace vkvol
