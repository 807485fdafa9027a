#include "polygon.h"

#include <algorithm>
#include <cmath>

namespace vkvol {

namespace {

// Newell's: twice the area that a polygon surrounds, as a vector across it.
glm::dvec3 area_of(std::span<const glm::dvec3> corners) {
    glm::dvec3 sum(0.0);
    for (std::size_t i = 2; i < corners.size(); ++i)
        sum += glm::cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
    return sum;
}

std::vector<glm::uvec3> fan(std::span<const std::uint32_t> numbers) {
    std::vector<glm::uvec3> triangles;
    for (std::size_t i = 2; i < numbers.size(); ++i)
        triangles.emplace_back(numbers[0], numbers[i - 1], numbers[i]);
    return triangles;
}

// Corners as they lie in the polygon's plane, seen from in front.
class EarCutter {
public:
    EarCutter(std::span<const glm::dvec3> corners, const glm::dvec3& area) {
        const glm::dvec3 size = glm::abs(area);
        const int along = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const int u = (along + 1) % 3, v = (along + 2) % 3;
        area_ = size[along];
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const glm::dvec3 from_first = corners[i] - corners[0];
            places_.emplace_back(from_first[u], area[along] < 0.0 ? -from_first[v] : from_first[v]);
            left_.push_back(static_cast<std::uint32_t>(i));
        }
    }

    // First ears that are clear of everything; of what has none left, any that single roundings allow.
    std::vector<glm::uvec3> cut() {
        cut_while_there_are(1e-4 * area_ / static_cast<double>(left_.size()));
        cut_while_there_are(0.0);
        const std::vector<glm::uvec3> rest = fan(left_);
        triangles_.insert(triangles_.end(), rest.begin(), rest.end());
        return std::move(triangles_);
    }

private:
    std::size_t before(std::size_t i) const { return (i + left_.size() - 1) % left_.size(); }
    std::size_t after(std::size_t i) const { return (i + 1) % left_.size(); }

    // Twice the signed area; above 0 where a, b, c turn counterclockwise.
    static double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
        return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    }

    // From where the last one was, so that it takes no longer than it has to.
    void cut_while_there_are(double spare) {
        std::size_t at = 0, tried = 0;
        while (left_.size() > 3 && tried < left_.size()) {
            at = at < left_.size() ? at : 0;
            if (is_ear(at, spare)) {
                triangles_.emplace_back(left_[before(at)], left_[at], left_[after(at)]);
                left_.erase(left_.begin() + std::ptrdiff_t(at));
                tried = 0;
            } else {
                ++tried;
            }
            at += tried > 0 ? 1 : 0;
        }
    }

    // A corner on a line is one, too: it goes, and leaves the polygon as it was.
    bool is_ear(std::size_t i, double spare) const {
        const glm::dvec2 a = places_[left_[before(i)]], b = places_[left_[i]], c = places_[left_[after(i)]];
        const double area = turn(a, b, c);
        if (std::abs(area) <= 1e-9 * glm::length(b - a) * glm::length(c - b))
            return true;
        if (area < 0.0)
            return false;
        return std::none_of(left_.begin(), left_.end(), [&](std::uint32_t other) {
            const glm::dvec2 p = places_[other];
            return p != a && p != b && p != c && turn(a, b, p) >= -spare && turn(b, c, p) >= -spare &&
                   turn(c, a, p) >= -spare;
        });
    }

    double area_; // twice the polygon's
    std::vector<glm::dvec2> places_;
    std::vector<std::uint32_t> left_;
    std::vector<glm::uvec3> triangles_;
};

} // namespace

std::vector<glm::uvec3> triangles_of_polygon(std::span<const glm::dvec3> corners) {
    const glm::dvec3 area = area_of(corners);
    bool folds = false;
    for (std::size_t i = 2; i < corners.size(); ++i)
        folds = folds || glm::dot(glm::cross(corners[i - 1] - corners[0], corners[i] - corners[0]), area) < 0.0;
    if (folds && corners.size() <= most_to_cut)
        return EarCutter(corners, area).cut();
    std::vector<std::uint32_t> numbers(corners.size());
    for (std::size_t i = 0; i < numbers.size(); ++i)
        numbers[i] = static_cast<std::uint32_t>(i);
    return fan(numbers);
}

} // namespace vkvol
