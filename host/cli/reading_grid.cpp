#include "reading_grid.h"

#include <fmt/format.h>

#include "camera_view.h"
#include "error.h"
#include "file_ending.h"
#include "image_io.h"
#include "vdb_export.h"

namespace vkvol {

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

std::string reading_grid(const Film& film, const Camera& camera, const std::filesystem::path& target) {
    const glm::ivec3 cells = camera.cells;
    const GridPlace place{camera.cell_size(), camera.cell_low({0, 0, 0}) + 0.5 * camera.cell_size()};
    const std::vector<glm::vec3> nothing(std::size_t(cells.x) * std::size_t(cells.y) * std::size_t(cells.z));
    std::vector<BoxGrid> grids{{"absorbed", cells, nothing, place}, {"absorbed_error", cells, nothing, place}};
    bool has_errors = true;
    std::size_t i = 0;
    for (int y = film.crop.y0; y < film.crop.y1; ++y)
        for (int x = film.crop.x0; x < film.crop.x1; ++x, ++i) {
            const glm::ivec3 cell = camera.cell_of_pixel(x, y);
            const std::size_t at =
                (std::size_t(cell.z) * std::size_t(cells.y) + std::size_t(cell.y)) * std::size_t(cells.x) +
                std::size_t(cell.x);
            grids[0].colors[at] = film.mean[i];
            grids[1].colors[at] = glm::sqrt(film.variance[i]);
            has_errors = has_errors && film.samples[i] > 1;
        }
    if (!has_errors)
        grids.pop_back();
    return file_ending(target) == ".vdb" ? vdb_file_of(grids) : nvdb_file_of(grids);
}

} // namespace vkvol
