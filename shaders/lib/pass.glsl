// What every pass begins with: its group size and push constants.
#ifndef PASS_GLSL
#define PASS_GLSL
#include "lib/buffers.glsl"

layout(local_size_x = WORKGROUP_SIZE) in;
layout(scalar, push_constant) uniform PushBlock { PassPush push_block; };
PassPush push = push_block; // read once, like the frame

#endif
