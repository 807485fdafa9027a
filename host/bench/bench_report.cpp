#include "bench_report.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "bench_figures.h"
#include "error.h"
#include "image_io.h"
#include "messages.h"
#include "report.h"
#include "version.h"

namespace vkvol {

namespace {

using Json = nlohmann::ordered_json;

// JSON has no infinity; null stands for it, and for what is not known.
Json number(std::optional<double> value) {
    return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

Json interval_json(const std::optional<Interval>& interval) {
    if (!interval)
        return nullptr;
    return {{"value", number(interval->value)}, {"low", number(interval->low)}, {"high", number(interval->high)}};
}

Json points_json(const Measurement& measurement) {
    Json points = Json::array();
    for (const BenchPoint& point : points_of(measurement.runs))
        points.push_back({{"samples", point.samples},
                          {"runs", point.runs},
                          {"seconds", point.seconds},
                          {"secondsLow", point.seconds_low},
                          {"secondsHigh", point.seconds_high},
                          {"relMse", number(point.relmse)},
                          {"relMseError", number(point.relmse_error)},
                          {"relMseFromVariance", number(point.relmse_from_variance)}});
    return points;
}

Json setup_json(const Measurement& m) {
    return {{"load", m.load_seconds}, {"upload", m.upload_seconds}, {"pipeline", m.pipeline_seconds}};
}

RenderCounts counts_of_all_runs(const Measurement& measurement) {
    RenderCounts sum;
    for (const RenderResult& result : measurement.results) {
        sum.paths += result.counts.paths;
        sum.real_collisions += result.counts.real_collisions;
        sum.null_collisions += result.counts.null_collisions;
        sum.lookups += result.counts.lookups;
        sum.cells += result.counts.cells;
        sum.shadow_rays += result.counts.shadow_rays;
        sum.room += result.counts.room;
        sum.steps += result.counts.steps;
    }
    return sum;
}

Json per_path_json(const RenderCounts& sum) {
    const auto each = [&](std::uint64_t count) {
        return static_cast<double>(count) / static_cast<double>(std::max<std::uint64_t>(1, sum.paths));
    };
    return {{"realCollisions", each(sum.real_collisions)},
            {"nullCollisions", each(sum.null_collisions)},
            {"lookups", each(sum.lookups)},
            {"majorantCells", each(sum.cells)},
            {"shadowRays", each(sum.shadow_rays)}};
}

Json passes_json(const Measurement& measurement) {
    Json passes = Json::object();
    const std::vector<PassFigures>& names = measurement.results.back().passes;
    for (std::size_t pass = 0; pass < names.size(); ++pass)
        passes[names[pass].name] = median_at_largest(measurement, [pass](const RenderResult& r) {
            return pass < r.passes.size() ? r.passes[pass].seconds : 0.0; // interrupted before the first
        });
    return passes;
}

Json estimator_json(const Row& row, const Json& image) {
    const Measurement& measurement = *row.measurement;
    const Figures& figures = row.figures;
    const RenderCounts counts = counts_of_all_runs(measurement);
    return {{"integrator", measurement.estimator.integrator},
            {"sameAs", measurement.estimator.same},
            {"isDefault", measurement.estimator.is_default},
            {"biased", measurement.results.back().biased},
            {"setupSeconds", setup_json(measurement)},
            {"points", points_json(measurement)},
            {"slope", interval_json(figures.slope)},
            {"biasFloor", interval_json(figures.floor)},
            {"efficiency", interval_json(figures.efficiency)},
            {"judged", figures.judged},
            {"noise", number(figures.noise)},
            {"secondsToOnePercent", number(figures.seconds_to_one_percent)},
            {"perPath", per_path_json(counts)},
            {"laneUse", {{"track", counts.lane_use()}}},
            {"passSeconds", passes_json(measurement)},
            {"samplesPerSecond", figures.samples_per_second},
            {"image", image}};
}

std::string processor_name() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (const std::size_t colon = line.find(": "); line.starts_with("model name") && colon != std::string::npos)
            return line.substr(colon + 2);
    return "unknown";
}

std::string date_text() {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
    return text;
}

Json reference_json(const Reference& reference) {
    const auto text = [](const std::string& value) { return value.empty() ? Json(nullptr) : Json(value); };
    return {{"file", text(reference.file)},
            {"integrator", text(reference.integrator)},
            {"samples", reference.samples > 0 ? Json(reference.samples) : Json(nullptr)},
            {"seconds", reference.seconds > 0.0 ? Json(reference.seconds) : Json(nullptr)},
            {"cached", reference.cached},
            {"relMse", number(reference.relmse)}};
}

Json ranking_json(const std::vector<Row>& rows) {
    Json ranking = Json::array();
    for (const Row& row : ranked(rows))
        ranking.push_back({{"integrator", row.measurement->estimator.integrator},
                           {"efficiencyRatioToDefault", interval_json(row.figures.ratio)}});
    return ranking;
}

// Its name in the JSON's folder, or null.
Json write_last(const BenchRequest& request, const Device& device, const Measurement& measurement) {
    RenderRequest as = request.render;
    as.seed = measurement.runs.back().seed;
    RenderResult result = measurement.results.back();
    result.film = measurement.last;
    const std::filesystem::path path = bench_picture(request, measurement.estimator.integrator);
    try {
        std::error_code error;
        std::filesystem::create_directory(path.parent_path(), error); // what is wrong with it, writing says
        write_exr(path, result.film, make_metadata(as, measurement.estimator.scene, device, result));
    } catch (const RenderError& error) {
        tell(stderr, "vkvol: warning: {}\n", error.what());
        return nullptr;
    }
    return (path.parent_path().filename() / path.filename()).string();
}

std::string make_json(const BenchRequest& request, const Device& device, const BenchResult& result) {
    const Picture& picture = result.measurements.front().estimator.scene.picture;
    Json json;
    json["format"] = "vkvol-bench";
    json["version"] = 1;
    json["scene"] = request.render.scene.string();
    json["sceneHash"] = expected_hash(result.measurements.front().estimator);
    json["command"] = request.command;
    json["program"] = std::string("vkvol ") + version;
    json["date"] = date_text();
    json["device"] = {{"name", device.info().name}, {"driver", device.info().driver}, {"api", device.info().api}};
    json["machine"] = {{"processor", processor_name()},
                       {"cores", std::thread::hardware_concurrency()},
                       {"load", {result.load_before, result.load_after}}};
    json["image"] = {{"width", picture.width}, {"height", picture.height}};
    json["budgetSeconds"] = request.seconds;
    json["seed"] = request.render.seed;
    json["interrupted"] = result.interrupted;
    json["reference"] = reference_json(result.reference);
    const std::vector<Row> rows = rows_of(result);
    json["secondsToJudge"] = number(seconds_to_judge(rows, request.seconds));
    json["estimators"] = Json::array();
    for (const Row& row : rows)
        json["estimators"].push_back(estimator_json(row, write_last(request, device, *row.measurement)));
    json["ranking"] = ranking_json(rows);
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string make_csv(const BenchResult& result) {
    std::string csv = "integrator,samples,run,seed,seconds,relMse,relMseFromVariance\n";
    for (const Measurement& measurement : result.measurements) {
        std::map<std::uint32_t, int> runs; // of a count
        for (const BenchRun& run : measurement.runs)
            csv += fmt::format("{},{},{},{},{},{},{}\n", measurement.estimator.integrator, run.samples,
                               ++runs[run.samples], run.seed, run.seconds, run.relmse,
                               run.relmse_from_variance ? fmt::format("{}", *run.relmse_from_variance) : "");
    }
    return csv;
}

} // namespace

std::filesystem::path picture_folder(const BenchRequest& request) {
    return request.name.string() + ".bench";
}

std::filesystem::path bench_picture(const BenchRequest& request, const std::string& integrator) {
    std::string name = integrator;
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c == ':' || c == '='; }, '-');
    return picture_folder(request) / (name + ".exr");
}

void write_bench(const BenchRequest& request, const Device& device, const BenchResult& result) {
    std::string failures, written;
    const auto write = [&](const char* extension, const std::string& text) {
        const std::string name = request.name.string() + extension;
        try {
            write_text(name, text);
            written += (written.empty() ? "; written: " : ", ") + name;
        } catch (const RenderError& error) {
            failures += (failures.empty() ? "" : "; ") + std::string(error.what());
        }
    };
    write(".bench.csv", make_csv(result));
    write(".bench.json", make_json(request, device, result));
    if (!failures.empty())
        throw RenderError(failures + written);
}

} // namespace vkvol
