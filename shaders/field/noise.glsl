// Procedural density: Perlin's improved noise ("Improving Noise", SIGGRAPH 2002), summed over octaves.
#ifndef NOISE_GLSL
#define NOISE_GLSL
#include "lib/buffers.glsl"

// Entry i modulo 256. From the uniform block itself: a table in a copy would lie in memory of every lane's own.
uint permuted(uint i) {
    uint word = frame_block.media[0].noise.permutation[(i >> 4) & 15u][(i >> 2) & 3u];
    return (word >> (8u * (i & 3u))) & 255u;
}

// The product of `d` with one of the twelve directions from a cube's centre to its edges, four of them named twice.
// Without branches: lanes disagree at each, and SwiftShader took a minute to compile the eight nests of them.
float gradient(uint hash, vec3 d) {
    uint h = hash & 15u;
    float u = mix(d.y, d.x, h < 8u);
    float v = mix(mix(d.z, d.x, (h & 13u) == 12u), d.y, h < 4u);
    return mix(-u, u, (h & 1u) == 0u) + mix(-v, v, (h & 2u) == 0u);
}

// In [-perlin_bound, perlin_bound]; 0 at the lattice's points; of period 256 along each axis.
float perlin(vec3 p) {
    vec3 low = floor(p);
    uvec3 cell = uvec3(low - 256.0 * floor(low / 256.0)); // wrapped as floats: they may not fit an integer
    vec3 d = p - low;
    vec3 fade = d * d * d * (d * (d * 6.0 - 15.0) + 10.0);
    uint a = permuted(cell.x) + cell.y, b = permuted(cell.x + 1u) + cell.y;
    uint aa = permuted(a) + cell.z, ab = permuted(a + 1u) + cell.z;
    uint ba = permuted(b) + cell.z, bb = permuted(b + 1u) + cell.z;
    vec4 near = vec4(gradient(permuted(aa), d), gradient(permuted(ba), d - vec3(1.0, 0.0, 0.0)),
                     gradient(permuted(ab), d - vec3(0.0, 1.0, 0.0)), gradient(permuted(bb), d - vec3(1.0, 1.0, 0.0)));
    vec4 far = vec4(
        gradient(permuted(aa + 1u), d - vec3(0.0, 0.0, 1.0)), gradient(permuted(ba + 1u), d - vec3(1.0, 0.0, 1.0)),
        gradient(permuted(ab + 1u), d - vec3(0.0, 1.0, 1.0)), gradient(permuted(bb + 1u), d - vec3(1.0, 1.0, 1.0)));
    vec4 in_z = mix(near, far, fade.z);
    vec2 in_x = mix(in_z.xz, in_z.yw, fade.x);
    return mix(in_x.x, in_x.y, fade.y);
}

// The map of an octave, of the medium of this row. From the buffers themselves, as above.
vec4 octave(uint row, uint k) {
#ifdef SEVERAL
    return media[row].noise.to_noise[k];
#else
    return frame_block.media[0].noise.to_noise[k];
#endif
}

// max(0, (1 + fbm) / 2) at a point `position` from the middle of the shape, in world units.
float noise_density(NoiseParams n, uint row, vec3 position) {
    float sum = 0.0;
    float amplitude = 1.0;
    for (uint k = 0u; k < n.octaves; ++k) {
        vec4 to_noise = octave(row, k);
        sum += amplitude * perlin(to_noise.w * position + to_noise.xyz);
        amplitude *= n.gain;
    }
    return max(0.5 * (1.0 + sum), 0.0);
}

#endif
