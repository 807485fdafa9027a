// The part of PbrtTranslator that writes media whose densities no file has: grids within the scene, and clouds.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <thread>

#include "pbrt_cloud.h"
#include "pbrt_translator.h"

namespace vkvol {

namespace {

struct Bounds {
    glm::dvec3 low, size;
};

Bounds bounds_of(const PbrtThing& medium) {
    const glm::dvec3 a = medium.parameters->point("p0", glm::dvec3(0.0));
    const glm::dvec3 b = medium.parameters->point("p1", glm::dvec3(1.0));
    const glm::dvec3 size = glm::abs(b - a);
    if (!(std::min({size.x, size.y, size.z}) > 1e-30 && std::max({size.x, size.y, size.z}) < 1e30))
        fail_at(medium.place, fmt::format("medium \"{}\": p0 and p1 enclose nothing, or too much", medium.type));
    return {glm::min(a, b), size};
}

// From places of voxels, whose values are at their middles, to the medium's space.
glm::dmat4 to_medium(const Bounds& bounds, glm::ivec3 dims) {
    const glm::dvec3 voxel = bounds.size / glm::dvec3(dims);
    return glm::scale(glm::translate(glm::dmat4(1.0), bounds.low + 0.5 * voxel), voxel);
}

double number_in(const PbrtThing& medium, const char* name, double fallback, double low, double high) {
    const double number = medium.parameters->number(name, fallback);
    if (!(number >= low && number <= high))
        fail_at(medium.parameters->find(name)->place,
                fmt::format("{} is {:g}; expected {:g} to {:g}", name, number, low, high));
    return number;
}

PbrtCloud cloud_of(const PbrtThing& medium) {
    return {number_in(medium, "density", 1.0, 0.0, 1e6), number_in(medium, "wispiness", 1.0, 0.0, 1e6),
            number_in(medium, "frequency", 5.0, 0.0, 1e6)};
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

std::vector<float> values_of(const PbrtThing& medium, const char* name, glm::ivec3 dims) {
    const std::vector<double> numbers = medium.parameters->numbers(name);
    const std::size_t expected = std::size_t(dims.x) * std::size_t(dims.y) * std::size_t(dims.z);
    if (numbers.size() != expected)
        fail_at(medium.place, fmt::format("medium \"{}\" has {} values of \"{}\"; expected nx ny nz = {}", medium.type,
                                          numbers.size(), name, expected));
    std::vector<float> values;
    values.reserve(expected);
    for (const double number : numbers) {
        if (!(number >= 0.0 && number <= 1e30))
            fail_at(medium.parameters->find(name)->place,
                    fmt::format("\"{}\" has {:g} among its values; expected 0 to 1e30", name, number));
        values.push_back(static_cast<float>(number));
    }
    return values;
}

std::vector<float> values_of(const PbrtCloud& cloud, const glm::dmat4& to_medium, glm::ivec3 dims) {
    const std::size_t layer = std::size_t(dims.x) * std::size_t(dims.y);
    std::vector<float> values(layer * std::size_t(dims.z));
    const int threads = std::max(1, int(std::thread::hardware_concurrency()));
    const auto fill = [&](int first) {
        for (int z = first; z < dims.z; z += threads)
            for (int y = 0; y < dims.y; ++y)
                for (int x = 0; x < dims.x; ++x) {
                    const glm::dvec3 p(to_medium * glm::dvec4(x, y, z, 1.0));
                    values[layer * std::size_t(z) + std::size_t(y) * std::size_t(dims.x) + std::size_t(x)] =
                        static_cast<float>(cloud.at(p));
                }
    };
    std::vector<std::jthread> others;
    for (int i = 1; i < threads; ++i)
        others.emplace_back(fill, i);
    fill(0);
    return values;
}

// A file's name, made of the medium's.
std::string file_stem(const std::string& medium) {
    std::string stem;
    for (const char c : medium.substr(0, 40))
        stem += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' ? c : '_';
    return stem;
}

} // namespace

bool is_dense(const PbrtThing& medium) {
    return medium.type == "uniformgrid" || medium.type == "cloud";
}

// That neither a grid of the scene nor a file of another medium has.
std::string PbrtTranslator::free_name(const std::string& medium) const {
    const std::string stem = options_.grid_prefix + file_stem(medium);
    const auto is_taken = [&](const std::string& name) {
        return grids_.count(name) != 0 || std::any_of(scene_.media.begin(), scene_.media.end(), [&](const auto& other) {
                   return std::filesystem::path(other.second.parameters->text("filename")).filename() == name;
               });
    };
    std::string name = stem + ".nvdb";
    for (int i = 2; is_taken(name); ++i)
        name = fmt::format("{}-{}.nvdb", stem, i);
    return name;
}

void PbrtTranslator::write_dense_medium(const std::string& name, const PbrtThing& medium) {
    const PbrtParameters& p = *medium.parameters;
    const bool is_cloud = medium.type == "cloud";
    const Bounds bounds = bounds_of(medium);
    const double voxel = std::max({bounds.size.x, bounds.size.y, bounds.size.z}) / options_.cloud_voxels;
    const glm::ivec3 dims =
        is_cloud ? glm::max(glm::ivec3(glm::round(bounds.size / voxel)), glm::ivec3(1)) : dims_of(medium);
    const glm::dmat4 place = to_medium(bounds, dims);
    const auto grids = std::make_shared<MemoryGrids>();
    const auto add = [&](const char* grid, const std::vector<float>& values) {
        grids->grids.push_back({grid, make_grid(grid, dims, values)});
    };
    if (is_cloud)
        add("density", values_of(cloud_of(medium), place, dims));
    else
        add("density", values_of(medium, "density", dims));
    const bool burns = !is_cloud && p.has("temperature"), has_scales = !is_cloud && p.has("Lescale");
    if (burns && p.has("Le"))
        fail_at(p.find("Le")->place, "both \"Le\" and \"temperature\"; expected one of them");
    if (burns)
        add("temperature", values_of(medium, "temperature", dims));
    else if (has_scales)
        add("Lescale", values_of(medium, "Lescale", dims));
    const std::string file = free_name(name);
    xml_.open("volume", {{"name", name}}, medium.place.text());
    xml_.element("densityField", {}, file);
    write_matrix(world_ * medium.transform * place);
    write_coefficients(medium);
    if (burns)
        write_black_body("temperature", 1.0, medium);
    else if (const std::optional<glm::dvec3> glow = is_cloud ? std::nullopt : colors_.light(medium, "Le")) {
        XmlAttributes attributes;
        if (has_scales)
            attributes = {{"grid", "Lescale"}, {"model", "color"}};
        add_rgb(attributes, *glow * exposure_);
        xml_.element(has_scales ? "emission" : "medium", attributes);
    }
    if (burns && has_scales)
        note(p.find("Lescale")->place, "\"Lescale\" beside a temperature is left out");
    note_unused(medium, {"type"});
    xml_.close();
    grids_.emplace(file, grids);
}

} // namespace vkvol
