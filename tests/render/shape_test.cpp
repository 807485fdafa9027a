// Where rays enter and leave boxes and balls, against the reference.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "intersect.spv.h"
#include "kernels/test_items.h"
#include "support/kernel_runner.h"
#include "support/numbers.h"
#include "tests/reference/closed_forms.h"

using namespace vkvol;
using shared::ShapeInput;
using shared::ShapeOutput;
using test_numbers::infinity;
using test_numbers::u;

namespace {

std::vector<ShapeOutput> intersect(const std::vector<ShapeInput>& inputs) {
    return KernelRunner(intersect_spv).run<ShapeOutput>(inputs);
}

reference::Ray to_ray(const ShapeInput& i) {
    return {glm::dvec3(i.origin), glm::dvec3(i.direction)};
}

void check_box(const ShapeInput& input, const ShapeOutput& o) {
    const reference::Interval line = reference::intersect(glm::dvec3(input.low), glm::dvec3(input.high), to_ray(input));
    const reference::Interval inside = line.empty() ? line : reference::clip(line, {0.0, infinity});
    // (face - origin) * (1 / direction): a difference, an inverse that may err by 2.5 ulp and a product, relative to
    // the result; the largest of those that decide is at most the distance to the far face.
    double reach = 0.0;
    for (int axis = 0; axis < 3; ++axis)
        if (input.direction[axis] != 0.0f)
            for (const float face : {input.low[axis], input.high[axis]}) {
                const double t = std::abs((double(face) - input.origin[axis]) / input.direction[axis]);
                if (!inside.empty() && t <= 1.01 * line.t1)
                    reach = std::max(reach, t);
                else if (inside.empty())
                    reach = std::max(reach, t);
            }
    const double eps = 8 * u * reach;
    INFO("origin " << input.origin.x << ' ' << input.origin.y << ' ' << input.origin.z << " direction "
                   << input.direction.x << ' ' << input.direction.y << ' ' << input.direction.z);
    if (o.box_hit == 0u) {
        CHECK(inside.length() <= 2.0 * eps);
    } else if (inside.empty()) {
        CHECK(o.box.y - o.box.x <= 2.0 * eps);
    } else {
        CHECK(std::abs(o.box.x - inside.t0) <= eps);
        CHECK(std::abs(o.box.y - inside.t1) <= eps);
        CHECK(o.box.x >= 0.0f);
        CHECK(o.box.x < o.box.y);
    }
}

void check_ball(const ShapeInput& input, const ShapeOutput& o) {
    const reference::Ray ray = to_ray(input);
    const double length = glm::length(ray.direction);
    const double middle = -glm::dot(ray.origin, ray.direction) / (length * length);
    const double height = glm::length(ray.at(middle));
    // The point of closest approach, origin + middle * direction, carries a few roundings of |origin| in each of its
    // components, so 1 - height^2 errs by twice that.
    const double size = 1.0 + glm::length(ray.origin), squared = 2.0 * 16 * u * size;
    const double half_squared = 1.0 - height * height;
    const reference::Interval inside{std::max(middle - std::sqrt(std::max(half_squared, 0.0)) / length, 0.0),
                                     middle + std::sqrt(std::max(half_squared, 0.0)) / length};
    INFO("origin " << input.origin.x << ' ' << input.origin.y << ' ' << input.origin.z << " direction "
                   << input.direction.x << ' ' << input.direction.y << ' ' << input.direction.z);
    // An error e in the square of the half chord h moves its end by e / 2h, or sqrt(e) where h is less than that.
    const double h = std::sqrt(std::max(half_squared, 0.0));
    const double eps = (std::min(squared / std::max(2.0 * h, 1e-30), std::sqrt(squared)) + 8 * u * size) / length;
    if (o.ball_hit == 0u)
        CHECK((half_squared <= squared || inside.t1 <= eps));
    else {
        CHECK(half_squared >= -squared);
        CHECK(std::abs(o.ball.x - inside.t0) <= eps);
        CHECK(std::abs(o.ball.y - inside.t1) <= eps);
        CHECK(o.ball.x >= 0.0f);
        CHECK(o.ball.x < o.ball.y);
    }
}

} // namespace

TEST_CASE("random rays meet boxes and balls where the reference says", "[gpu][shape]") {
    const double distance = GENERATE(0.5, 3.0, 100.0, 1e4);
    const double scale = GENERATE(1.0, 0.01, 50.0); // of the direction: a map to medium space keeps no lengths
    CAPTURE(distance, scale);
    std::mt19937 engine(1);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const auto random = [&] { return glm::dvec3(uniform(engine), uniform(engine), uniform(engine)); };
    std::vector<ShapeInput> inputs;
    for (int i = 0; i < 5000; ++i) {
        const glm::dvec3 origin = distance * random(), target = 1.2 * random();
        inputs.push_back({origin, scale * glm::normalize(target - origin), glm::vec3(-1.0f, -0.5f, -0.75f),
                          glm::vec3(1.0f, 1.0f, 0.5f)});
    }
    const auto outputs = intersect(inputs);
    int box_hits = 0, ball_hits = 0;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        check_box(inputs[i], outputs[i]);
        check_ball(inputs[i], outputs[i]);
        box_hits += outputs[i].box_hit != 0u;
        ball_hits += outputs[i].ball_hit != 0u;
    }
    CHECK(box_hits > 1000);
    CHECK(ball_hits > 1000);
}

TEST_CASE("axis-parallel rays, on faces and edges, and chords from far away", "[gpu][shape][hard]") {
    const float zero = GENERATE(0.0f, -0.0f, 1e-38f, -1e-35f);
    std::vector<ShapeInput> inputs;
    const glm::vec3 low(-1.0f), high(1.0f);
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {1.0f, -1.0f})
            for (const float a : {-1.5f, -1.0f, -0.5f, 0.0f, 1.0f, std::nextafter(1.0f, 2.0f)})
                for (const float b : {-1.0f, 0.25f, 1.0f, 2.0f})
                    for (const float start : {-1e4f, -3.0f, -1.0f, 0.0f, 1.0f, 3.0f}) {
                        glm::vec3 origin, direction(zero);
                        origin[axis] = start;
                        origin[(axis + 1) % 3] = a;
                        origin[(axis + 2) % 3] = b;
                        direction[axis] = sign;
                        inputs.push_back({origin, direction, low, high});
                    }
    const auto outputs = intersect(inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        ShapeInput exact = inputs[i];
        for (int axis = 0; axis < 3; ++axis) // so small a slant moves the ray by nothing within reach
            exact.direction[axis] = std::abs(exact.direction[axis]) < 0.5f ? 0.0f : exact.direction[axis];
        check_box(exact, outputs[i]);
        check_ball(exact, outputs[i]);
    }
    // A ray in a face counts as inside, with the whole edge as its chord.
    const auto face = intersect({{{-3, 1, 0.5}, {1, zero, zero}, low, high}, {{-3, 1, 1}, {1, zero, zero}, low, high}});
    for (const ShapeOutput& o : face) {
        CHECK(o.box_hit == 1u);
        CHECK((o.box == glm::vec2(2.0f, 4.0f)));
    }
}
