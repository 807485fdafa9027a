// Where a ray is inside closed triangle meshes, by counting the surfaces it leaves less those it enters.
//
// The ray is sheared onto the z axis (Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2013), where
// it meets a triangle if the origin lies within the triangle's projection. Each projected vertex depends on the ray and
// that vertex alone, and on which side of an edge the origin lies is decided exactly, ties included; so all triangles
// agree on one picture of the surface, and since that is closed, the crossings of a whole line always add up to 0.
// `precise` keeps the compiler from rounding the same expression differently for different triangles.
//
// A search visits one node of the hierarchy per step, so that a lane can lay it aside at any time: no loop of a kernel
// depends on how many triangles or bodies a mesh has.
#ifndef MESH_GLSL
#define MESH_GLSL
#include "shapes/shape.glsl"

const float SMALLEST = 9.094947e-13; // 2^-40

struct Shear {
    int axis;      // along which the ray goes most
    vec3 origin;   // with that axis turned to z
    vec2 slope;    // of the ray
    float inverse; // world distance per unit of z
    float scale;   // a power of two, 1 but for tiny meshes, whose lengths across the ray are then about 1
};

// What the steps of a search need of their ray.
struct MeshRay {
    Shear shear;
    vec3 before; // the origin, beyond what boxes are enlarged by
    vec3 after;
    vec3 inverse; // of the direction
};

// A cyclic exchange of axes keeps the handedness.
vec3 turn_to_z(vec3 v, int axis) {
    return axis == 0 ? v.yzx : axis == 1 ? v.zxy : v;
}

Shear make_shear(Ray ray) {
    vec3 size = abs(ray.direction);
    Shear s;
    s.axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    s.origin = turn_to_z(ray.origin, s.axis);
    vec3 d = turn_to_z(ray.direction, s.axis);
    precise float inverse = 1.0 / d.z;
    precise vec2 slope = d.xy * inverse;
    s.inverse = inverse;
    s.slope = slope;
    s.scale = 1.0;
    return s;
}

// xy: the vertex projected along the ray, times the scale; z: the world distance at which the ray passes it. Coordinates below
// 2^-40 are taken for 0, so that the rounding error of a product of two is a number of normal size.
vec3 project(Shear s, vec3 vertex) {
    precise vec3 v = turn_to_z(vertex, s.axis) - s.origin;
    precise vec2 p = (v.xy - s.slope * v.z) * s.scale;
    precise float t = v.z * s.inverse;
    return vec3(abs(p.x) < SMALLEST ? 0.0 : p.x, abs(p.y) < SMALLEST ? 0.0 : p.y, t);
}

// Twice the area of (origin, p, q), > 0 when counterclockwise. Of the right sign or 0, since rounding keeps the order
// of the two products.
float area(vec2 p, vec2 q) {
    precise float a = p.x * q.y - p.y * q.x;
    return a;
}

// a * b - p, exactly, where p is a * b rounded (Dekker, "A Floating-Point Technique for Extending the Available
// Precision", 1971; fma need not be one rounding in GLSL).
float product_error(float a, float b, float p) {
    precise float ca = 4097.0 * a, cb = 4097.0 * b; // 2^12 + 1: halves of 12 bits
    precise float ah = ca - (ca - a), bh = cb - (cb - b);
    precise float al = a - ah, bl = b - bh;
    precise float e = ((ah * bh - p) + ah * bl + al * bh) + al * bl;
    return e;
}

// The same where area() is 0: what both products, rounded alike, have lost.
float lost_area(vec2 p, vec2 q) {
    precise float product = p.x * q.y;
    precise float lost = product_error(p.x, q.y, product) - product_error(p.y, q.x, product);
    return lost;
}

// Whether the origin is on the left of the edge from p to q, whose area with it is `a`. If it is on the edge it is
// taken for moved by (e, e^2), e > 0 infinitely small, which adds e (p.y - q.y) + e^2 (q.x - p.x) to the area.
bool is_left(float a, vec2 p, vec2 q) {
    return a != 0.0 ? a > 0.0 : (p.y != q.y ? p.y > q.y : q.x > p.x);
}

struct Crossing {
    int turn;   // 1: the line leaves through the triangle, -1: it enters, 0: it passes by
    float t;    // world distance, where it does not
    vec3 areas; // the corners' weights, not normalised
};

// Crossing of the ray's whole line with a triangle.
Crossing cross_triangle(Shear s, vec3 a, vec3 b, vec3 c) {
    vec3 p = project(s, a);
    vec3 q = project(s, b);
    vec3 r = project(s, c);
    vec3 areas = vec3(area(q.xy, r.xy), area(r.xy, p.xy), area(p.xy, q.xy));
    // A loop, since software drivers do both sides of an `if`; it is seldom entered.
    for (bool tie = any(equal(areas, vec3(0.0))); tie; tie = false) {
        areas.x = areas.x == 0.0 ? lost_area(q.xy, r.xy) : areas.x;
        areas.y = areas.y == 0.0 ? lost_area(r.xy, p.xy) : areas.y;
        areas.z = areas.z == 0.0 ? lost_area(p.xy, q.xy) : areas.z;
    }
    bvec3 left = bvec3(is_left(areas.x, q.xy, r.xy), is_left(areas.y, r.xy, p.xy), is_left(areas.z, p.xy, q.xy));
    // Counterclockwise as seen from z = infinity: a ray towards there leaves, one from there enters.
    int turn = all(left) ? 1 : any(left) ? 0 : -1;
    turn = s.inverse > 0.0 ? turn : -turn;
    precise float sum = areas.x + areas.y + areas.z;
    precise float weighted = areas.x * p.z + areas.y * q.z + areas.z * r.z;
    precise float t = weighted / sum;
    return Crossing(turn, t, areas);
}

// Counts triangle `i` if the ray meets it beyond where the search began.
void add_crossing(Shear s, uint i, inout PartSearch c) {
    Crossing crossing = cross_triangle(s, triangles[3u * i], triangles[3u * i + 1u], triangles[3u * i + 2u]);
    bool met = crossing.turn != 0 && crossing.t > c.t_from;
    int turn = met ? crossing.turn : 0;
    float t = met ? crossing.t : FAR;
    c.winding += turn;
    c.turn = t < c.first ? turn : t == c.first ? c.turn + turn : c.turn;
    c.second = t < c.first ? c.first : t > c.first ? min(c.second, t) : c.second;
    c.first = min(c.first, t);
}

// 1 over the largest power of two that is no more than x < 1; else 1.
float scale_up(float x) {
    uint exponent = clamp(floatBitsToUint(x) >> 23u, 1u, 127u);
    return uintBitsToFloat(254u - exponent << 23u);
}

// Boxes are enlarged by 2^-18 R, R the greatest distance along an axis between the ray's origin and the mesh, which
// with u = 2^-24 is 64 u R. Projecting moves a vertex by at most 10 u R, and a computed t is within 10 u R sqrt(3) of
// where the ray passes the projected triangle: so the point at t is within 28 u R of the triangle's box. The slab
// test's own distances, at most 2 sqrt(3) R where they matter, err by at most 5 u of themselves, or 18 u R. The rest is
// spare.
MeshRay make_mesh_ray(uint root, uint bvh_nodes, Ray ray) {
    MeshRay m;
    m.shear = make_shear(ray);
    vec3 reach = bvh_nodes > 0u ? max(abs(bvh[root].low), abs(bvh[root].high)) + abs(ray.origin) : vec3(0.0);
    float margin = spare_at(reach);
    m.shear.scale = scale_up(max(reach.x, max(reach.y, reach.z)));
    m.before = ray.origin + margin;
    m.after = ray.origin - margin;
    // Components so small that their inverse would overflow are taken for 1e-30, which moves the ray by nothing.
    vec3 d = ray.direction;
    m.inverse = 1.0 / vec3(abs(d.x) < 1.0e-30 ? 1.0e-30 : d.x, abs(d.y) < 1.0e-30 ? 1.0e-30 : d.y,
                           abs(d.z) < 1.0e-30 ? 1.0e-30 : d.z);
    return m;
}

// Whether the ray may be in the box between t_from and t_to.
bool meets(MeshRay m, BvhNode box, float t_from, float t_to) {
    vec3 t0 = (box.low - m.before) * m.inverse, t1 = (box.high - m.after) * m.inverse;
    vec3 entries = min(t0, t1), exits = max(t0, t1);
    float entry = max(max(entries.x, entries.y), max(entries.z, t_from));
    float exit = min(min(exits.x, t_to), min(exits.y, exits.z));
    return entry <= exit;
}

// Whether the ray may meet the mesh at all.
bool may_meet_mesh(uint bvh_nodes, Ray ray) {
    return bvh_nodes > 0u && meets(make_mesh_ray(0u, bvh_nodes, ray), bvh[0], 0.0, FAR);
}

// For the first part [t.x, t.y], t_from <= t.x < t.y, of the ray beyond t_from (>= 0) that lies inside of what the
// surfaces enclose. The next part, to be looked for from t.y, may begin where this one ends. Space here is render
// space, so the ray's direction is a unit vector.
PartSearch begin_search(uint stage, float t_from) {
    return PartSearch(stage, t_from, 0u, 0, FAR, 0, FAR);
}

// One node of the search: on to the next in depth-first order, or past its subtree. True once the search is over, with
// the part, or an empty one if there is none.
bool step_search(uint bvh_nodes, MeshRay m, inout PartSearch s, out vec2 t) {
    t = vec2(0.0);
    if (s.node < bvh_nodes) {
        BvhNode node = bvh[s.node];
        bool met = meets(m, node, s.t_from, FAR);
        uint first = node.leaf >> 3u, last = first + (met ? node.leaf & 7u : 0u);
        for (uint k = first; k < last; ++k) // at most MESH_LEAF
            add_crossing(m.shear, k, s);
        s.node = met && node.leaf == 0u ? s.node + 1u : node.skip;
    }
    if (s.node < bvh_nodes)
        return false;
    bool here = s.winding > 0;
    bool next = s.winding - s.turn > 0;
    t = here ? vec2(s.t_from, s.first) : next ? vec2(s.first, s.second) : t;
    if (here || next || s.second == FAR)
        return true;
    // Two surfaces behind neither of which the ray is inside; without rounding there are only such where bodies touch
    // or a crossing is grazing.
    s = begin_search(s.stage, s.second);
    return false;
}

#endif
