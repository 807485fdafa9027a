// Directives that move what comes after them.
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "pbrt_directives.h"

namespace vkvol {

namespace {

glm::dvec3 unit(const glm::dvec3& v) {
    return v / glm::length(v);
}

using Kind = PbrtToken::Kind;

} // namespace

void PbrtDirectives::concatenate(const glm::dmat4& transform) {
    if (!state_.is_moving)
        state_.transform = state_.transform * transform;
}

// Column by column.
glm::dmat4 PbrtDirectives::matrix() {
    glm::dmat4 m;
    tokens_.next(Kind::open, "[ and 16 numbers");
    for (int i = 0; i < 16; ++i)
        m[i / 4][i % 4] = tokens_.number();
    tokens_.next(Kind::close, "] after 16 numbers");
    return m;
}

// From the world to the camera's space: x to the right, y upwards, z along the view.
glm::dmat4 PbrtDirectives::look_at() {
    glm::dvec3 eye, target, up;
    for (glm::dvec3* point : {&eye, &target, &up})
        for (int axis = 0; axis < 3; ++axis)
            (*point)[axis] = tokens_.number();
    const glm::dvec3 forward = unit(target - eye), right = unit(glm::cross(unit(up), forward));
    return glm::inverse(glm::dmat4(glm::dvec4(right, 0.0), glm::dvec4(glm::cross(forward, right), 0.0),
                                   glm::dvec4(forward, 0.0), glm::dvec4(eye, 1.0)));
}

void PbrtDirectives::add_transforms() {
    const auto three = [this] {
        glm::dvec3 v;
        for (int axis = 0; axis < 3; ++axis)
            v[axis] = tokens_.number();
        return v;
    };
    // Names whatever leaves no inverse: without one there is nothing to be seen.
    const auto checked = [this](const PbrtToken& directive, const glm::dmat4& m) {
        const double size = glm::determinant(glm::dmat3(m));
        if (!std::isfinite(size) || size == 0.0)
            fail_at(directive.place,
                    fmt::format("{} leaves nothing of space; expected a map with an inverse", directive.value));
        const double w = m[3][3], most = 1e-6 * std::abs(w); // of what inverting a matrix leaves
        if (!(std::abs(m[0][3]) <= most && std::abs(m[1][3]) <= most && std::abs(m[2][3]) <= most && w != 0.0))
            fail_at(directive.place, fmt::format("the {} has perspective, in the last of each four numbers; expected 0 "
                                                 "0 0 1 there (a translation is in the last four)",
                                                 directive.value));
        glm::dmat4 affine = m / w;
        for (int column = 0; column < 4; ++column)
            affine[column][3] = column == 3 ? 1.0 : 0.0;
        return affine;
    };
    handlers_["Identity"] = [this](const PbrtToken&) {
        if (!state_.is_moving)
            state_.transform = glm::dmat4(1.0);
    };
    handlers_["Translate"] = [this, three](const PbrtToken&) { concatenate(glm::translate(glm::dmat4(1.0), three())); };
    handlers_["Scale"] = [=, this](const PbrtToken& token) {
        concatenate(checked(token, glm::scale(glm::dmat4(1.0), three())));
    };
    handlers_["Rotate"] = [=, this](const PbrtToken& token) {
        const double angle = glm::radians(tokens_.number());
        const glm::dvec3 axis = three();
        if (axis == glm::dvec3(0.0))
            fail_at(token.place, "Rotate lacks its axis; expected an angle and x y z");
        concatenate(glm::rotate(glm::dmat4(1.0), angle, unit(axis)));
    };
    handlers_["LookAt"] = [=, this](const PbrtToken& token) {
        const glm::dmat4 m = look_at();
        const double size = glm::determinant(glm::dmat3(m));
        if (!(size > 0.5)) // or not a number
            fail_at(token.place, "LookAt has no direction, or its up is along it; expected eye, target and up");
        concatenate(m);
    };
    handlers_["Transform"] = [=, this](const PbrtToken& token) {
        const glm::dmat4 m = checked(token, matrix());
        if (!state_.is_moving)
            state_.transform = m;
    };
    handlers_["ConcatTransform"] = [=, this](const PbrtToken& token) { concatenate(checked(token, matrix())); };
    handlers_["TransformTimes"] = [this](const PbrtToken&) {
        tokens_.number();
        tokens_.number();
    };
    handlers_["ActiveTransform"] = [this](const PbrtToken& token) { read_active_transform(token); };
}

void PbrtDirectives::add_coordinate_systems() {
    handlers_["CoordinateSystem"] = [this](const PbrtToken&) {
        coordinate_systems_[name("a name in quotes")] = state_.transform;
    };
    handlers_["CoordSysTransform"] = [this](const PbrtToken& token) {
        const std::string wanted = name("a name in quotes");
        const auto system = coordinate_systems_.find(wanted);
        if (system == coordinate_systems_.end())
            note(token.place, fmt::format("no CoordinateSystem \"{}\" before this; it changes nothing", wanted));
        else
            state_.transform = system->second;
    };
}

void PbrtDirectives::read_active_transform(const PbrtToken& directive) {
    const PbrtToken which = tokens_.next(Kind::word, "All, StartTime or EndTime");
    if (which.value != "All" && which.value != "StartTime" && which.value != "EndTime")
        fail_at(which.place, fmt::format("'{}': expected All, StartTime or EndTime", which.value));
    state_.is_moving = which.value == "EndTime";
    if (which.value != "All")
        note(directive.place, "nothing moves while the shutter is open; all is where it is at StartTime");
}

} // namespace vkvol
