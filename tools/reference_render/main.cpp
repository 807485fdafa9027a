// Renders a scene file with the scalar reference of tests/reference: slow, simple, in double precision.
#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "error.h"
#include "image_io.h"
#include "scene_xml.h"
#include "tests/reference/reference.h"

namespace {

struct Arguments {
    std::filesystem::path scene, output = "reference.exr";
    std::optional<std::filesystem::path> report;
    std::optional<std::uint32_t> spp;
    std::uint32_t seed = 0, sample_offset = 0;
    unsigned threads = std::max(1u, std::thread::hardware_concurrency());
    std::optional<int> width, height;
    std::vector<int> crop; // x0, x1, y0, y1
    std::optional<std::string> integrator;
    std::optional<std::filesystem::path> grid;
    vkvol::Defines defines;
};

void parse(CLI::App& app, Arguments& arguments, int argc, char** argv) {
    std::vector<std::string> defines;
    app.add_option("scene", arguments.scene, "scene file")->required();
    app.add_option("-o", arguments.output, "image to write (.exr)")->capture_default_str();
    app.add_option("--report", arguments.report,
                   "the picture's mean and its standard error as JSON, as vkvol --report");
    app.add_option("--spp", arguments.spp, "samples per pixel, instead of the scene's");
    app.add_option("--seed", arguments.seed, "seed of the random numbers; compare renders of different seeds")
        ->capture_default_str();
    app.add_option("--sample-offset", arguments.sample_offset, "number of the first sample")->capture_default_str();
    app.add_option("--threads", arguments.threads, "threads to render with")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    app.add_option("--width", arguments.width, "pixels, the same view")->check(CLI::Range(1, 65535));
    app.add_option("--height", arguments.height, "pixels, the same view")->check(CLI::Range(1, 65535));
    app.add_option("--crop", arguments.crop, "x0,x1,y0,y1: render these pixels of the picture alone")
        ->delimiter(',')
        ->expected(4);
    app.add_option("--integrator", arguments.integrator, "instead of the scene's");
    app.add_option("--grid", arguments.grid, "density field (.nvdb), instead of the scene's");
    app.add_option("-D", defines, "key=value for $key in the scene; repeatable")->allow_extra_args(false);
    app.parse(argc, argv);
    for (const std::string& define : defines) {
        const auto equals = define.find('=');
        if (equals == std::string::npos)
            throw vkvol::InputError("-D " + define + ": expected key=value");
        arguments.defines[define.substr(0, equals)] = define.substr(equals + 1);
    }
}

reference::World open_world(const Arguments& arguments) {
    vkvol::Scene scene = vkvol::load_scene(arguments.scene, arguments.defines, {arguments.grid, arguments.integrator});
    for (const std::string& warning : scene.warnings)
        std::fprintf(stderr, "%s\n", warning.c_str());
    vkvol::resize_picture(scene.picture, arguments.width, arguments.height);
    if (arguments.spp)
        scene.settings.spp = *arguments.spp;
    return reference::load_world(scene);
}

vkvol::Crop window(const Arguments& arguments, const vkvol::Picture& picture) {
    if (arguments.crop.empty())
        return {0, picture.width, 0, picture.height};
    return {arguments.crop[0], arguments.crop[1], arguments.crop[2], arguments.crop[3]};
}

void report(const std::filesystem::path& path, const vkvol::ImageMean& mean) {
    nlohmann::ordered_json json{{"mean", {{"value", {mean.value.x, mean.value.y, mean.value.z}}}}};
    if (const auto& error = mean.standard_error)
        json["mean"]["standardError"] = {error->x, error->y, error->z};
    else
        json["mean"]["standardError"] = nullptr;
    std::ofstream file(path);
    file << json << '\n';
    if (!file.flush())
        throw vkvol::InputError(path.string() +
                                ": cannot be written; does the folder exist, with room and permission?");
}

void run(const Arguments& arguments) {
    const reference::World world = open_world(arguments);
    const vkvol::Crop crop = window(arguments, world.scene.picture);
    const std::uint32_t spp = world.scene.settings.spp;

    const auto start = std::chrono::steady_clock::now();
    const vkvol::Film film =
        reference::render(world, crop, spp, arguments.seed, arguments.threads, arguments.sample_offset);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

    vkvol::write_exr(arguments.output, film,
                     {{"Software", std::string("vkvol reference_render")},
                      {"vkvol/integrator", world.method.name},
                      {"vkvol/spp", static_cast<int>(spp)},
                      {"vkvol/seed", static_cast<int>(arguments.seed)}});
    const vkvol::ImageMean mean = vkvol::image_mean(film);
    if (arguments.report)
        report(*arguments.report, mean);
    const double paths = static_cast<double>(film.pixel_count()) * spp;
    std::printf("%s: %u spp, %.2f s on %u threads, %.0f paths/s\n", arguments.output.c_str(), spp, seconds,
                arguments.threads, paths / seconds);
    std::printf("mean %.7g %.7g %.7g", mean.value.x, mean.value.y, mean.value.z);
    if (const auto& error = mean.standard_error)
        std::printf(", standard error %.3g %.3g %.3g", error->x, error->y, error->z);
    std::printf("\n");
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app{"Renders a scene with the scalar double-precision reference", "reference_render"};
    Arguments arguments;
    try {
        parse(app, arguments, argc, argv);
        run(arguments);
        return vkvol::exit_done;
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? vkvol::exit_done : vkvol::exit_bad_input;
    } catch (const vkvol::RenderError& error) {
        std::fprintf(stderr, "error: %s\n", error.what());
        return vkvol::exit_render_failed;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "error: %s\n", error.what());
        return vkvol::exit_bad_input;
    }
}
