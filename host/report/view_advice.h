// What to do about a view of which the medium is too small a part, or all, by the kind of camera it is.
#pragma once

#include <string>

#include "scene.h"

namespace vkvol {

struct ViewAdvice {
    std::string width;  // how much is in view, after "with"
    const char* frame;  // what frames the medium, and "or" to go before another remedy; "" where nothing does
    const char* larger; // what makes the medium larger in the picture
    const char* out;    // what takes the camera out of the medium
};

ViewAdvice view_advice(const Camera& camera);

} // namespace vkvol
