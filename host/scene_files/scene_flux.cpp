// The part of SceneReader that reads sensors of flux, which stand in the place of the camera.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "camera_view.h"
#include "number_table.h"
#include "scene_places.h"
#include "scene_reader.h"

namespace vkvol {

namespace {

std::vector<glm::dvec3> triples(const std::vector<double>& numbers) {
    std::vector<glm::dvec3> points;
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3)
        points.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
    return points;
}

std::vector<glm::dvec3> read_points(const std::filesystem::path& file) {
    const NumberTable table = read_number_table(file, {"<fluence> names a text file of points, a line \"x y z\" each",
                                                       "a line is a point, \"x y z\"", 3, 3, 1u << 24, true});
    for (std::size_t i = 0; i < table.numbers.size(); ++i)
        if (std::abs(table.numbers[i]) > largest_length)
            fail_line(file, table.lines[i / 3],
                      fmt::format("{:g} is out of range; expected {}", table.numbers[i], coordinate.expected));
    return triples(table.numbers);
}

} // namespace

// Where it stands, and the side it faces; lookAt as of lights.
Camera SceneReader::irradiance(const XmlElement& element) const {
    element.allow({"x", "y", "z", "lookAt", "up", "width", "height"});
    Camera camera;
    camera.projection = Projection::irradiance;
    for (int axis = 0; axis < 3; ++axis) {
        const char* const names[] = {"x", "y", "z"};
        camera.position[axis] = element.attribute_number(names[axis], 0.0, coordinate);
    }
    if (!element.has("lookAt"))
        element.fail("<irradiance> needs lookAt=\"x y z\", a point on the side from which it reads light");
    const glm::dvec3 forward = triple(element, "lookAt", coordinate) - camera.position;
    if (forward == glm::dvec3(0.0))
        element.fail_attribute("lookAt", "<irradiance> lookAt: is where the sensor is; move one of them");
    look_along(camera, forward, axes_facing(element, vkvol::unit(forward))[1]);
    camera.size = {element.attribute_number("width", 1.0, length), element.attribute_number("height", 1.0, length)};
    return camera;
}

Camera SceneReader::fluence(const XmlElement& element) const {
    element.allow({"file", "baseDir"}, true);
    Camera camera;
    camera.projection = Projection::fluence;
    const std::string name = element.attribute("file");
    if (name.empty() == element.text().empty())
        element.fail("<fluence> needs points, \"x y z\" of each between the tags, or the name of their file in file; "
                     "one of the two");
    if (!name.empty()) {
        camera.points_file = file_path(element, name);
        camera.points = read_points(camera.points_file);
    } else {
        const std::vector<double> numbers = element.text_numbers(coordinate);
        if (numbers.size() % 3 != 0)
            element.fail_text(fmt::format("<fluence> has {} numbers; every point has three, x y z", numbers.size()));
        camera.points = triples(numbers);
    }
    if (camera.points.empty())
        element.fail(fmt::format("<fluence>: {} holds no points; write one to a line, \"x y z\"", name));
    camera.position = camera.points.front();
    return camera;
}

// A box, as of a medium, in cells.
Camera SceneReader::absorption(const XmlElement& element) const {
    element.allow({"x", "y", "z", "width", "height", "depth", "cells"});
    Camera camera;
    camera.projection = Projection::absorption;
    const char* const places[] = {"x", "y", "z"};
    const char* const edges[] = {"width", "height", "depth"};
    for (int axis = 0; axis < 3; ++axis) {
        camera.position[axis] = element.attribute_number(places[axis], 0.0, coordinate);
        camera.edges[axis] = element.attribute_number(edges[axis], 1.0, length);
    }
    if (!element.has("cells"))
        return camera;
    const glm::dvec3 cells = triple(element, "cells", any_number);
    if (glm::any(glm::lessThan(cells, glm::dvec3(1.0))) || cells != glm::floor(cells) || cells.x > max_edge ||
        cells.y * cells.z > max_edge)
        element.fail_attribute("cells",
                               fmt::format("<absorption> cells: expected three whole numbers from 1 on, along x, y "
                                           "and z, of which the first, and the product of the others, is at most "
                                           "{}, e.g. cells=\"64 32 64\"",
                                           max_edge));
    camera.cells = cells;
    return camera;
}

// Slices across z, one above the other, the first uppermost; in each, y goes up.
Picture SceneReader::picture_of_cells(const Camera& camera) const {
    for (const char* name : {"width", "height"})
        if (const XmlElement element = one(name); element.exists())
            element.fail(fmt::format("<{}>: <absorption> has a pixel for each of its cells; remove it", name));
    Picture picture;
    picture.width = camera.cells.x;
    picture.height = camera.cells.y * camera.cells.z;
    picture.reference_width = picture.width;
    picture.reference_height = picture.height;
    return picture;
}

// A pixel each: in rows as wide as <width> says, or in one.
Picture SceneReader::picture_of_points(const Camera& camera) const {
    const auto count = static_cast<long long>(camera.points.size());
    const XmlElement width = one("width"), height = one("height");
    for (const XmlElement& element : {width, height}) {
        element.allow({"startOffset", "reference"}, true);
        for (const char* name : {"startOffset", "reference"})
            if (element.has(name))
                element.fail_attribute(name, fmt::format("<{}> {}: <fluence> has a pixel for each point, and no frame; "
                                                         "remove it",
                                                         element.name(), name));
    }
    const long long rows = height.integer(0, 1, max_edge);
    const long long columns = width.integer(rows > 0 ? std::max(count / rows, 1ll) : count, 1, 1ll << 24);
    if (columns > max_edge || count % columns != 0 || (rows > 0 && rows * columns != count) ||
        count / columns > max_edge)
        (width.exists()    ? width
         : height.exists() ? height
                           : one("fluence"))
            .fail(fmt::format("{} points do not fill rows of {}{}; give a <width> of which their number is a multiple, "
                              "at most {}",
                              count, columns, rows > 0 ? fmt::format(" by {}", rows) : "", max_edge));
    Picture picture;
    picture.width = static_cast<int>(columns);
    picture.height = static_cast<int>(count / columns);
    picture.reference_width = picture.width;
    picture.reference_height = picture.height;
    return picture;
}

} // namespace vkvol
