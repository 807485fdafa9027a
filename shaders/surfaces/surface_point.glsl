// Where a ray meets a piece of a surface, and what is there. All in render space.
#ifndef SURFACE_POINT_GLSL
#define SURFACE_POINT_GLSL
#include "lib/directions.glsl"
#include "shapes/mesh.glsl"

// `itself`: the ray comes from this ball. Then it leaves, or meets the far side at the end of a chord, and rounding has no say
// in which.
float meet_ball(Ray ray, vec3 center, float radius, bool itself) {
    vec3 o = ray.origin - center;
    float middle = -dot(o, ray.direction);
    vec3 closest = o + middle * ray.direction;
    float off = length(closest);
    float half_chord = sqrt(max((radius - off) * (radius + off), 0.0));
    float first = middle - half_chord, second = middle + half_chord;
    float t = off >= radius ? FAR : first > 0.0 ? first : second > 0.0 ? second : FAR;
    return itself ? (middle > 0.0 ? 2.0 * middle : FAR) : t;
}

// Distance along the ray to a disk, or to an endless plane if the radius is FAR; FAR if it meets none.
float meet_disk(Ray ray, vec3 center, vec3 normal, float radius) {
    float along = dot(normal, ray.direction);
    float t = dot(normal, center - ray.origin) / (along != 0.0 ? along : 1.0);
    vec3 aside = ray.origin + t * ray.direction - center;
    return along != 0.0 && (radius == FAR || dot(aside, aside) <= radius * radius) ? t : FAR;
}

SurfacePrimitive primitive_at(uint i) {
#ifdef SURFACES
    if (TABLE_TEXELS != 0) {
        uvec4 a = texelFetch(primitive_texels, int(3u * i)), b = texelFetch(primitive_texels, int(3u * i + 1u)),
              c = texelFetch(primitive_texels, int(3u * i + 2u));
        return SurfacePrimitive(uintBitsToFloat(a.xyz), a.w, uintBitsToFloat(b.xyz), b.w, uintBitsToFloat(c.xyz), c.w);
    }
#endif
    return primitives[i];
}

SurfaceRow surface_row(uint i) {
#ifdef SURFACES
    if (TABLE_TEXELS != 0) {
        int at = int(SURFACE_ROW_TEXELS * i);
        uvec4 a = texelFetch(surface_texels, at), b = texelFetch(surface_texels, at + 1), c = texelFetch(surface_texels, at + 2),
              d = texelFetch(surface_texels, at + 3), e = texelFetch(surface_texels, at + 4);
        return SurfaceRow(uintBitsToFloat(a.xyz), uintBitsToFloat(a.w), uintBitsToFloat(b.xyz), b.w, uintBitsToFloat(c.xyz), c.w,
                          uintBitsToFloat(d.xyz), d.w, uintBitsToFloat(e.x), uint[3](0u, 0u, 0u));
    }
#endif
    return surfaces[i];
}

// How far along the ray, beyond 0, it meets primitive `i`, which is `p`; FAR if it does not. `from`: the primitive that it comes from, which if
// flat it does not meet again, or NO_SURFACE.
float meet_primitive(MeshRay m, Ray ray, SurfacePrimitive p, uint i, uint from) {
    uint shape = p.shape;
    float t = FAR;
    if (shape == SURFACE_TRIANGLES) {
        Crossing crossing = cross_triangle(m.shear, p.a, p.b, p.c);
        t = crossing.turn != 0 ? crossing.t : FAR;
    } else if (shape == SURFACE_SPHERE) {
        t = meet_ball(ray, p.a, p.c.x, i == from);
    } else {
        t = meet_disk(ray, p.a, p.b, shape == SURFACE_DISK ? p.c.x : FAR);
    }
    return t > 0.0 && (i != from || shape == SURFACE_SPHERE) ? t : FAR;
}

struct SurfacePoint {
    vec3 position; // on the surface, as exactly as can be
    vec3 normal;   // unit, outward
    vec3 smooth_normal; // of the surface that its faces stand for
    vec2 place;    // on a texture
    float apart;   // from the surface, where no ray meets it again by rounding
    uint row;
};

// Edges times this are about 1, so that no power of theirs is beyond what has numbers.
float edge_scale(SurfacePrimitive p) {
    vec3 longest = max(abs(p.b - p.a), abs(p.c - p.a));
    return 1.0 / max(max(longest.x, longest.y), max(longest.z, 1.0e-30));
}

// The parts of the triangle's area into which the point divides it: those across from a, b and c.
vec3 parts_of(SurfacePrimitive p, vec3 at) {
    float scale = edge_scale(p);
    vec3 across = cross(scale * (p.b - p.a), scale * (p.c - p.a));
    vec2 parts = vec2(dot(cross(scale * (p.c - p.b), scale * (at - p.b)), across), dot(cross(scale * (p.a - p.c), scale * (at - p.c)), across));
    parts /= dot(across, across);
    return vec3(parts, 1.0 - parts.x - parts.y);
}

vec3 smooth_normal(SurfacePrimitive p, vec3 at, vec3 flat_normal) {
    vec3 parts = parts_of(p, at);
    SurfacePrimitive n = primitive_at(p.details);
    vec3 mixed = parts.x * n.a + parts.y * n.b + parts.z * n.c;
    bool has_normals = p.details != 0u && n.shape == DETAIL_NORMALS;
    return has_normals && dot(mixed, flat_normal) > 0.0 ? normalize(mixed) : flat_normal;
}

// As on a globe, in the middle of whose map is z.
vec2 place_on_ball(SurfacePrimitive axes, vec3 normal) {
    vec3 d = vec3(dot(axes.a, normal), dot(axes.b, normal), dot(axes.c, normal));
    return vec2(longitude_of(vec3(d.x, d.y, -d.z)) * (0.5 / PI) + 0.5, 1.0 - atan(length(d.xz), d.y) / PI);
}

vec2 texture_place(SurfacePrimitive p, vec3 at, vec3 normal) {
    SurfacePrimitive details = primitive_at(p.details);
    if (p.shape == SURFACE_TRIANGLES && details.shape == DETAIL_NORMALS)
        details = primitive_at(details.surface);
    vec2 place = vec2(dot(details.a, at - p.a), dot(details.b, at - p.a)) + details.c.xy;
    if (p.shape == SURFACE_SPHERE)
        place = place_on_ball(details, normal);
    if (p.shape == SURFACE_TRIANGLES) {
        vec3 parts = parts_of(p, at);
        place = parts.x * details.a.xy + parts.y * details.b.xy + parts.z * details.c.xy;
    }
    return place;
}

// The point of primitive `i` next to `near`. An offset of 64 u R from what is flat, with u = 2^-24 and R the greatest coordinate
// that there is in it, is beyond the error of 28 u R that a ray's crossing with a neighbour has: see mesh.glsl. Unlike a fixed
// length it serves scenes of any size.
SurfacePoint surface_point(uint i, vec3 near) {
    SurfacePrimitive p = primitive_at(i);
    uint shape = p.shape;
    SurfacePoint at;
    at.row = p.surface;
    float scale = edge_scale(p);
    at.normal = shape == SURFACE_TRIANGLES ? normalize(cross(scale * (p.b - p.a), scale * (p.c - p.a))) : p.b;
    at.position = near - at.normal * dot(at.normal, near - p.a);
    vec3 reach = max(abs(p.a), abs(near));
    if (shape == SURFACE_TRIANGLES)
        reach = max(reach, max(abs(p.b), abs(p.c)));
    if (shape == SURFACE_SPHERE) {
        at.normal = normalize(near - p.a);
        at.position = p.a + p.c.x * at.normal;
        reach = abs(p.a) + p.c.x; // its far side
    }
    at.smooth_normal = at.normal;
    at.place = vec2(0.0);
#ifdef SURFACES
    if (HAS_SMOOTH_FACES)
        if (shape == SURFACE_TRIANGLES)
            at.smooth_normal = smooth_normal(p, at.position, at.normal);
    if (HAS_TEXTURES)
        at.place = texture_place(p, at.position, at.normal);
#endif
    at.apart = spare_at(reach);
    return at;
}

#endif
