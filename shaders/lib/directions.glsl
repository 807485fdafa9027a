// Directions about others.
#ifndef DIRECTIONS_GLSL
#define DIRECTIONS_GLSL

const float PI = 3.14159265358979;
const float INV_4PI = 0.07957747154594767;

// Two unit vectors that complete `n` to a right-handed frame (Duff et al., "Building an Orthonormal Basis,
// Revisited", 2017); continuous but at one pole, where the sign keeps it finite.
void build_frame(vec3 n, out vec3 tangent, out vec3 bitangent) {
    float sign_z = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (sign_z + n.z);
    float b = n.x * n.y * a;
    tangent = vec3(1.0 + sign_z * n.x * n.x * a, sign_z * b, -sign_z * n.x);
    bitangent = vec3(b, sign_z + n.y * n.y * a, -n.y);
}

// The unit direction of cosine 1 - from_peak to `peak`, from_peak in [0, 2], and of azimuth 2 pi u, u in [0, 1).
vec3 turned(vec3 peak, float from_peak, float u) {
    float sine = sqrt(from_peak * (2.0 - from_peak));
    // Vulkan asks little of cos and sin, 2^-11, and that within [-pi, pi] only: from half a turn back, and of unit
    // length, so that the polar angle keeps its digits.
    float phi = 6.283185307179586 * (u - 0.5);
    vec2 around = -normalize(vec2(cos(phi), sin(phi)));
    vec3 tangent, bitangent;
    build_frame(peak, tangent, bitangent);
    return normalize(peak * (1.0 - from_peak) + (tangent * around.x + bitangent * around.y) * sine);
}

// The sine of an angle from 0 to pi / 2, with all digits where it is small, which Vulkan does not ask of sin: its series, whose
// next term is 6e-8 at the most.
float sine_of_quarter(float x) {
    float y = x * x;
    return x * (1.0 + y * (-1.0 / 6.0 + y * (1.0 / 120.0 + y * (-1.0 / 5040.0 + y * (1.0 / 362880.0 - y / 39916800.0)))));
}

// So many turns around, from x towards y; see turned().
vec2 on_circle(float turns) {
    float phi = 6.283185307179586 * (fract(turns) - 0.5);
    return -normalize(vec2(cos(phi), sin(phi)));
}

// Any direction alike.
vec3 in_any_direction(vec2 u) {
    return turned(vec3(0.0, 1.0, 0.0), 2.0 * u.x, u.y);
}

// Evenly over the unit disk. By radius and angle, not by both sines, of which Vulkan asks little: see turned().
vec2 in_disk(vec2 u) {
    float phi = 6.283185307179586 * (u.y - 0.5);
    return sqrt(u.x) * normalize(vec2(cos(phi), sin(phi)));
}

// Drawn by cosine: from_peak = 1 - sqrt(1 - u), with all digits where that is small.
vec3 by_cosine(vec3 normal, vec2 u) {
    return turned(normal, u.x / (1.0 + sqrt(1.0 - u.x)), u.y);
}

// About y, from -z towards +x, in radians. Straight up and down, of which atan says nothing, it is 0.
float longitude_of(vec3 direction) {
    bool has_one = direction.x != 0.0 || direction.z != 0.0;
    return atan(direction.x, has_one ? -direction.z : 1.0);
}

#endif
