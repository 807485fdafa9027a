// Where in their tables cells over the medium are. Over several media some may be coarse: those where no small medium is, and
// which have but one entry; others are bricks of cells, with an entry each.
#ifndef CELLS_GLSL
#define CELLS_GLSL
#include "lib/buffers.glsl"

const bool LONG_STEPS = (LEAPS | CELL_BITS) != 0; // walks may pass several cells at once

#ifdef SEVERAL
uint overlap_word(uint i) {
    return TEXELS != 0 ? texelFetch(overlap_texels, int(i)).x : overlaps[i];
}
#endif

uint cell_index(ivec3 cell, ivec3 dims) {
    return uint((cell.x * dims.y + cell.y) * dims.z + cell.z);
}

// `edge`: of what has the entry, cells.
uint cell_entry(MediumParams v, ivec3 cell, out int edge) {
    edge = 1;
    uint entry = cell_index(cell, v.cell_dims);
#ifdef SEVERAL
    if (CELL_BITS != 0) {
        ivec3 dims = v.cell_dims >> CELL_BITS;
        uint coarse = cell_index(cell >> CELL_BITS, dims);
        uint brick = overlap_word(frame.overlaps.bricks + coarse);
        uint within = cell_index(cell & ((1 << CELL_BITS) - 1), ivec3(1 << CELL_BITS));
        uint fine = uint(dims.x * dims.y * dims.z) + ((brick - 1u) << (3 * CELL_BITS)) + within;
        edge = brick == 0u ? 1 << CELL_BITS : 1;
        entry = brick == 0u ? coarse : fine;
    }
#endif
    return entry;
}

#endif
