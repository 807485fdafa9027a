// How kernels reach what the walk reads at every step: the words of all grids, their leaf tables, and the majorants.
// Grids lie in one buffer or, where that would be larger than the device allows, in windows of 2^WINDOW_BITS words, each a
// buffer of its own, reached by its address. What lies in one buffer is read as storage, or as texels.
#ifndef GRID_GLSL
#define GRID_GLSL
#include "lib/buffers.glsl"

#ifdef WINDOWS
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
layout(constant_id = SPEC_WINDOW_BITS) const uint WINDOW_BITS = 26u;
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer GridWindow { uint words[]; };

uint grid_word(uint i) {
    return GridWindow(frame_block.grid_windows[i >> WINDOW_BITS]).words[i & ((1u << WINDOW_BITS) - 1u)];
}
#else
uint grid_word(uint i) {
    return TEXELS != 0 ? texelFetch(grid_texels, int(i)).x : grid_words[i];
}
#endif

uint leaf_entry(uint i) {
    return TEXELS != 0 ? texelFetch(leaf_texels, int(i)).x : leaf_table[i];
}

float cell_majorant(uint i) {
    return TEXELS != 0 ? texelFetch(majorant_texels, int(i)).x : majorants[i];
}

#endif
