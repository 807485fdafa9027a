#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"

#include "field/density.glsl"
TEST_IO(DensityInput, DensityOutput)

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.lanes)
        return;
    MediumParams v = frame.media[0];
    DensityInput input_ = inputs[i];
    DensityOutput o;
    o.filtered = density(v, input_.p, input_.tap);
    o.voxel = voxel(v.density, GRID_TYPE, ivec3(floor(input_.p)));
    o.nearest = voxel(v.density, GRID_TYPE, nearest_voxel(input_.p));
    o.trilinear = lookup_trilinear(v.density, GRID_TYPE, input_.p);
    o.stochastic = voxel(v.density, GRID_TYPE, random_corner(input_.p, input_.tap));
    outputs[i] = o;
}
