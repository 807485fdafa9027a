// The part of SceneReader that reads a domain that repeats.
#include <fmt/format.h>

#include "scene_reader.h"

namespace vkvol {

std::optional<Periodic> SceneReader::periodic() const {
    const XmlElement element = one("periodic");
    if (!element.exists())
        return std::nullopt;
    element.allow({"x", "y", "z"});
    Periodic periodic;
    for (int axis = 0; axis < 3; ++axis) {
        const char name[] = {"xyz"[axis], '\0'};
        if (!element.has(name))
            continue;
        const std::vector<double> ends = element.attribute_numbers(name, coordinate);
        if (ends.size() != 2 || !(ends[0] < ends[1]))
            element.fail_attribute(name,
                                   fmt::format("<periodic> {}: expected where the domain begins and where it ends, "
                                               "e.g. {}=\"-10 10\"",
                                               name, name));
        periodic.low[axis] = ends[0];
        periodic.high[axis] = ends[1];
    }
    if (periodic.size() == glm::dvec3(0.0))
        element.fail("<periodic> repeats along no axis; say from where to where, e.g. x=\"-10 10\" z=\"-10 10\", or "
                     "remove it");
    return periodic;
}

} // namespace vkvol
