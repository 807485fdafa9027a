#include "surface_lamps.h"

#include <algorithm>

namespace vkvol {

namespace {

constexpr std::size_t most_lamps = 256; // every camera ray asks all of them

// From the front, or with -1 from the back.
struct LampOf {
    const Surface& surface;
    int body;
    double side;

    Light operator()(const BallSurface& ball) const {
        return SphereLight{ball.center, ball.radius, surface.emission, "", body};
    }
    Light operator()(const DiskSurface& disk) const {
        return DiskLight{disk.center, side * disk.normal, disk.radius, surface.emission, "", body};
    }
    Light operator()(const RectangleSurface& r) const {
        return RectangleLight{r.center, side * r.edge_u, r.edge_v, surface.emission, "", body};
    }
    template <class Shape> Light operator()(const Shape&) const { return DirectionalLight{}; } // not asked for
};

bool is_flat(const Surface& surface) {
    return std::holds_alternative<DiskSurface>(surface.shape) ||
           std::holds_alternative<RectangleSurface>(surface.shape);
}

// A ball that shines inwards too is met by chance: a lamp does not.
bool may_be_lamp(const Surface& surface) {
    const bool is_ball = std::holds_alternative<BallSurface>(surface.shape) && !surface.shines_both_ways;
    return surface.emission != Rgb(0.0) && (is_ball || is_flat(surface));
}

} // namespace

Scene with_lamps_of_surfaces(Scene scene) {
    const auto count = std::count_if(scene.surfaces.begin(), scene.surfaces.end(), may_be_lamp);
    if (std::size_t(count) > most_lamps)
        return scene;
    for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
        Surface& surface = scene.surfaces[i];
        if (!may_be_lamp(surface))
            continue;
        scene.lights.push_back(std::visit(LampOf{surface, static_cast<int>(i), 1.0}, surface.shape));
        if (surface.shines_both_ways)
            scene.lights.push_back(std::visit(LampOf{surface, static_cast<int>(i), -1.0}, surface.shape));
        surface.emission = Rgb(0.0);
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
    std::erase_if(scene.lights, [](const Light& light) { return body_of(light) != no_body; });
    return scene;
}

} // namespace vkvol
