#include "pbrt_voxels.h"

#include <algorithm>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

namespace vkvol {

PbrtBounds bounds_of(const PbrtThing& medium) {
    const glm::dvec3 a = medium.parameters->point("p0", glm::dvec3(0.0));
    const glm::dvec3 b = medium.parameters->point("p1", glm::dvec3(1.0));
    const glm::dvec3 size = glm::abs(b - a);
    if (!(std::min({size.x, size.y, size.z}) > 1e-30 && std::max({size.x, size.y, size.z}) < 1e30))
        fail_at(medium.place, fmt::format("medium \"{}\": p0 and p1 enclose nothing, or too much", medium.type));
    return {glm::min(a, b), size};
}

glm::dmat4 voxels_to_medium(const PbrtBounds& bounds, glm::ivec3 dims) {
    const glm::dvec3 voxel = bounds.size / glm::dvec3(dims);
    return glm::scale(glm::translate(glm::dmat4(1.0), bounds.low + 0.5 * voxel), voxel);
}

glm::ivec3 dims_of(const PbrtThing& medium) {
    constexpr long long most = 4096;
    glm::ivec3 dims;
    for (const auto& [axis, name] : {std::pair(0, "nx"), std::pair(1, "ny"), std::pair(2, "nz")}) {
        const long long n = medium.parameters->integer(name, 1);
        if (n < 1 || n > most)
            fail_at(medium.parameters->find(name)->place, fmt::format("{} is {}; expected 1 to {}", name, n, most));
        dims[axis] = int(n);
    }
    return dims;
}

std::size_t voxel_count(glm::ivec3 dims) {
    return std::size_t(dims.x) * std::size_t(dims.y) * std::size_t(dims.z);
}

bool has_soft_edge(glm::ivec3 dims, const std::vector<float>& values) {
    if (std::max({dims.x, dims.y, dims.z}) >= 64)
        return false;
    std::size_t i = 0;
    for (int z = 0; z < dims.z; ++z)
        for (int y = 0; y < dims.y; ++y)
            for (int x = 0; x < dims.x; ++x, ++i)
                if (values[i] > 0.0f && (glm::any(glm::equal(glm::ivec3(x, y, z), glm::ivec3(0))) ||
                                         glm::any(glm::equal(glm::ivec3(x, y, z), dims - 1))))
                    return true;
    return false;
}

} // namespace vkvol
