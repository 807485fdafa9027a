#include "seams.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "shared/constants.h"
#include "surface_mesh.h"

namespace vkvol {

namespace {

// Along one axis. `spare`: by which rays are kept off the surface, see surfaces/surface_point.glsl.
struct Seams {
    int axis;
    double low, high, spare;

    bool is_at(double seam, const glm::dvec3& place) const { return std::abs(place[axis] - seam) <= 0.5 * spare; }
    void move(glm::dvec3& place) const {
        place[axis] += is_at(low, place) ? 1.5 * spare : is_at(high, place) ? -1.5 * spare : 0.0;
    }

    void operator()(BallSurface&) const {}  // touches them in a point
    void operator()(PlaneSurface&) const {} // lies across all of them
    void operator()(MeshSurface&) const {}  // not loaded: none
    void operator()(DiskSurface& disk) const {
        const double across = 1.0 - disk.normal[axis] * disk.normal[axis];
        if (disk.radius * std::sqrt(std::max(across, 0.0)) <= 0.5 * spare)
            move(disk.center);
    }
    void operator()(RectangleSurface& rectangle) const {
        if (std::abs(rectangle.edge_u[axis]) + std::abs(rectangle.edge_v[axis]) <= 0.5 * spare)
            move(rectangle.center);
    }
    void operator()(TriangleSurface& mesh) const {
        std::vector<bool> moves(mesh.vertices.size());
        for (const glm::uvec3& t : mesh.triangles)
            for (const double seam : {low, high})
                if (is_at(seam, mesh.vertices[t.x]) && is_at(seam, mesh.vertices[t.y]) &&
                    is_at(seam, mesh.vertices[t.z]))
                    moves[t.x] = moves[t.y] = moves[t.z] = true;
        for (std::size_t i = 0; i < moves.size(); ++i)
            if (moves[i])
                move(mesh.vertices[i]);
    }
};

} // namespace

std::vector<Surface> kept_off_seams(const Periodic& periodic, const glm::dvec3& origin, std::vector<Surface> surfaces) {
    for (Surface& surface : surfaces) {
        const double spare = SURFACE_SPARE * reach_of_surfaces(std::span(&surface, 1), origin);
        for (int axis = 0; axis < 3; ++axis)
            if (periodic.size()[axis] > 0.0)
                std::visit(Seams{axis, periodic.low[axis], periodic.high[axis], spare}, surface.shape);
    }
    return surfaces;
}

} // namespace vkvol
