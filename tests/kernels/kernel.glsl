// What every test kernel begins with. TEST_IO(In, Out) declares `inputs` and `outputs`; the runner passes the number
// of invocations it asked for in push.lanes.
#ifndef TEST_KERNEL_GLSL
#define TEST_KERNEL_GLSL
#include "lib/pass.glsl"
#include "test_items.h"

#define TEST_IO(In, Out)                                                                                               \
    layout(scalar, binding = BINDING_TEST_INPUT) readonly buffer TestInputBlock { In inputs[]; };                      \
    layout(scalar, binding = BINDING_TEST_OUTPUT) buffer TestOutputBlock { Out outputs[]; };

#endif
