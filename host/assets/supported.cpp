#include "supported.h"

#include "error.h"
#include "shared/constants.h"

namespace vkvol {

void check_supported(const Scene& scene) {
    if (scene.volumes.size() > MOST_MEDIA)
        throw InputError("a scene with several volumes is not rendered by this version; keep one");
    if (scene.lights.size() > MOST_LIGHTS - 1) // and the background
        throw InputError("a scene with several lights is not rendered by this version; keep one");
}

} // namespace vkvol
