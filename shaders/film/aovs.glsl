// Images of more than radiance, where they are asked for. While a path is under way it has a record, of a vec3 for each layer: what
// light it gathers is noted there as well, by a label, and what its first collision was. When the path is over the record is a
// sample of its pixel's layers, whose sums are kept as those of the film are.
//
// A label: how often the light was scattered (LIGHT_...), the group of its source << 2, and << 10 the layer of the medium that sent
// it toward the sensor, plus 1; 0 where none did.
#ifndef AOVS_GLSL
#define AOVS_GLSL
#include "film/film.glsl"
#include "sensors/camera.glsl"

const uint GROUP_BIT = 2u;
const uint MEDIUM_BIT = 10u;
const uint SOLID = 0x80000000u; // light of a surface that shines: it is there, as what it hides is not

// Label of light that has been scattered so often, or been sent out by a medium and not been scattered since.
uint kind_label(uint scatterings) {
    return scatterings == 0u ? SCATTERED_NEVER : scatterings == 1u ? SCATTERED_ONCE : SCATTERED_OFTEN;
}
uint glow_label(uint scatterings) {
    return scatterings == 0u ? GLOW_OF_MEDIA : kind_label(scatterings);
}
uint group_label(uint group) {
    return group << GROUP_BIT;
}
uint medium_label(MediumParams met) {
    return met.layer + 1u << MEDIUM_BIT;
}

void begin_record(uint record) {
    for (uint k = 0u; k < frame.layers.count; ++k)
        layers[record * frame.layers.count + k] = vec3(0.0);
}

void note_in(uint record, uint layer, vec3 x) {
    layers[record * frame.layers.count + layer] += x;
}

void note_light(uint record, uint label, vec3 light) {
    light = measured(light);
    if ((LAYERS & LAYERS_KINDS) != 0)
        note_in(record, label & 3u, light);
    if ((LAYERS & LAYERS_GROUPS) != 0)
        note_in(record, frame.layers.groups + (label >> GROUP_BIT & 255u), light);
    if ((LAYERS & LAYERS_MEDIA) != 0)
        if ((label & ~SOLID) >> MEDIUM_BIT != 0u)
            note_in(record, frame.layers.media + ((label & ~SOLID) >> MEDIUM_BIT) - 1u, light);
}

// What of a path's light is in the picture.
vec3 held_out(vec3 light, uint label) {
    if ((LAYERS & LAYERS_HOLDOUT) != 0)
        light = (label & 3u) == SCATTERED_NEVER && (label & SOLID) == 0u ? vec3(0.0) : light;
    return light;
}

// `weight`: of the collision, in expectation the path's share that collides there. `distance`: from where the ray began.
void note_collision(uint record, vec3 weight, vec3 position, vec3 direction, float distance, vec3 albedo) {
    float w = (weight.x + weight.y + weight.z) / 3.0;
    if ((LAYERS & LAYERS_COLLISION) != 0) {
        SensorParams s = frame.sensors[0];
        float d = distance + (s.start > 0.0 ? s.start / dot(direction, s.forward) : 0.0); // from the eye
        note_in(record, frame.layers.collision, vec3(w * d, w, 0.0));
        note_in(record, frame.layers.collision + 1u, w * position);
    }
    if ((LAYERS & LAYERS_ALBEDO) != 0)
        note_in(record, frame.layers.albedo, weight * albedo);
}

// On the side from which it is seen.
void note_normal(uint record, vec3 weight, vec3 normal) {
    if ((LAYERS & LAYERS_NORMAL) != 0)
        note_in(record, frame.layers.normal, (weight.x + weight.y + weight.z) / 3.0 * normal);
}

// Mean place of a collision in a homogeneous stretch that is gone through at once, as a part of its length: for an exponential that
// is cut at tau, 1 / tau - 1 / (exp(tau) - 1), which is its series where digits would cancel.
float mean_part(float tau) {
    return tau < 0.3 ? 0.5 - tau * (1.0 / 12.0 - tau * tau / 720.0) : 1.0 / tau - 1.0 / (exp(min(tau, 80.0)) - 1.0);
}

void note_transmittance(uint record, vec3 T) {
    if ((LAYERS & LAYERS_THROUGH) != 0) {
        note_in(record, frame.layers.through, T);
        note_in(record, frame.layers.through + 1u, vec3((T.x + T.y + T.z) / 3.0));
    }
}

// To the third of the sums the product of the first two of x, as exact as their squares: a variance of depths far greater, or far
// less, than their weights is a small difference of all three.
void add_product(inout vec3 sum, inout vec3 sum_low, vec3 x) {
    vec2 head = uintBitsToFloat(floatBitsToUint(x.xy) & 0xfffff000u);
    vec2 tail = x.xy - head;
    add_compensated(sum, sum_low, vec3(0.0, 0.0, head.x * head.y));
    add_compensated(sum, sum_low, vec3(0.0, 0.0, head.x * tail.y + tail.x * head.y));
    sum_low.z += tail.x * tail.y;
}

// A path's record to the sums of its pixel: as those of the film, of the values and of their squares.
void add_layers(uint record, uint pixel) {
    uint first = (frame.layers.records + 4u * pixel) * frame.layers.count;
    for (uint k = 0u; k < frame.layers.count; ++k) {
        uint at = first + 4u * k;
        vec3 sum = layers[at], sum_low = layers[at + 1u], square = layers[at + 2u], square_low = layers[at + 3u];
        vec3 x = layers[record * frame.layers.count + k];
        add_sample(sum, sum_low, square, square_low, x);
        if ((LAYERS & LAYERS_COLLISION) != 0 && k == frame.layers.collision)
            add_product(sum, sum_low, x);
        layers[at] = sum;
        layers[at + 1u] = sum_low;
        layers[at + 2u] = square;
        layers[at + 3u] = square_low;
    }
}

#endif
