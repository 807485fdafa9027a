// The part of PbrtTranslator that writes media whose densities no file has: grids within the scene, and clouds.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <thread>

#include "blackbody.h"
#include "pbrt_cloud.h"
#include "pbrt_translator.h"
#include "pbrt_voxels.h"

namespace vkvol {

namespace {

constexpr double most_finer_voxels = 4e6;
constexpr int black_bodies = 4096; // in a table of their colours

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

std::vector<float> values_of(const PbrtThing& medium, const char* name, glm::ivec3 dims, double least = 0.0) {
    const std::vector<double> numbers = medium.parameters->numbers(name);
    const std::size_t expected = voxel_count(dims);
    if (numbers.size() != expected)
        fail_at(medium.place, fmt::format("medium \"{}\" has {} values of \"{}\"; expected nx ny nz = {}", medium.type,
                                          numbers.size(), name, expected));
    std::vector<float> values;
    values.reserve(expected);
    for (const double number : numbers) {
        if (!(number >= least && number <= 1e30))
            fail_at(medium.parameters->find(name)->place,
                    fmt::format("\"{}\" has {:g} among its values; expected {:g} to 1e30", name, number, least));
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

// Where a scene says nothing of Le's scale pbrt takes a grid of one value, 1 in the middle of the box, which falls to 0
// at the middles of its neighbours: to half at the faces. `at`: in voxels, from the middle of the first one.
double usual_scale(const glm::dvec3& at, glm::ivec3 dims) {
    const glm::dvec3 along = 1.0 - glm::abs((at + 0.5) / glm::dvec3(dims) - 0.5);
    return along.x * along.y * along.z;
}

// `value(x, y, z)` of each voxel, x fastest.
template <class Value> auto of_voxels(glm::ivec3 dims, const Value& value) {
    std::vector<decltype(value(0, 0, 0))> values;
    values.reserve(voxel_count(dims));
    for (int z = 0; z < dims.z; ++z)
        for (int y = 0; y < dims.y; ++y)
            for (int x = 0; x < dims.x; ++x)
                values.push_back(value(x, y, z));
    return values;
}

// Voxels up to twelve times finer, with one more all about, where what is beyond the box falls to 0: for what bends
// between the voxels of `dims`.
struct FinerGrid {
    FinerGrid(glm::ivec3 of, double most) {
        const int finer =
            std::clamp(int(std::cbrt(std::min(most, most_finer_voxels) / double(voxel_count(of)))), 1, 12);
        dims = of * finer + 2;
        place = {glm::dvec3(1.0 / finer), glm::dvec3(0.5 / finer - 0.5 - 1.0 / finer)};
    }
    // In those of `of`, from the middle of the first.
    glm::dvec3 at(int x, int y, int z) const { return place.origin + glm::dvec3(x, y, z) * place.voxel_size; }

    glm::ivec3 dims;
    GridPlace place;
};

// Linear between the middles of voxels, and 0 beyond their neighbours, as pbrt's grids are.
double between_voxels(const std::vector<float>& values, glm::ivec3 dims, const glm::dvec3& at) {
    const glm::ivec3 first(glm::floor(at));
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 step(corner & 1, corner >> 1 & 1, corner >> 2), voxel = first + step;
        if (glm::any(glm::lessThan(voxel, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(voxel, dims)))
            continue;
        const glm::dvec3 part = 1.0 - glm::abs(at - glm::dvec3(voxel));
        const std::size_t place = (std::size_t(voxel.z) * dims.y + voxel.y) * dims.x + voxel.x;
        sum += part.x * part.y * part.z * double(values[place]);
    }
    return sum;
}

// Two and a half for a cell of the cloud's finest noise, at least 64 along the longest edge, and no more in all than
// `most`. `is_coarse`: these are less than two for a cell.
glm::ivec3 cloud_dims(const PbrtCloud& cloud, const PbrtBounds& bounds, double most, bool& is_coarse) {
    constexpr double finest = 1.99 * 1.99 * 1.99 * 1.99;
    const double longest = std::max({bounds.size.x, bounds.size.y, bounds.size.z});
    const double cells = cloud.frequency * finest * longest;
    const glm::dvec3 shape = bounds.size / longest;
    const auto dims_of = [&](double along) { return glm::max(glm::ivec3(glm::round(shape * along)), glm::ivec3(1)); };
    const auto fits = [&](double along) {
        const glm::dvec3 dims(dims_of(along));
        return dims.x * dims.y * dims.z <= most;
    };
    double along = std::clamp(2.5 * cells, 64.0, 4096.0);
    while (along > 1.0 && !fits(along))
        along *= 0.98;
    is_coarse = along < 2.0 * cells;
    return dims_of(along);
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
    return medium.type == "uniformgrid" || medium.type == "rgbgrid" || medium.type == "cloud";
}

// That neither a grid of the scene nor a file of another medium has.
std::string PbrtTranslator::free_name(const std::string& medium) const {
    const std::string prefix = options_.grid_stem.empty() ? "" : file_stem(options_.grid_stem) + "_";
    const std::string stem = prefix + file_stem(medium);
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

// pbrt looks up the temperature and Le's scale apart, and multiplies the black body by the scale. Here that is a grid
// of colours, of finer voxels, since it bends between those of the two; it has one more about the box, where they fall
// to 0.
MemoryGrids::Grid PbrtTranslator::glow_of(const PbrtThing& medium, glm::ivec3 dims) {
    const PbrtParameters& p = *medium.parameters;
    const std::vector<float> temperatures = values_of(medium, "temperature", dims, -1e30); // degrees, say
    const std::vector<float> scales =
        p.has("Lescale") ? values_of(medium, "Lescale", dims, -1e30) : std::vector<float>{};
    const glm::dvec2 kelvin = kelvins(medium);
    const auto [coldest, hottest] = std::minmax_element(temperatures.begin(), temperatures.end());
    const double most = std::max({kelvin.x * *coldest + kelvin.y, kelvin.x * *hottest + kelvin.y, 2.0 * least_kelvin});
    const std::vector<glm::vec4> colors = make_blackbody_table(least_kelvin, most, 0.0, black_bodies);
    const FinerGrid finer(dims, options_.most_cloud_voxels);
    const std::vector<glm::vec3> glow = of_voxels(finer.dims, [&](int x, int y, int z) {
        const glm::dvec3 at = finer.at(x, y, z);
        const double scale = scales.empty() ? usual_scale(at, dims) : between_voxels(scales, dims, at);
        const double here = kelvin.x * between_voxels(temperatures, dims, at) + kelvin.y;
        if (!(here > least_kelvin && scale > 0.0))
            return glm::vec3(0.0f);
        const double along = (here - least_kelvin) / (most - least_kelvin) * (black_bodies - 1);
        const int node = std::min(int(along), black_bodies - 2);
        return float(scale) * glm::vec3(glm::mix(colors[node], colors[node + 1], float(along - node)));
    });
    note(p.find("temperature")->place,
         fmt::format("what glows by its temperature is a grid of {} x {} x {} colours here", finer.dims.x, finer.dims.y,
                     finer.dims.z));
    return {"glow", make_grid("glow", finer.dims, glow, finer.place)};
}

std::vector<float> PbrtTranslator::scales_of(const PbrtThing& medium, glm::ivec3 dims) {
    std::vector<float> values = values_of(medium, "Lescale", dims, -1e30);
    if (std::any_of(values.begin(), values.end(), [](float value) { return value < 0.0f; }))
        note(medium.parameters->find("Lescale")->place,
             "values below 0 are 0 here; pbrt's glow ends a little before them");
    for (float& value : values)
        value = std::max(value, 0.0f);
    return values;
}

void PbrtTranslator::write_dense_medium(const std::string& name, const PbrtThing& medium) {
    if (medium.type == "rgbgrid")
        return write_rgb_medium(name, medium);
    const PbrtParameters& p = *medium.parameters;
    const bool is_cloud = medium.type == "cloud";
    const PbrtBounds bounds = bounds_of(medium);
    bool is_coarse = false;
    const glm::ivec3 dims =
        is_cloud ? cloud_dims(cloud_of(medium), bounds, options_.most_cloud_voxels, is_coarse) : dims_of(medium);
    if (is_coarse)
        note(medium.place,
             fmt::format("the cloud's finest noise is finer than its grid of {} x {} x {} voxels, which is "
                         "the largest: that part of it is smoothed",
                         dims.x, dims.y, dims.z));
    const glm::dmat4 place = voxels_to_medium(bounds, dims);
    const auto grids = std::make_shared<MemoryGrids>();
    const auto add = [&](const char* grid, const std::vector<float>& values) {
        grids->grids.push_back({grid, make_grid(grid, dims, values)});
    };
    const FinerGrid finer(dims, options_.most_cloud_voxels);
    const std::vector<float> densities =
        is_cloud ? values_of(cloud_of(medium), place, dims) : values_of(medium, "density", dims);
    add("density", densities);
    if (!is_cloud && has_soft_edge(dims, densities))
        note(medium.place, soft_edge_note);
    const bool burns = !is_cloud && p.has("temperature"), has_scales = !is_cloud && p.has("Lescale");
    if (burns && p.has("Le"))
        fail_at(p.find("Le")->place, "both \"Le\" and \"temperature\"; expected one of them");
    if (burns)
        grids->grids.push_back(glow_of(medium, dims));
    else if (has_scales)
        add("Lescale", scales_of(medium, dims));
    else if (!is_cloud && p.has("Le"))
        grids->grids.push_back({"Lescale", make_grid("Lescale", finer.dims,
                                                     of_voxels(finer.dims,
                                                               [&](int x, int y, int z) {
                                                                   return float(usual_scale(finer.at(x, y, z), dims));
                                                               }),
                                                     finer.place)});
    const std::string file = free_name(name);
    xml_.open("volume", {{"name", name}}, medium.place.text());
    xml_.element("densityField", {}, file);
    write_matrix(world_ * medium.transform * place);
    write_coefficients(medium);
    if (burns) {
        XmlAttributes attributes = {{"grid", "glow"}, {"model", "color"}};
        add_rgb(attributes, glm::dvec3(exposure_));
        xml_.element("emission", attributes);
    } else if (const std::optional<glm::dvec3> glow = is_cloud ? std::nullopt : colors_.light(medium, "Le")) {
        XmlAttributes attributes = {{"grid", "Lescale"}, {"model", "color"}};
        add_rgb(attributes, *glow * exposure_);
        xml_.element("emission", attributes);
    }
    note_unused(medium, {"type"});
    xml_.close();
    grids_.emplace(file, grids);
}

} // namespace vkvol
