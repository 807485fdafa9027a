// Where a sample has a path from the sensor and a particle, both find the same light by the same vertices, and share the work: weights
// of the two that add up to 1 for all that can be found by both (multiple importance sampling, see table.glsl). Between the vertex
// nearest to the sensor and that nearest to the light both draw alike, so that their densities differ by what is drawn at
// these two and beyond (Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, 10.2); and transmittances, of which
// each family knows all but one, are left out of it: any function of the vertices may weigh them. The weight of a particle is
// r / (1 + r), that of a path 1 / (1 + r),
//
//   r = sensor_share * light_share * scattered at the light's vertex / scattered at the sensor's
//
// of particles in a picture over the density with which a sample of a pixel draws the sensor's nearest vertex, of the density
// with which a particle comes to the light's nearest vertex over that with which a path there finds the light, and, if these are
// two, of the densities with which each family leaves its first vertex, where the other one only looks.
#ifndef FAMILIES_GLSL
#define FAMILIES_GLSL
#include "lights/lamp.glsl"
#include "sensors/toward_sensor.glsl"

const bool WEIGHS = PATHS == PATHS_BOTH;
const float CERTAIN = 1.0e30; // a light_share, where no path finds that light

// `distance`: along the ray that has come from the sensor. Of a vertex that no particle can show it is 0.
float sensor_share(vec3 position, vec3 ray, float distance) {
    return float(frame.crop_width * frame.crop_height) / seen_weight(position, ray, distance);
}

// x: of a vertex that scatters into all directions, times the square of its distance, or, if negative, as it is; y: of one that
// does not, as mirrors. `cosine`: at a lamp that is flat; of a ball far away it would be rounding alone, and any
// function that both families take will do. `pdf`: of a direction from afar; 0 if no other could be.
vec2 light_shares(LightRow light, float cosine, float pdf) {
    float radius = frame.particles.radius;
    vec2 shares = vec2(0.0);
    if (light.kind == LIGHT_SURFACE || light.kind == LIGHT_GLOW) // paths find all of its light
        shares = vec2(0.0);
    else if ((light.kind & LIGHT_SHAPED) != 0u)
        shares = light.kind == LIGHT_SPHERE ? vec2(0.5 / PI, 1.0 / light.area) : vec2(cosine / PI, 4.0 / light.area);
    else if ((light.kind & LIGHT_PLACED) != 0u)
        shares = vec2(light.kind == LIGHT_SPOT ? 0.5 / (PI * max(light.none_beyond, 1.0e-12)) : INV_4PI, CERTAIN);
    else if (radius > 0.0)
        shares = vec2(-1.0, pdf > 0.0 ? 4.0 * PI * pdf : CERTAIN) / (PI * radius * radius);
    return shares;
}

// Once the vertex is known.
vec2 shares_at(vec2 shares, float distance) {
    return vec2(shares.x < 0.0 ? -shares.x : shares.x / max(distance * distance, 1.0e-30), shares.y);
}

// Shares of a light that a path finds along `direction`.
vec2 shares_of_found(LightRow light, vec3 from, vec3 direction, float distance, float pdf) {
    float cosine = max(-dot(light.direction, direction), 0.0);
    return shares_at(light_shares(light, cosine, pdf), distance);
}

// How much a vertex faces where the sensor or the light is: densities on a surface have that cosine, in matter none.
float facing(Scatterer s, vec3 direction) {
#ifdef SURFACES
    return s.is_surface ? max(abs(dot(s.bsdf.face, direction)), 1.0e-6) : 1.0;
#else
    return 1.0;
#endif
}

// The density of a direction at a vertex, the same whichever way light goes; surfaces are taken to be matt, over the cosine that
// belongs to the segment.
float between(bool is_surface, float pdf) {
    return is_surface ? 1.0 / PI : max(pdf, 1.0e-12);
}

float weight_of_path(float sensor_share, float light_share) {
    return min(sensor_share, light_share) > 0.0 ? 1.0 / (1.0 + sensor_share * light_share) : 1.0;
}
float weight_of_particle(float sensor_share, float light_share) {
    float r = sensor_share * light_share;
    return r > 0.0 ? 1.0 / (1.0 + 1.0 / r) : 0.0;
}

#endif
