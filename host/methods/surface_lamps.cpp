#include "surface_lamps.h"

#include <algorithm>
#include <optional>

namespace vkvol {

namespace {

constexpr std::ptrdiff_t most_lamps = 256; // every camera ray asks all of them

// The lamp that a surface's front is, or with -1 its back, if it can be one.
struct LampOf {
    const Surface& surface;
    int body;
    double side;

    std::optional<Light> operator()(const BallSurface& ball) const {
        if (surface.shines_both_ways) // inwards too, which no lamp does
            return {};
        return SphereLight{ball.center, ball.radius, surface.emission, "", body};
    }
    std::optional<Light> operator()(const DiskSurface& disk) const {
        return DiskLight{disk.center, side * disk.normal, disk.radius, surface.emission, "", body};
    }
    std::optional<Light> operator()(const RectangleSurface& r) const {
        return RectangleLight{r.center, side * r.edge_u, r.edge_v, surface.emission, "", body};
    }
    template <class Shape> std::optional<Light> operator()(const Shape&) const { return {}; }
};

std::vector<Light> lamps_of(const Surface& surface, std::size_t index) {
    std::vector<Light> lamps;
    for (const double side : {1.0, -1.0})
        if (surface.emission != Rgb(0.0) && (side > 0.0 || surface.shines_both_ways))
            if (const auto lamp = std::visit(LampOf{surface, static_cast<int>(index), side}, surface.shape))
                lamps.push_back(*lamp);
    return lamps;
}

// A plane has no end, and no point that is drawn evenly.
bool can_be_light(const Surface& surface) {
    return surface.emission != Rgb(0.0) && !std::holds_alternative<PlaneSurface>(surface.shape);
}

bool is_of_surface(const Light& light) {
    return body_of(light) != no_body;
}

} // namespace

bool has_lamps_of_surfaces(const Scene& scene) {
    // Where a domain repeats each has them, and looks would find those of one.
    return !scene.periodic && std::any_of(scene.surfaces.begin(), scene.surfaces.end(), can_be_light);
}

Scene with_lamps_of_surfaces(Scene scene) {
    if (!has_lamps_of_surfaces(scene) || std::any_of(scene.lights.begin(), scene.lights.end(), is_of_surface))
        return scene;
    const auto can_be_lamp = [](const Surface& surface) { return !lamps_of(surface, 0).empty(); };
    const bool few = std::count_if(scene.surfaces.begin(), scene.surfaces.end(), can_be_lamp) <= most_lamps;
    for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
        Surface& surface = scene.surfaces[i];
        const std::vector<Light> lamps = few ? lamps_of(surface, i) : std::vector<Light>();
        scene.lights.insert(scene.lights.end(), lamps.begin(), lamps.end());
        if (!lamps.empty())
            surface.emission = Rgb(0.0);
        else if (can_be_light(surface))
            scene.lights.push_back(SurfaceLight{surface.emission, "", static_cast<int>(i)});
    }
    return scene;
}

Scene without_lamps_of_surfaces(Scene scene) {
    for (const Light& light : scene.lights)
        std::visit(
            [&](const auto& kind) {
                if constexpr (requires { kind.body; })
                    if (kind.body != no_body)
                        scene.surfaces[std::size_t(kind.body)].emission = kind.radiance;
            },
            light);
    std::erase_if(scene.lights, is_of_surface);
    return scene;
}

} // namespace vkvol
