#include "medium_outline.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <utility>

#include "cell_walk.h"
#include "noise.h"
#include "placement.h"

namespace vkvol {

namespace {

glm::dmat4 placed(glm::dvec3 center, glm::dvec3 half) {
    return glm::scale(glm::translate(glm::dmat4(1.0), center), half);
}

void outline_grid(const DensityField& field, MediumOutline& outline) {
    outline.to_world = field.index_to_world;
    outline.low = glm::dvec3(field.voxel_min) - 1.0; // interpolation reaches that far
    outline.high = glm::dvec3(field.voxel_max) + 1.0;
    outline.voxel = field.voxel_size();
}

glm::dvec2 crossing_of_ball(glm::dvec3 o, glm::dvec3 d) {
    const double a = glm::dot(d, d), b = glm::dot(o, d);
    // The distance of the line from the middle, without the cancellation of b^2 - a c far away.
    const glm::dvec3 nearest = o - d * (b / a);
    const double rest = 1.0 - glm::dot(nearest, nearest);
    if (!(rest > 0.0))
        return {1.0, 0.0};
    const double half = std::sqrt(rest / a);
    return {-b / a - half, -b / a + half};
}

glm::dvec2 crossing_of_box(glm::dvec3 low, glm::dvec3 high, glm::dvec3 o, glm::dvec3 d) {
    glm::dvec2 t(-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity());
    for (int i = 0; i < 3; ++i) {
        if (d[i] == 0.0) {
            if (!(o[i] > low[i] && o[i] < high[i]))
                return {1.0, 0.0};
            continue;
        }
        const double a = (low[i] - o[i]) / d[i], b = (high[i] - o[i]) / d[i];
        t = {std::max(t.x, std::min(a, b)), std::min(t.y, std::max(a, b))};
    }
    return t;
}

} // namespace

MediumOutline make_outline(const Scene& scene, const Volume& volume, const LoadedMedium& loaded, bool emits) {
    MediumOutline outline;
    const bool is_grid = std::holds_alternative<GridFile>(volume.shape);
    outline.sigma_t = largest(world_sigma_t(volume, loaded.field ? &*loaded.field : nullptr));
    outline.exists = outline.sigma_t > 0.0 && (loaded.field || !is_grid);
    outline.densest = volume.noise ? noise_bound(*volume.noise) : 1.0;
    outline.emits = emits;
    outline.has_temperature = loaded.temperature.has_value();
    outline.hottest = loaded.hottest;
    if (loaded.is_layered) {
        const MediumBounds bounds = medium_bounds(loaded);
        outline.to_world = medium_to_world(volume, loaded);
        outline.low = bounds.low;
        outline.high = bounds.high;
        outline.densest = loaded.majorants->most / scene.settings.majorant_scale;
    } else if (is_everywhere(volume)) {
        outline.to_world = medium_to_world(volume, loaded);
    } else if (const auto* sphere = std::get_if<Sphere>(&volume.shape)) {
        outline.is_ball = true;
        outline.to_world = volume.transform * placed(sphere->center, glm::dvec3(sphere->radius));
    } else if (const auto* box = std::get_if<Box>(&volume.shape)) {
        outline.to_world = volume.transform * placed(box->center, box->size / 2.0);
    } else if (loaded.mesh) {
        outline.fills = false;
        const glm::dvec3 center = box_center(*loaded.mesh);
        outline.to_world = placed(center, center - lowest_corner(*loaded.mesh));
    } else if (loaded.field) {
        outline_grid(*loaded.field, outline);
        outline.cells = loaded.majorants;
        outline.cell_scale = 1.0 / scene.settings.majorant_scale;
        outline.densest = outline.cell_scale * loaded.majorants->most;
    }
    outline.from_world = loaded.is_layered ? world_to_medium(volume, loaded) : glm::inverse(outline.to_world);
    return outline;
}

MediumOutline make_outline(const Superposition& whole, bool emits) {
    MediumOutline outline;
    outline.exists = !whole.cells.bounds.empty();
    outline.fills = false;
    outline.emits = emits;
    if (!outline.exists)
        return outline;
    outline.sigma_t = 1.0;
    outline.to_world = placed(whole.origin, glm::dvec3(whole.edge));
    outline.low = whole.low();
    outline.high = whole.high();
    if (whole.unbounded)
        outline.to_world = placed(whole.origin, glm::dvec3(everywhere_reach)); // whose cells go on beyond their grid
    else
        outline.cells = std::make_shared<const MajorantGrid>(whole.cells);
    outline.from_world = glm::inverse(outline.to_world);
    outline.densest = *std::max_element(whole.cells.bounds.begin(), whole.cells.bounds.end());
    return outline;
}

WorldBox world_box(const MediumOutline& outline) {
    WorldBox box{glm::dvec3(std::numeric_limits<double>::infinity()),
                 glm::dvec3(-std::numeric_limits<double>::infinity())};
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 pick(corner & 1, corner >> 1 & 1, corner >> 2);
        const glm::dvec3 world(outline.to_world * glm::dvec4(glm::mix(outline.low, outline.high, pick), 1.0));
        box = {glm::min(box.low, world), glm::max(box.high, world)};
    }
    return box;
}

bool is_within(const MediumOutline& outline, const glm::dvec3& place) {
    const glm::dvec3 p(outline.from_world * glm::dvec4(place, 1.0));
    return outline.exists && (outline.is_ball ? glm::length(p) <= 1.0 : p == glm::clamp(p, outline.low, outline.high));
}

bool may_have_matter(const MediumOutline& outline, const glm::dvec3& place) {
    bool may = is_within(outline, place);
    if (may && outline.cells)
        walk_cells(*outline.cells, {}, glm::dvec3(outline.from_world * glm::dvec4(place, 1.0)), {1.0, 0.0, 0.0}, 1.0,
                   [&may](double bound, double, double) {
                       may = bound > 0.0;
                       return false;
                   });
    return may;
}

std::optional<glm::dvec2> crossing(const MediumOutline& outline, glm::dvec3 origin, glm::dvec3 direction) {
    if (!outline.exists)
        return std::nullopt;
    const glm::dvec3 o(outline.from_world * glm::dvec4(origin, 1.0)),
        d(outline.from_world * glm::dvec4(direction, 0.0));
    glm::dvec2 t = outline.is_ball ? crossing_of_ball(o, d) : crossing_of_box(outline.low, outline.high, o, d);
    t.x = std::max(t.x, 0.0);
    return t.x < t.y ? std::optional(t) : std::nullopt;
}

double depth_bound(const MediumOutline& outline, glm::dvec3 origin, glm::dvec3 direction) {
    const std::optional<glm::dvec2> t = crossing(outline, origin, direction);
    if (!t)
        return 0.0;
    const double world_length = glm::length(direction);
    if (!outline.cells)
        return outline.sigma_t * outline.densest * (t->y - t->x) * world_length;
    const glm::dvec3 o(outline.from_world * glm::dvec4(origin + t->x * direction, 1.0));
    const glm::dvec3 d(outline.from_world * glm::dvec4(direction, 0.0));
    const double index_length = glm::length(d);
    double sum = 0.0;
    walk_cells(*outline.cells, {}, o, d / index_length, (t->y - t->x) * index_length,
               [&sum](double bound, double t0, double t1) {
                   sum += bound * (t1 - t0);
                   return true;
               });
    return sum * outline.cell_scale * outline.sigma_t * world_length / index_length;
}

} // namespace vkvol
