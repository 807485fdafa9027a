// Where particles come from: a source is chosen by its power, then a place and a direction as it shines. So their light is nearly the
// same for all of one source, and of all sources where the host knows their power.
#ifndef PARTICLE_GLSL
#define PARTICLE_GLSL
#include "field/emission.glsl"
#include "field/superposition.glsl"
#include "lights/families.glsl"
#include "lights/lamp.glsl"
#include "lights/table.glsl"
#include "shapes/period.glsl"
#include "surfaces/surface_point.glsl"

// How light leaves its source, about where a particle begins.
const uint SHINES_UNSEEN = 0u; // from a point, or from infinitely far: no particle is seen before it is scattered
const uint SHINES_FLAT = 1u;   // evenly from a surface
const uint SHINES_ALIKE = 2u;  // into all directions

struct Particle {
    vec3 position; // render space
    vec3 direction;
    vec3 light; // over the density of all that was drawn
    vec3 normal;
    uint shines; // SHINES_...
    uint medium; // as in PathState
    vec2 shares; // see families.glsl
};

Particle particle(vec3 position, vec3 direction, vec3 light, uint shines) {
    return Particle(position, direction, light, vec3(0.0), shines, 0u, vec2(0.0));
}

// Per steradian, of the light of a particle.
float shine_toward(Particle p, vec3 direction) {
    return p.shines == SHINES_ALIKE ? INV_4PI : p.shines == SHINES_FLAT ? max(dot(p.normal, direction), 0.0) / PI : 0.0;
}

// Through a face of a domain that repeats along two axes, above all there is or below it: see from_afar.
Particle through_face(vec3 toward, vec3 light, vec2 u) {
    ParticleParams all = frame.particles;
    float rise = dot(toward, all.open);
    vec3 at = frame.period.size * vec3(u.x, all.open.x > 0.0 ? u.x : u.y, u.y);
    vec3 position = mix(frame.period.low + at, vec3(rise > 0.0 ? all.above : all.below), all.open);
    vec3 size = mix(frame.period.size, vec3(1.0), all.open);
    return particle(position, -toward, size.x * size.y * size.z * abs(rise) * light, SHINES_UNSEEN);
}

// Across the ball that is lit from afar. `light`: irradiance.
Particle from_afar(vec3 toward, vec3 light, vec2 u) {
    ParticleParams all = frame.particles;
    if (REPEATS)
        return through_face(toward, light, u);
    vec3 tangent, bitangent;
    build_frame(toward, tangent, bitangent);
    vec2 at = all.radius * in_disk(u);
    return particle(all.radius * toward + at.x * tangent + at.y * bitangent, -toward,
                    PI * all.radius * all.radius * light, SHINES_UNSEEN);
}

// From a point, which may lie in a surface's plane: it begins beyond where rounding might have that before it.
Particle from_point(LightRow row, vec3 direction, vec3 light) {
    float apart = HAS_SURFACES ? 2.0 * max(spare_at(row.position), row.apart) : 0.0;
    return particle(row.position + apart * direction, direction, light, SHINES_UNSEEN);
}

// Off the surface that it may be, whose largest coordinates are these (see SurfacePoint), and `least` off what it lies in.
Particle from_surface(vec3 position, vec3 normal, vec3 reach, float least, vec3 light, vec2 u) {
    float apart = HAS_SURFACES ? max(spare_at(reach), least) : 0.0;
    Particle p = particle(position + apart * normal, by_cosine(normal, u), light, SHINES_FLAT);
    p.normal = normal;
    return p;
}

Particle from_spot(LightRow light, vec2 u) {
    float x = light.none_beyond * u.x;
    vec3 direction = turned(light.direction, x, u.y);
    return from_point(light, direction, 2.0 * PI * light.none_beyond * spot_falloff(light, x) * light.radiance);
}

Particle from_light(LightRow light, vec2 where, vec2 u, inout Rng rng) {
    float pdf = 0.0;
    Particle p;
    if (SEES_LAMPS && light.kind == LIGHT_SPHERE) {
        vec3 normal = in_any_direction(where);
        p = from_surface(light.position + light.extent * normal, normal, abs(light.position) + light.extent, 0.0,
                         4.0 * PI * light.area * light.radiance, u);
    } else if (SEES_LAMPS && (light.kind & LIGHT_FLAT) != 0u) {
        vec3 reach = abs(light.position) + abs(light.edge_u) + abs(light.edge_v);
        p = from_surface(flat_point(light, where), light.direction, reach, light.apart, PI * light.area * light.radiance, u);
    } else if (light.kind == LIGHT_POINT) {
        p = from_point(light, in_any_direction(u), 4.0 * PI * light.radiance);
    } else if (light.kind == LIGHT_SPOT) {
        p = from_spot(light, u);
    } else {
        LightSample drawn = sample_shapeless(light, vec3(0.0), u, rng);
        p = from_afar(drawn.direction, drawn.light / (drawn.pdf > 0.0 ? drawn.pdf : 1.0), where);
        pdf = drawn.pdf;
    }
    if (WEIGHS)
        p.shares = light_shares(light, max(dot(p.normal, p.direction), 0.0), pdf);
    return p;
}

// The same from everywhere, `side` in [0, 1). What comes through a face goes by the cosine.
Particle from_background(vec2 where, vec2 u, float side) {
    vec3 light = frame.lights[FRAME_BACKGROUND].radiance;
    if (!REPEATS)
        return from_afar(in_any_direction(u), 4.0 * PI * light, where);
    vec3 open = frame.particles.open;
    vec3 toward = by_cosine(side < 0.5 ? open : -open, u);
    return from_afar(toward, 2.0 * PI / max(abs(dot(toward, open)), 1.0e-6) * light, where);
}

// Anywhere in the box about all media. What there is of light depends on where that is.
Particle from_glow(MediumParams v, vec2 where, vec2 u, uvec4 words, inout Rng rng) {
    ParticleParams all = frame.particles;
    vec3 position = all.glow_corner + where.x * all.glow_edges[0] + where.y * all.glow_edges[1] +
                    to_uniform(words).z * all.glow_edges[2];
    vec3 at = to_medium(v, position, vec3(0.0)).origin;
    uvec4 more = next_words(rng);
    Matter met = matter_at(v, at, to_tap(more), to_choice(more), to_spectrum(vec3(1.0)));
    bool inside = SHAPE != SHAPE_SPHERE || dot(at, at) < 1.0;
    vec3 light = inside ? vec3((v.sigma_t * met.density) * (met.ratio * met.share)) * emitted_radiance(medium_of(v, met.medium), position)
                        : vec3(0.0);
    return particle(position, in_any_direction(u), 4.0 * PI * all.glow_volume * light, SHINES_ALIKE);
}

#ifdef SURFACES
Particle from_primitive(uint i, vec2 where, vec2 u, float side) {
    SurfacePrimitive piece = primitive_at(i);
    SurfaceRow row = surface_row(piece.surface);
    float scale = edge_scale(piece), radius = piece.c.x;
    float area = 0.5 * length(cross(scale * (piece.b - piece.a), scale * (piece.c - piece.a))) / scale / scale;
    if (piece.shape != SURFACE_TRIANGLES)
        area = (piece.shape == SURFACE_SPHERE ? 4.0 : 1.0) * PI * radius * radius;
    SurfacePoint at = surface_point(i, point_on(piece, where));
    vec3 normal = row.sides == 2u && side < 0.5 ? -at.normal : at.normal;
    Particle p = particle(at.position + at.apart * normal, by_cosine(normal, u), PI * float(row.sides) * area * row.emission, SHINES_FLAT);
    p.normal = normal;
    p.medium = AT_SURFACE | i;
    return p;
}
#endif

Particle emit_particle(MediumParams v, inout Rng rng) {
    uvec4 words = next_words(rng), more = next_words(rng);
    uint i = below(frame.particles.emitters, words.x), first = frame.particles.first_emitter;
    EmitterRow source = emitters[first + choose(emitters[first + i].alias, i, words.y)];
    vec2 where = to_uniform(words).zw, u = to_uniform(more).xy;
    Particle p;
    if (EMISSION != EMISSION_NONE && source.source == SOURCE_GLOW)
        p = from_glow(v, where, u, more, rng);
    else if (source.source == SOURCE_BACKGROUND)
        p = from_background(where, u, to_uniform(more).z);
#ifdef SURFACES
    else if ((source.source & AT_SURFACE) != 0u)
        p = from_primitive(source.source & ~AT_SURFACE, where, u, to_uniform(more).z);
#endif
    else
        p = from_light(light_at(source.source), where, u, rng);
    if (REPEATS && p.shines != SHINES_UNSEEN && !is_in_domain(p.position)) // else its place is in no domain, or in another again
        p.light = vec3(0.0);
    p.light /= source.chance * frame.particles.power;
    return p;
}

#endif
