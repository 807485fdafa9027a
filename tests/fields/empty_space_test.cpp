// How far all is empty around an empty majorant cell.
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "empty_space.h"
#include "support/test_grids.h"

using namespace vkvol;

namespace {

int chessboard(glm::ivec3 a, glm::ivec3 b) {
    const glm::ivec3 apart = glm::abs(a - b);
    return std::max({apart.x, apart.y, apart.z});
}

} // namespace

TEST_CASE("the reach of an empty cell is how far all cells around it are empty", "[cpu][majorant]") {
    std::mt19937 engine(5);
    MajorantGrid m{8, {0, 0, 0}, {17, 13, 11}, {}};
    const int every = GENERATE(3, 50, 1000); // cells, one of which is not empty
    for (int i = 0; i < m.dims.x * m.dims.y * m.dims.z; ++i)
        m.bounds.push_back(engine() % every == 0 ? 0.5f : 0.0f);
    const std::vector<std::uint8_t> reaches = empty_reaches(m);
    m.leaps = true;
    const std::vector<float> walked = walked_cells(m);
    std::size_t i = 0;
    for (glm::ivec3 a(0); a.x < m.dims.x; ++a.x)
        for (a.y = 0; a.y < m.dims.y; ++a.y)
            for (a.z = 0; a.z < m.dims.z; ++a.z, ++i) {
                int nearest = 255; // beyond the grid all is empty
                for (glm::ivec3 b(0); b.x < m.dims.x; ++b.x)
                    for (b.y = 0; b.y < m.dims.y; ++b.y)
                        for (b.z = 0; b.z < m.dims.z; ++b.z)
                            if (bound_of(m, b) > 0.0f)
                                nearest = std::min(nearest, chessboard(a, b));
                REQUIRE(int(reaches[i]) == std::max(nearest - 1, 0));
                REQUIRE(walked[i] == (nearest == 0 ? 0.5f : -float(std::max(nearest - 1, 0))));
            }
    m.leaps = false;
    CHECK(walked_cells(m) == m.bounds);
}

TEST_CASE("reaches end at what a byte holds", "[cpu][majorant]") {
    MajorantGrid row{8, {0, 0, 0}, {1, 600, 1}, std::vector<float>(600, 0.0f)};
    row.bounds[0] = 1.0f;
    const std::vector<std::uint8_t> reaches = empty_reaches(row);
    for (int i = 0; i < 600; ++i)
        REQUIRE(int(reaches[std::size_t(i)]) == std::clamp(i - 1, 0, 254));
}
