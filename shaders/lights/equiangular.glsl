// Distances along a flight, drawn for the sake of a light that has a place (Kulla and Fajardo, "Importance Sampling
// Techniques for Path Tracing in Participating Media", 2012). What a flight meets near such a light has no bound, since light
// falls with the square of the distance, and free flights do not seek it; these distances do.
//
// Both find the same light, and share it by weights that add up to 1 at every distance t: multiple importance sampling with, for
// the free flight's density, which is not known, that of a medium of constant density. Any positive function would do.
//
// Drawn is not evenly by angle, for which tan and its inverse have to be each other's to the last digit, of which Vulkan
// says little, but, with x = (t - foot) / off, by the density 1 / (1 + |x|)^2, which is half to all of 1 / (1 + x^2).
#ifndef EQUIANGULAR_GLSL
#define EQUIANGULAR_GLSL
#include "lib/interval.glsl"

// What of a flight may be within the medium and lit, as a light sees it.
struct Stretch {
    vec2 t;     // from where to where, from the flight's beginning [world units]
    float first; // where the flight comes into the medium, lit there or not
    float foot; // where it is nearest to the light
    float off;  // how far that is
    vec2 y;     // 1 / (1 + |x|) at its ends
    vec2 mass;  // of its part before the foot, and of that behind
};

// The part of a ray that is before a flat lamp, or in a spot's cone, whose halves to both sides the quadratic cannot tell apart. It
// is counted from the ray's foot next to the light, which is off that by `off`. Empty: both ends are the same.
vec2 lit_part(LightRow light, vec3 off, vec3 direction) {
    float a = dot(direction, light.direction), b = dot(off, light.direction);
    float c = 1.0 - light.none_beyond;
    vec2 part = vec2(-FAR, FAR);
    if ((light.kind & LIGHT_FLAT) != 0u) {
        float x = -b / a;
        part = a > 0.0 ? vec2(x, FAR) : a < 0.0 ? vec2(-FAR, x) : part;
    } else if (light.kind == LIGHT_SPOT && c > 0.0) {
        // Lit is what has b + a x >= c sqrt(off^2 + x^2). By a - c and a + c, and roots, that keep their digits beside the cone's
        // edge: 1 - a is half of the square of what the two directions are apart.
        vec3 apart = direction - light.direction, sum = direction + light.direction;
        float A = (light.none_beyond - 0.5 * dot(apart, apart)) * (0.5 * dot(sum, sum) - light.none_beyond);
        float off2 = dot(off, off), square = b * b + A * off2;
        float root = c * sqrt(max(square, 0.0));
        float q = a * b > 0.0 ? -a * b - root : root - a * b, C = b * b - c * c * off2;
        float other = q != 0.0 ? C / q : 0.0;
        vec2 x = a * b > 0.0 ? vec2(q / A, other) : vec2(other, q / A);
        if (A > 0.0)
            part = a > 0.0 ? vec2(x.y, FAR) : vec2(-FAR, x.x);
        else if (A < 0.0)
            part = square > 0.0 && b > 0.0 ? vec2(x.y, x.x) : vec2(0.0);
    }
    return part;
}

// `reach`: how far it goes, to a surface or not.
Stretch stretch_of(MediumParams v, LightRow light, vec3 position, vec3 direction, float reach) {
    Stretch s;
    if (!medium_interval(v, to_medium(v, position, direction), s.t))
        s.t = vec2(0.0);
    s.t.y = max(min(s.t.y, reach), s.t.x);
    s.first = s.t.x;
    vec3 apart = light.position - position;
    s.foot = dot(apart, direction);
    // Lamps are no points: nearer than half their size nothing grows any more. And no ray is known to hit a point, from afar.
    float area = light.kind == LIGHT_GLOW ? pow(light.area, 2.0 / 3.0) : (light.kind & LIGHT_SHAPED) != 0u || light.kind == LIGHT_SURFACE ? light.area : 0.0;
    float least = max(0.3 * sqrt(area), 1.0e-6 * length(apart));
    vec3 off = apart - s.foot * direction;
    s.off = max(length(off), max(least, 1.0e-30));
    vec2 lit = s.foot + lit_part(light, -off, direction);
    s.t = clamp(s.t, lit.x, lit.y);
    vec2 x = (s.t - s.foot) / s.off;
    s.y = 1.0 / (1.0 + abs(x));
    s.mass = vec2(x.x < 0.0 ? (x.y < 0.0 ? s.y.y : 1.0) - s.y.x : 0.0, x.y > 0.0 ? (x.x > 0.0 ? s.y.x : 1.0) - s.y.y : 0.0);
    // The differences are rounding where the light is so far away that it is even here.
    if (s.mass.x + s.mass.y < 1.0e-5 * max(s.y.x, s.y.y))
        s.mass = vec2(0.0);
    return s;
}

// Whether there is anything to draw from; else there is no density either.
bool is_open(Stretch s) {
    return s.mass.x + s.mass.y > 0.0;
}

float distance_in(Stretch s, float u) {
    float m = u * (s.mass.x + s.mass.y);
    bool before = m < s.mass.x;
    float from_foot = before ? s.y.x + m : (s.foot < s.t.x ? s.y.x : 1.0) - (m - s.mass.x);
    float x = 1.0 / from_foot - 1.0;
    return clamp(s.foot + (before ? -x : x) * s.off, s.t.x, s.t.y);
}

// Densities of t, per world unit: of distance_in, and about that of a free flight.
float equiangular_pdf(Stretch s, float t) {
    float y = 1.0 / (1.0 + abs(t - s.foot) / s.off);
    return y / (s.mass.x + s.mass.y) / (s.off + abs(t - s.foot)); // in this order, for y and mass may be as small as numbers are
}
float assumed_flight_pdf(MediumParams v, Stretch s, float t) {
    return v.usual_sigma_t * exp(-v.usual_sigma_t * max(t - s.first, 0.0));
}

bool has_place(LightRow light) {
    return (light.kind & LIGHT_PLACED) != 0u;
}

// Weight of a collision at distance t of a flight, from where this light is looked at.
float weight_of_collision(MediumParams v, LightRow light, vec3 direction, vec3 position, float t, float reach) {
    Stretch s = stretch_of(v, light, position - t * direction, direction, reach);
    float flown = assumed_flight_pdf(v, s, t);
    bool may_be_drawn = has_place(light) && is_open(s) && t >= s.t.x && t <= s.t.y;
    return may_be_drawn ? flown / max(flown + equiangular_pdf(s, t), 1.0e-30) : 1.0;
}

#endif
