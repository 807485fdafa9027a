// What every pass begins with: its group size and push constants.
#ifndef PASS_GLSL
#define PASS_GLSL
#include "lib/buffers.glsl"

layout(local_size_x = WORKGROUP_SIZE) in;
layout(scalar, push_constant) uniform PushBlock { PassPush push_block; };
PassPush read_push() { // once, like the frame
    PassPush copy = push_block;
    copy.before = by_lane(copy.before);
    copy.sample_end = by_lane(copy.sample_end);
    copy.places = by_lane(copy.places);
    copy.budget = by_lane(copy.budget);
    copy.step_limit = by_lane(copy.step_limit);
    return copy;
}
PassPush push = read_push();

#endif
