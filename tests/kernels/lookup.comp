#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"

#include "include/density.glsl"
TEST_IO(DensityInput, DensityOutput)

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.lanes)
        return;
    VolumeParams v = frame.volume;
    DensityInput input_ = inputs[i];
    DensityOutput o;
    o.filtered = density(v, input_.p, input_.tap);
    o.voxel = voxel(v, ivec3(floor(input_.p)));
    o.nearest = density_nearest(v, input_.p);
    o.trilinear = density_trilinear(v, input_.p);
    o.stochastic = density_stochastic(v, input_.p, input_.tap);
    outputs[i] = o;
}
