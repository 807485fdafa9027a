#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"

#include "phase/phase.glsl"
TEST_IO(PhaseInput, PhaseOutput)

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.lanes)
        return;
    PhaseInput p = inputs[i];
    PhaseOutput o;
    o.direction = hg_sample(p.g, p.direction, p.u);
    o.from_peak = hg_sample_from_peak(p.g, p.u.x);
    o.eval = hg_eval(p.g, o.from_peak);
    o.eval_pair = hg_eval(p.g, hg_from_peak(p.g, p.direction, o.direction));
    build_frame(p.direction, o.tangent, o.bitangent);
    outputs[i] = o;
}
