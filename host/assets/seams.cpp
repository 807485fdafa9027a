#include "seams.h"

#include <algorithm>
#include <cmath>

#include "shared/constants.h"
#include "surface_mesh.h"

namespace vkvol {

namespace {

// Along one axis.
struct Seams {
    int axis;
    double low, high, spare;

    bool is_at(double seam, const glm::dvec3& place) const { return std::abs(place[axis] - seam) <= 0.5 * spare; }
    void move(glm::dvec3& place) const {
        if (is_at(low, place))
            place[axis] = low + spare;
        else if (is_at(high, place))
            place[axis] = high - spare;
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

void keep_off_seams(const Periodic& periodic, std::vector<Surface>& surfaces) {
    const glm::dvec3 size = periodic.size();
    double reach = glm::length(size);
    if (const auto bounds = bounds_of(surfaces))
        reach = std::max(reach, glm::length(bounds->high - bounds->low));
    for (int axis = 0; axis < 3; ++axis)
        if (size[axis] > 0.0)
            for (Surface& surface : surfaces)
                std::visit(Seams{axis, periodic.low[axis], periodic.high[axis], 2.0 * SURFACE_SPARE * reach},
                           surface.shape);
}

} // namespace vkvol
