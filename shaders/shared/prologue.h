// Lets one header be read by C++ and GLSL. Shared headers hold data only: float, int, uint, vecN, ivecN, uvecN,
// fixed arrays and other shared structs; no bool (its size differs), no functions, no default initialisers.
// Every block that holds such a struct is declared layout(scalar), which is how C++ lays out plain glm types.
#ifndef SHARED_PROLOGUE_H
#define SHARED_PROLOGUE_H

#ifdef __cplusplus
#include <cstdint>
#include <glm/glm.hpp>
#define SHARED_BEGIN                                                                                                   \
    namespace vkvol::shared {                                                                                          \
    using glm::ivec3;                                                                                                  \
    using glm::ivec4;                                                                                                  \
    using glm::uvec2;                                                                                                  \
    using glm::uvec4;                                                                                                  \
    using glm::vec2;                                                                                                   \
    using glm::vec3;                                                                                                   \
    using glm::vec4;                                                                                                   \
    using uint = std::uint32_t;
#define SHARED_END }
#else
#define SHARED_BEGIN
#define SHARED_END
#endif

#endif
