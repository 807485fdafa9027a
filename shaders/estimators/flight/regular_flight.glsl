// Regular tracking (Sutton et al. 1999): voxel by voxel to where the optical depth is the sampled one. Exact.
uint regular_flight(MediumParams v, inout Walk w, inout Tally tally) {
    return voxel_step(v, false, w, tally);
}
