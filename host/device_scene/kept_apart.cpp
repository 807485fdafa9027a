#include "kept_apart.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "camera_rays.h"
#include "shared/constants.h"
#include "surface_mesh.h"

namespace vkvol {

namespace {

// A triangle or a disk; or a plane, of which nothing is asked but where it is.
struct FlatPiece {
    explicit FlatPiece(const shared::SurfacePrimitive& p)
        : corners{p.a, p.b, p.c}, radius(p.shape == SURFACE_TRIANGLES ? 0.0 : double(p.c.x)) {
        const bool is_disk = p.shape != SURFACE_TRIANGLES;
        normal = is_disk ? corners[1] : glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
        double reach = 0.0;
        for (int k = 0; k < (is_disk ? 1 : 3); ++k)
            reach = std::max({reach, std::abs(corners[k].x), std::abs(corners[k].y), std::abs(corners[k].z)});
        spare = SURFACE_SPARE * reach;
    }

    // By how much rays from what lies in it are kept apart; 0: it does not lie in it, as nearly as rays know it. See
    // lies_in, surfaces/nearest.glsl.
    double spare_of(const glm::dvec3& place, double extent) const {
        return holds(place, extent) ? spare_at(place) : 0.0;
    }

    // Of a disk places err by how far off the origin they are themselves.
    double spare_at(const glm::dvec3& place) const {
        const glm::dvec3 reach = glm::abs(place);
        return radius > 0.0 ? std::max(spare, SURFACE_SPARE * std::max({reach.x, reach.y, reach.z})) : spare;
    }

    bool holds(const glm::dvec3& place, double extent) const {
        return std::abs(off(place)) <= 0.125 * spare_at(place) && is_beside(place, extent);
    }

    double off(const glm::dvec3& place) const { return glm::dot(normal, place - corners[0]); }

    // Whether it reaches as near to the place's foot on its plane.
    bool is_beside(const glm::dvec3& place, double extent) const {
        const glm::dvec3 foot = place - off(place) * normal;
        if (radius > 0.0)
            return glm::distance(foot, corners[0]) <= radius + extent;
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 edge = corners[(k + 1) % 3] - corners[k];
            if (glm::dot(glm::cross(edge, foot - corners[k]), normal) < -extent * glm::length(edge))
                return false;
        }
        return true;
    }

    glm::dvec3 corners[3];
    double radius;
    glm::dvec3 normal;
    double spare;
};

double spare_on_ball(const shared::SurfacePrimitive& ball) {
    const glm::dvec3 reach = glm::abs(glm::dvec3(ball.a)) + double(ball.c.x);
    return SURFACE_SPARE * std::max({reach.x, reach.y, reach.z});
}

double height_over_ball(const shared::SurfacePrimitive& ball, const glm::dvec3& place) {
    return glm::distance(place, glm::dvec3(ball.a)) - double(ball.c.x);
}

double spare_of_ball(const shared::SurfacePrimitive& ball, const glm::dvec3& place) {
    const double spare = spare_on_ball(ball);
    return std::abs(height_over_ball(ball, place)) <= 0.125 * spare ? spare : 0.0;
}

// By how much rays from a light of that place and extent are kept off a primitive that it lies in.
double spare_of(const shared::SurfacePrimitive& p, const glm::dvec3& place, double extent) {
    return p.shape == SURFACE_SPHERE ? spare_of_ball(p, place) : FlatPiece(p).spare_of(place, extent);
}

// Of all that rays meet but planes what may be no more than `extent` from the place, and more of it.
template <class Take>
void for_each_near(const SurfaceTable& surfaces, const glm::dvec3& place, double extent, const Take& take) {
    for (std::size_t i = 0; i < surfaces.nodes.size();) {
        const shared::BvhNode& node = surfaces.nodes[i];
        const glm::dvec3 low = node.low, high = node.high, reach = glm::max(glm::abs(low), glm::abs(high));
        const double margin = extent + SURFACE_SPARE * std::max({reach.x, reach.y, reach.z});
        const bool near =
            glm::all(glm::greaterThanEqual(place, low - margin)) && glm::all(glm::lessThanEqual(place, high + margin));
        for (std::size_t k = 0; near && k < node.leaf % 8; ++k)
            take(surfaces.primitives[node.leaf / 8 + k]);
        i = near && node.leaf == 0 ? i + 1 : node.skip;
    }
}

// A sensor of irradiance, in render space.
struct SensorRectangle {
    SensorRectangle(const Scene& scene, const glm::dvec3& origin) {
        const CameraRays rays = camera_rays(scene.camera, scene.picture);
        half_edges[0] = 0.5 * scene.picture.width * rays.right;
        half_edges[1] = 0.5 * scene.picture.height * rays.down;
        middle = rays.origin(0.5 * scene.picture.width, 0.5 * scene.picture.height) - origin;
        forward = rays.forward;
        extent = glm::length(half_edges[0]) + glm::length(half_edges[1]);
        size = scene.periodic ? scene.periodic->size() : glm::dvec3(0.0);
        for (int axis = 0; axis < 3; ++axis)
            if (size[axis] > 0.0) // where surfaces are
                middle[axis] -=
                    size[axis] * std::floor((middle[axis] + origin[axis] - scene.periodic->low[axis]) / size[axis]);
        for (std::size_t i = 0; scene.periodic && i < scene.surfaces.size(); ++i)
            moved.push_back(1.5 * SURFACE_SPARE * reach_of_surfaces(std::span(&scene.surfaces[i], 1), origin));
        const glm::dvec3 reach = glm::abs(middle) + glm::abs(half_edges[0]) + glm::abs(half_edges[1]);
        spare = SURFACE_SPARE * std::max({reach.x, reach.y, reach.z});
    }

    // How far it has to move to be before a piece that it lies in by twice as much as places there err; 0: it lies in
    // none of it.
    double shift_before(const shared::SurfacePrimitive& p) const {
        if (p.shape == SURFACE_SPHERE)
            return shift_before_ball(p);
        const FlatPiece piece(p);
        const double err = std::max(spare, piece.spare);
        if (p.shape != SURFACE_PLANE && size == glm::dvec3(0.0) && !piece.is_beside(middle, extent))
            return 0.0;
        double tilt = 0.0;
        for (const glm::dvec3& edge : half_edges)
            tilt += std::abs(glm::dot(piece.normal, edge));
        const double ahead = off(piece) * (glm::dot(piece.normal, forward) < 0.0 ? -1.0 : 1.0);
        // Walls in a seam were moved into the domain (seams.cpp).
        const bool may_be_a_seam = glm::length(piece.normal * size) > 1e-3 * glm::length(size);
        return shift_of(ahead, tilt, err, may_be_a_seam ? moved[p.surface] : 0.0);
    }

    // Likewise of a ball that its middle touches.
    double shift_before_ball(const shared::SurfacePrimitive& ball) const {
        const double err = std::max(spare, spare_on_ball(ball)), height = height_over_ball(ball, middle);
        const double outward = glm::dot(forward, glm::normalize(middle - glm::dvec3(ball.a)));
        return std::abs(outward) > 0.5 ? shift_of(outward > 0.0 ? -height : height, 0.0, err, 0.0) : 0.0;
    }

    // Of what is ahead by that, and by `tilt` more or less at corners. Nearly in it, and facing it, is a place of its
    // own.
    static double shift_of(double ahead, double tilt, double err, double moved) {
        const bool is_in_it = ahead - tilt >= -2.0 * err && ahead + tilt <= err + 1.01 * moved;
        return is_in_it ? ahead + 2.0 * err : 0.0;
    }

    // How far the piece's plane is from the middle along its normal, in whichever domain it is nearest.
    double off(const FlatPiece& piece) const {
        const double own = glm::dot(piece.normal, piece.corners[0] - middle);
        double nearest = own;
        glm::dvec3 periods(0.0);
        for (periods.x = -1.0; periods.x <= 1.0; ++periods.x)
            for (periods.y = -1.0; periods.y <= 1.0; ++periods.y)
                for (periods.z = -1.0; periods.z <= 1.0; ++periods.z)
                    if (const double other = own + glm::dot(piece.normal, periods * size);
                        std::abs(other) < std::abs(nearest))
                        nearest = other;
        return nearest;
    }

    glm::dvec3 middle, forward, half_edges[2];
    glm::dvec3 size;           // of the domain, where it repeats
    double extent;             // of a ball about it
    double spare;              // of what is as far off the origin as it is
    std::vector<double> moved; // surfaces in a seam by kept_off_seams
};

} // namespace

double extent_of(const shared::LightRow& light) {
    return light.kind & LIGHT_FLAT ? glm::length(light.edge_u) + glm::length(light.edge_v) : double(light.extent);
}

void keep_apart(std::vector<shared::LightRow>& lights, const SurfaceTable& surfaces) {
    for (shared::LightRow& light : lights) {
        if (!(light.kind & LIGHT_PLACED) || light.kind == LIGHT_SURFACE) // which is where its pieces are
            continue;
        const glm::dvec3 place = light.position;
        const double extent = extent_of(light);
        for_each_near(surfaces, place, extent, [&](const shared::SurfacePrimitive& p) {
            light.apart = std::max(light.apart, static_cast<float>(spare_of(p, place, extent)));
        });
    }
}

double shift_of_sensor(const Scene& scene, const SurfaceTable& surfaces, const glm::dvec3& origin) {
    if (scene.camera.projection != Projection::irradiance)
        return 0.0;
    const SensorRectangle sensor(scene, origin);
    double shift = 0.0;
    const auto take = [&](const shared::SurfacePrimitive& p) { shift = std::max(shift, sensor.shift_before(p)); };
    const auto all = surfaces.primitives.begin();
    std::for_each(all, all + surfaces.planes, take);
    if (scene.periodic) // where it stands in all domains
        std::for_each(all + surfaces.planes, all + surfaces.met, take);
    else
        for_each_near(surfaces, sensor.middle, sensor.extent + 2.0 * sensor.spare, take);
    return shift;
}

} // namespace vkvol
