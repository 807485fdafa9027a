#include "view_advice.h"

#include <fmt/format.h>

namespace vkvol {

ViewAdvice view_advice(const Camera& camera) {
    constexpr const char* frame = "--frame frames it, or ";
    constexpr const char* out = "move the camera out (--frame does)";
    switch (camera.projection) {
    case Projection::orthographic:
        return {fmt::format("a view {:.3g} high", camera.view_height), frame, "lower viewHeight, or --frame it", out};
    case Projection::equirectangular: // which --frame refuses
    case Projection::fluence:
    case Projection::absorption:
        return {"a view all around", "", "go nearer", "move the camera out"};
    case Projection::irradiance:
        return {"a view of half of all directions", "", "go nearer", "move the sensor out"};
    default:
        return {fmt::format("a field of view of {:.3g} degrees", camera.fov), frame,
                "go nearer, narrow fov, or --frame it", out};
    }
}

} // namespace vkvol
