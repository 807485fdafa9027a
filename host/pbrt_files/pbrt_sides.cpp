#include "pbrt_sides.h"

#include <cmath>

#include "pbrt_triangles.h"

namespace vkvol {

bool faces_inwards(const PbrtShape& shape) {
    const PbrtThing& thing = shape.thing;
    if (thing.type == "plymesh")
        return shape.is_reversed;
    if (thing.type != "trianglemesh" && thing.type != "bilinearmesh")
        return shape.is_reversed != shape.is_mirrored; // an instance carries normals along
    const PbrtTriangles mesh = moved(thing.transform, read_triangles(thing), shape.is_reversed);
    double volume = 0.0, area = 0.0; // six times, by Gauss's theorem, and twice
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3& o = mesh.points[mesh.triangles[0].x];
        const glm::dvec3 a = mesh.points[t.x] - o, b = mesh.points[t.y] - o, c = mesh.points[t.z] - o;
        volume += glm::dot(a, glm::cross(b, c));
        area += glm::length(glm::cross(b - a, c - a));
    }
    return volume < -1e-6 * std::pow(area, 1.5); // what is flat has a volume of rounding, of six digits at worst
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
