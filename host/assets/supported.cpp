#include "supported.h"

#include <algorithm>
#include <fmt/format.h>

#include "error.h"
#include "method.h"
#include "shared/constants.h"

namespace vkvol {

namespace {

void check_periodic(const Scene& scene) {
    const auto fail = [](const char* message) { throw InputError(std::string("<periodic>: ") + message); };
    if (std::any_of(scene.lights.begin(), scene.lights.end(), has_place))
        fail("a light that has a place would stand in every domain that there is; take directional lights, suns and "
             "skies, or surfaces that shine");
    for (const Surface& surface : scene.surfaces)
        if (const auto* plane = std::get_if<PlaneSurface>(&surface.shape))
            for (int axis = 0; axis < 3; ++axis)
                if (scene.periodic->size()[axis] > 0.0 && plane->normal[axis] != 0.0)
                    fail("a plane has to lie along all axes that repeat; turn it, or take a rectangle");
}

} // namespace

void check_supported(const Scene& scene) {
    if (scene.periodic)
        check_periodic(scene);
    const auto is_mesh = [](const Volume& volume) { return std::holds_alternative<MeshFiles>(volume.shape); };
    if (is_superposition(scene) && any_medium(scene, is_mesh))
        throw InputError(
            "models beside other volumes are not rendered by this version; keep them alone, or put spheres, "
            "boxes and grids in their place");
    const auto is_map = [](const Light& light) { return std::holds_alternative<SkyLight>(light); };
    if (std::count_if(scene.lights.begin(), scene.lights.end(), is_map) > 1)
        throw InputError("a scene with several maps of the sky is not rendered by this version; keep one");
    const auto is_plane = [](const Surface& surface) { return std::holds_alternative<PlaneSurface>(surface.shape); };
    if (const auto planes = std::count_if(scene.surfaces.begin(), scene.surfaces.end(), is_plane); planes > MOST_PLANES)
        throw InputError(fmt::format("{} planes are more than the {} that are rendered; make rectangles of some",
                                     planes, MOST_PLANES));
    // Every camera ray asks all lamps, and every path that leaves all suns.
    constexpr std::ptrdiff_t most_lamps = 4096, most_suns = 256;
    if (const auto lamps = std::count_if(scene.lights.begin(), scene.lights.end(), is_lamp); lamps > most_lamps)
        throw InputError(fmt::format("{} spheres, disks and rectangles of light are more than the {} that can be seen; "
                                     "make most of them points",
                                     lamps, most_lamps));
    if (const auto suns = std::count_if(scene.lights.begin(), scene.lights.end(), is_met_by_chance); suns > most_suns)
        throw InputError(fmt::format("{} suns are more than the {} that are rendered; make most of them directional",
                                     suns, most_suns));
}

} // namespace vkvol
