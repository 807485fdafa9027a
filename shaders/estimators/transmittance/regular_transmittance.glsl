// Voxel by voxel: exact.
uint regular_transmittance(MediumParams v, inout Walk w, inout Tally tally) {
    return voxel_step(v, true, w, tally);
}
