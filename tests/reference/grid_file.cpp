#include <nanovdb/util/IO.h>

#include "grid.h"

#include <stdexcept>

namespace reference {

namespace {

// `channel`: turns what the grid holds into a number.
template <typename Build, typename Channel> Grid decode(const nanovdb::NanoGrid<Build>& grid, const Channel& channel) {
    const nanovdb::Map& map = grid.map();
    const auto image = [&](double x, double y, double z) {
        const nanovdb::Vec3d p = map.applyMap(nanovdb::Vec3d(x, y, z));
        return glm::dvec3(p[0], p[1], p[2]);
    };
    const glm::dvec3 zero = image(0, 0, 0);
    const glm::dmat3 linear(image(1, 0, 0) - zero, image(0, 1, 0) - zero, image(0, 0, 1) - zero);

    glm::ivec3 first(0), last(-1);
    if (grid.activeVoxelCount() > 0) {
        const auto& box = grid.indexBBox();
        first = {box.min()[0], box.min()[1], box.min()[2]};
        last = {box.max()[0], box.max()[1], box.max()[2]};
    }
    auto accessor = grid.getAccessor();
    const auto value = [&](glm::ivec3 i) { return channel(accessor.getValue(nanovdb::Coord(i.x, i.y, i.z))); };
    return make_grid(first, last, value, linear, zero);
}

template <typename Build> Grid decode(const nanovdb::NanoGrid<Build>& grid) {
    return decode(grid, [](float value) { return value; });
}

nanovdb::GridHandle<> read(const std::filesystem::path& path, const std::string& name) {
    if (path.extension() != ".nvdb" && path.extension() != ".NVDB")
        throw std::runtime_error(path.string() + ": the reference reads .nvdb files only");
    auto handle = nanovdb::io::readGrid(path.string(), name);
    if (!handle)
        throw std::runtime_error(path.string() + ": no grid named \"" + name + "\"");
    return handle;
}

} // namespace

bool has_colors(const std::filesystem::path& path, const std::string& name) {
    return read(path, name).grid<nanovdb::Vec3f>() != nullptr;
}

ColorGrid load_color_grid(const std::filesystem::path& path, const std::string& name) {
    const auto handle = read(path, name);
    ColorGrid colors;
    for (int c = 0; c < 3; ++c)
        if (const auto* grid = handle.grid<nanovdb::Vec3f>())
            colors.channels[c] = decode(*grid, [c](const nanovdb::Vec3f& color) { return color[c]; });
        else
            colors.channels[c] = load_grid(path, name);
    return colors;
}

bool has_grid(const std::filesystem::path& path, const std::string& name) {
    return nanovdb::io::hasGrid(path.string(), name);
}

Grid load_grid(const std::filesystem::path& path, const std::string& name) {
    const auto handle = read(path, name);
    if (const auto* grid = handle.grid<float>())
        return decode(*grid);
    if (const auto* grid = handle.grid<nanovdb::Fp4>())
        return decode(*grid);
    if (const auto* grid = handle.grid<nanovdb::Fp8>())
        return decode(*grid);
    if (const auto* grid = handle.grid<nanovdb::Fp16>())
        return decode(*grid);
    if (const auto* grid = handle.grid<nanovdb::FpN>())
        return decode(*grid);
    throw std::runtime_error(path.string() + ": grid \"" + name + "\" holds no scalar density");
}

} // namespace reference
