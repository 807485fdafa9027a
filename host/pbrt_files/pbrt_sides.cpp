#include "pbrt_sides.h"

#include "pbrt_triangles.h"

namespace vkvol {

bool faces_inwards(const PbrtShape& shape) {
    const PbrtThing& thing = shape.thing;
    if (thing.type == "plymesh")
        return shape.is_reversed;
    if (thing.type != "trianglemesh" && thing.type != "bilinearmesh")
        return shape.is_reversed != shape.is_mirrored; // an instance carries normals along
    const PbrtTriangles mesh = moved(thing.transform, read_triangles(thing), shape.is_reversed);
    if (as_rectangle(mesh)) // flat, but for rounding, of which its volume would be
        return false;
    double volume = 0.0; // by Gauss's theorem, six times
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3& o = mesh.points[mesh.triangles[0].x];
        volume += glm::dot(mesh.points[t.x] - o, glm::cross(mesh.points[t.y] - o, mesh.points[t.z] - o));
    }
    return volume < 0.0;
}

bool is_never_met(const PbrtShape& shape) {
    const PbrtParameters& p = *shape.thing.parameters;
    return p.texture("alpha").empty() && p.number("alpha", 1.0) <= 0.0;
}

PbrtSides sides_of(const PbrtShape& shape) {
    if (is_never_met(shape))
        return {};
    if (shape.inside == shape.outside || !faces_inwards(shape))
        return {shape.inside, shape.outside};
    return {shape.outside, shape.inside};
}

} // namespace vkvol
