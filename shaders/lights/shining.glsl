// Surfaces of any shape that shine: meshes, boxes, what shines on both sides, and all where there are too many to be lamps. Flights
// meet them as they meet any surface; and looks go to a point of them, drawn evenly over their area. Both find the same light, and share
// it by weights for which any function of the vertex and the point will do that both know: a look's density, but for the chance with which
// its light was chosen, which a flight would have to go down the tree for. What it is on average stands in for that.
#ifndef SHINING_GLSL
#define SHINING_GLSL
#include "lib/alias.glsl"
#include "lights/mis.glsl"
#include "lights/sample.glsl"
#include "surfaces/scatterer.glsl"
#include "surfaces/surface_point.glsl"

#ifdef SURFACES
// A point of a piece, evenly over its area.
vec3 point_on(SurfacePrimitive piece, vec2 u) {
    vec3 at = mix(piece.a, mix(piece.b, piece.c, u.y), sqrt(u.x));
    if (piece.shape == SURFACE_SPHERE) {
        at = piece.a + piece.c.x * in_any_direction(u);
    } else if (piece.shape == SURFACE_DISK) {
        vec3 tangent, bitangent;
        build_frame(piece.b, tangent, bitangent);
        vec2 place = piece.c.x * in_disk(u);
        at = piece.a + place.x * tangent + place.y * bitangent;
    }
    return at;
}

vec3 normal_at(SurfacePrimitive piece, vec3 at) {
    float scale = edge_scale(piece);
    vec3 normal = piece.shape == SURFACE_SPHERE      ? at - piece.a
                  : piece.shape == SURFACE_TRIANGLES ? cross(scale * (piece.b - piece.a), scale * (piece.c - piece.a))
                                                     : piece.b;
    return normalize(normal);
}

// Density for weights, per steradian, of looks toward a point that is the root of `square` away. `per_area`: look_density.
float shining_density(float per_area, float square, float cosine) {
    return per_area * square / max(abs(cosine), 1.0e-12);
}

// A look's light, over the density that it was drawn with; `density`: that for weights. Where it comes within a ten-millionth of the
// surface's size, as no two places in it are known, it counts as that far.
LightSample draw_shining(LightRow light, vec3 from, vec2 u, inout Rng rng, out float density) {
    uvec4 words = next_words(rng);
    uint i = below(light.pieces, words.x);
    SurfacePrimitive piece = primitive_at(emitters[light.first_piece + choose(emitters[light.first_piece + i].alias, i, words.y)].source);
    vec3 at = point_on(piece, u), apart = at - from;
    float square = max(dot(apart, apart), max(1.0e-14 * light.area, 1.0e-30)), distance = sqrt(square);
    vec3 direction = apart / distance;
    float cosine = -dot(normal_at(piece, at), direction);
    bool shines = light.area > 0.0 && (light.sides == 2u || cosine > 0.0);
    density = shining_density(light.look_density, square, cosine);
    return LightSample(direction, distance, shines ? light.radiance * (light.area * abs(cosine) / square) : vec3(0.0), 0.0);
}

LightSample sample_shining(Scatterer s, LightRow light, vec3 from, vec3 travel, vec2 u, inout Rng rng) {
    float density;
    LightSample drawn = draw_shining(light, from, u, rng, density);
    drawn.light *= weight_of_look(density, scatter_pdf(s, travel, drawn.direction));
    return drawn;
}

// What is left to a flight that meets such a surface, `distance` from the vertex where its direction was drawn with density `phase_pdf`:
// all where that could go no other way, as a camera's rays, or is not looked for.
float share_of_met(SurfaceRow row, float cosine, float distance, float phase_pdf) {
    float density = shining_density(row.look_density, distance * distance, cosine);
    return phase_pdf > 0.0 && row.look_density > 0.0 ? weight_of_flight(phase_pdf, density) : 1.0;
}
#endif

#endif
