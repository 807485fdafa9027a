#include "reading_grid.h"

#include <algorithm>
#include <fmt/format.h>

#include "camera_view.h"
#include "error.h"
#include "file_ending.h"
#include "image_io.h"
#include "memory_grids.h"

namespace vkvol {

bool is_reading_grid(const std::filesystem::path& target) {
    return file_ending(target) == ".nvdb";
}

void check_grid_file(const std::filesystem::path& target, const Camera& camera, bool is_cropped) {
    if (camera.projection != Projection::absorption)
        throw InputError(fmt::format("{}: a grid is what <absorption> reads, and this scene's sensor is {}; take .exr, "
                                     ".png or .csv",
                                     target.string(), projection_name(camera.projection)));
    if (is_cropped)
        throw InputError(fmt::format("{}: a grid has all cells, and those that --crop leaves out would absorb nothing; "
                                     "leave --crop out, or take .exr, which vkvol merge joins",
                                     target.string()));
    check_directory_writable(target);
}

std::string reading_grid(const Film& film, const Camera& camera) {
    const glm::ivec3 cells = camera.cells;
    std::vector<glm::vec3> colors(std::size_t(cells.x) * std::size_t(cells.y) * std::size_t(cells.z));
    std::size_t i = 0;
    for (int y = film.crop.y0; y < film.crop.y1; ++y)
        for (int x = film.crop.x0; x < film.crop.x1; ++x, ++i) {
            const glm::ivec3 cell = camera.cell_of_pixel(x, y);
            colors[(std::size_t(cell.z) * std::size_t(cells.y) + std::size_t(cell.y)) * std::size_t(cells.x) +
                   std::size_t(cell.x)] = film.mean[i];
        }
    const GridPlace place{camera.cell_size(), camera.cell_low({0, 0, 0}) + 0.5 * camera.cell_size()};
    const bool is_grey = std::all_of(colors.begin(), colors.end(),
                                     [](const glm::vec3& color) { return color.x == color.y && color.y == color.z; });
    MemoryGrids grids;
    if (is_grey) {
        std::vector<float> values(colors.size());
        std::transform(colors.begin(), colors.end(), values.begin(), [](const glm::vec3& color) { return color.x; });
        grids.grids.push_back({"absorbed", make_grid("absorbed", cells, values, place)});
    } else {
        grids.grids.push_back({"absorbed", make_grid("absorbed", cells, colors, place)});
    }
    return nvdb_file_of(grids);
}

} // namespace vkvol
