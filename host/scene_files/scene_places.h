// Where things are, which several elements say alike.
#pragma once

#include "xml_reader.h"

namespace vkvol {

// Without over- or underflow; not of 0.
glm::dvec3 unit(const glm::dvec3& v);

// Where it is, or where towards, by x, y and z; 0 where they are missing.
glm::dvec3 xyz(const XmlElement& element, const Limits& limits);

// An attribute of three numbers.
glm::dvec3 triple(const XmlElement& element, const char* name, const Limits& limits);

// Unit, towards what is infinitely far away: by x, y and z, or by zenith and azimuth, degrees: from y, and from z
// towards x, counter-clockwise as seen from above.
glm::dvec3 direction_towards(const XmlElement& element);

// Towards lookAt="x y z", unit.
glm::dvec3 looking_at(const XmlElement& element, const glm::dvec3& position);

struct Rectangle {
    glm::dvec3 center;
    glm::dvec3 edge_u, edge_v; // halves of its edges; their cross product points to the side that it faces
};

// x, y and z, as columns, of what is flat and faces along z: `up`, or else what is upright, is upwards as seen from
// there.
glm::dmat3 axes_facing(const XmlElement& element, const glm::dvec3& normal);

// By x, y, z, lookAt, up, width and height, as a camera of this `lookAt` and `up` would have it.
Rectangle rectangle(const XmlElement& element);

} // namespace vkvol
