// The part of SceneReader that reads for how long light is taken in.
#include <algorithm>

#include "scene_reader.h"

namespace vkvol {

std::shared_ptr<const MotionBlur> SceneReader::motion_blur() const {
    const XmlElement element = one("motionBlur");
    element.allow({"open", "close"});
    if (!element.exists())
        return nullptr;
    constexpr Limits frames{-1000.0, 1000.0, true, true, "a number of frames from -1000 to 1000"};
    MotionBlur blur;
    blur.open = element.attribute_number("open", -0.25, frames);
    blur.close = element.attribute_number("close", std::min(blur.open + 0.5, frames.high), frames);
    if (!(blur.open < blur.close))
        element.fail_attribute(element.has("close") ? "close" : "open",
                               "<motionBlur> closes before it opens; expected open < close, in frames");
    return std::make_shared<const MotionBlur>(std::move(blur));
}

void SceneReader::check_motion(Scene& scene) const {
    const auto drifts = [](const Volume& volume) { return !volume.drift.grid.empty(); };
    if (!scene.motion_blur || document_.moves() || any_medium(scene, drifts))
        return;
    one("motionBlur")
        .warn("nothing moves: no value is computed from F, as in yaw=\"${= 3*F}\", and no densityField "
              "has its velocity");
    scene.motion_blur.reset();
}

} // namespace vkvol
