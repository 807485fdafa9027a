// Every file under scenes/ by its name alone: keys have defaults, and fields are what make_field makes.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <set>
#include <sstream>

#include "scene_xml.h"
#include "support/images.h"
#include "support/shell.h"
#include "support/thorough.h"
#include "test_paths.h"

using namespace vkvol;

namespace {

const std::filesystem::path root = VKVOL_SOURCE_DIR;

std::vector<std::filesystem::path> all_scene_files() {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / "scenes"))
        if (entry.path().extension() == ".xml")
            files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

std::vector<const GridFile*> grids_of(const Scene& scene) {
    std::vector<const GridFile*> grids;
    for (const Volume& volume : scene.volumes)
        if (const GridFile* grid = std::get_if<GridFile>(&volume.shape))
            grids.push_back(grid);
    return grids;
}

std::set<std::string> recipes() {
    std::set<std::string> names;
    std::istringstream list(run("'" VKVOL_MAKE_FIELD "' --list").text);
    for (std::string line; std::getline(list, line);)
        names.insert(line.substr(0, line.find(' ')));
    return names;
}

} // namespace

TEST_CASE("every scene is complete without keys, and names fields that make_field makes", "[cpu][xml]") {
    const std::set<std::string> known = recipes();
    REQUIRE(known.count("cumulus") == 1);
    REQUIRE(all_scene_files().size() > 60);
    for (const std::filesystem::path& file : all_scene_files()) {
        INFO(file.string());
        // Whether its integrator suits depends on what is in the grid; hard_scenes_test.cpp has it.
        if (file.stem() == "13-empty-grid" && !std::filesystem::exists(root / "density_fields/empty.nvdb"))
            continue;
        const Scene scene = load_scene(file);
        for (const GridFile* grid : grids_of(scene)) {
            // There `make_field --all density_fields` puts it.
            CHECK(std::filesystem::weakly_canonical(grid->path.parent_path()) ==
                  std::filesystem::weakly_canonical(root / "density_fields"));
            CHECK(known.count(grid->path.stem().string()) == 1);
            CHECK(grid->path.extension() == ".nvdb");
        }
    }
}

// Those of hard/ have tests of their own. Grids that take long to make, or much memory, are for tools/all_scenes.sh.
TEST_CASE("scenes render by their name alone", "[gpu][image]") {
    std::vector<std::filesystem::path> files;
    for (const std::filesystem::path& file : all_scene_files()) {
        if (file.parent_path().filename() == "hard" || file.filename() == "large_grid.xml")
            continue;
        const Scene scene = load_scene(file);
        const std::vector<const GridFile*> grids = grids_of(scene);
        if (std::all_of(grids.begin(), grids.end(), [](const GridFile* g) { return std::filesystem::exists(g->path); }))
            files.push_back(file);
    }
    REQUIRE(files.size() > 10);
    for (const std::filesystem::path& file : in_turn(files, 0, files.size() / 4)) {
        INFO(file.string());
        Scene scene = load_scene(file);
        scene.settings.spp = 1;
        resize_picture(scene.picture, 16, std::nullopt);
        const Film film = render_here(scene, 1).film;
        CHECK(std::all_of(film.samples.begin(), film.samples.end(), [](std::uint32_t n) { return n == 1; }));
    }
}
