// The bench: its statistics on data whose figures are known, its schedule, and the command as its users run it.
#include <catch2/catch.hpp>

#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <sstream>
#include <sys/wait.h>
#include <unistd.h>

#include "bench.h"
#include "bench_schedule.h"
#include "error.h"
#include "image_io.h"
#include "student_t.h"

using namespace vkvol;
using Catch::Contains;

namespace {

// Counts as a bench has them: three runs of the small ones, six of the largest.
std::vector<std::uint32_t> counts() {
    std::vector<std::uint32_t> list;
    for (const std::uint32_t samples : {1u, 2u, 4u, 8u, 16u, 32u})
        list.insert(list.end(), samples < 8 ? 3 : 1, samples);
    list.insert(list.end(), 6, 64u);
    return list;
}

// relMSE = floor + 1 / samples and a second a sample, both exactly or with the scatter that `noise` adds.
std::vector<BenchRun> runs_of(double floor, const std::function<double(std::uint32_t)>& noise = {}) {
    std::vector<BenchRun> runs;
    for (const std::uint32_t samples : counts()) {
        const double own = 1.0 / samples;
        const double relmse = floor + own + (noise ? noise(samples) : 0.0);
        runs.push_back({samples, 0, double(samples), relmse, samples > 1 ? std::optional(own) : std::nullopt});
    }
    return runs;
}

bool holds(const std::optional<Interval>& interval, double truth) {
    return interval && interval->low <= truth && truth <= interval->high;
}

// That 95 % intervals hold the truth in 95 % of trials. Hits are binomial: four standard deviations are exceeded by
// chance once in 16000 times, and the seed is fixed.
void check_coverage(const std::function<bool()>& trial) {
    constexpr int trials = 4000;
    int hits = 0;
    for (int i = 0; i < trials; ++i)
        hits += trial() ? 1 : 0;
    CHECK(std::abs(hits - 0.95 * trials) <= 4.0 * std::sqrt(trials * 0.95 * 0.05));
}

Film flat_film(int edge, float value, std::uint32_t samples, float variance) {
    Film film;
    film.picture_width = film.picture_height = edge;
    film.crop = {0, edge, 0, edge};
    const auto pixels = std::size_t(edge) * std::size_t(edge);
    film.mean.assign(pixels, glm::vec3(value));
    film.variance.assign(pixels, glm::vec3(variance));
    film.samples.assign(pixels, samples);
    return film;
}

// Every channel of every pixel: the mean of `samples` uniform numbers in [0, 2], and its estimated variance.
Film random_film(std::mt19937_64& random, int edge, std::uint32_t samples) {
    Film film = flat_film(edge, 0.0f, samples, 0.0f);
    std::uniform_real_distribution<double> uniform(0.0, 2.0);
    for (std::size_t i = 0; i < film.pixel_count(); ++i)
        for (int c = 0; c < 3; ++c) {
            double sum = 0.0, squares = 0.0;
            for (std::uint32_t k = 0; k < samples; ++k) {
                const double x = uniform(random);
                sum += x;
                squares += x * x;
            }
            const double n = samples;
            film.mean[i][c] = float(sum / n);
            film.variance[i][c] = n > 1 ? float((squares - sum * sum / n) / (n * (n - 1))) : 0.0f;
        }
    return film;
}

} // namespace

TEST_CASE("Student's t has the quantiles of its table", "[cpu][bench]") {
    for (const auto& [freedom, t] :
         {std::pair{1.0, 12.7062}, {2.0, 4.3027}, {5.0, 2.5706}, {10.0, 2.2281}, {30.0, 2.0423}, {1e7, 1.9600}}) {
        CAPTURE(freedom);
        CHECK(std::abs(student_t95(freedom) - t) < 6e-5); // the table's rounding
    }
}

TEST_CASE("a pure decay has slope -1, no floor, and the efficiency it was made with", "[cpu][bench]") {
    const std::vector<BenchRun> runs = runs_of(0.0);
    // Without scatter nothing but the rounding of logarithms and sums is left, about 1e-15 each.
    CHECK(std::abs(error_slope(runs)->value + 1.0) < 1e-12);
    CHECK(std::abs(bias_floor(runs, 0.0)->value) < 1e-12);
    CHECK(std::abs(efficiency(runs)->value - 1.0) < 1e-12);
    CHECK(std::abs(efficiency_ratio(runs, runs)->value - 1.0) < 1e-12);
    CHECK(std::abs(*seconds_to(1e-4, *efficiency(runs), std::nullopt) - 1e4) < 1e-6);
    CHECK(bias_floor(runs, 0.25)->high == Approx(1.959964 * 0.25));
}

TEST_CASE("a floor is found, flattens the slope, and forbids errors below it", "[cpu][bench]") {
    const std::vector<BenchRun> runs = runs_of(0.02);
    const Interval floor = *bias_floor(runs, 0.0);
    CHECK(std::abs(floor.value - 0.02) < 1e-12);
    CHECK(error_slope(runs)->high > -0.9); // at 64 samples more than half of the error is the floor
    const Interval one{1.0, 1.0, 1.0};
    CHECK_FALSE(seconds_to(0.02, one, Interval{0.03, 0.02, 0.04}));
    CHECK(*seconds_to(0.02, one, Interval{0.01, 0.005, 0.015}) == Approx(100.0));
    CHECK(*seconds_to(0.02, one, Interval{0.01, -0.005, 0.025}) == Approx(50.0)); // may as well be none
}

TEST_CASE("figures without meaning are not made", "[cpu][bench]") {
    const std::vector<BenchRun> one = {{1, 0, 1.0, 1.0, std::nullopt}};
    CHECK_FALSE(error_slope(one));
    CHECK_FALSE(bias_floor(one, 0.0));
    CHECK_FALSE(efficiency(one));
    std::vector<BenchRun> same(5, BenchRun{4, 0, 1.0, 0.5, 0.5});
    CHECK_FALSE(error_slope(same)); // one count has no slope
    CHECK(bias_floor(same, 0.0));
    same[2].relmse = -0.1;
    CHECK_FALSE(efficiency(same));
}

// Each with the scatter that its docstring assumes, where Student's t is exact.
TEST_CASE("95 % intervals hold the truth in 95 % of benches", "[cpu][bench]") {
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    SECTION("slope: log relMSE with variance 0.04 / samples") {
        check_coverage([&] {
            std::vector<BenchRun> runs = runs_of(0.0);
            for (BenchRun& run : runs)
                run.relmse *= std::exp(0.2 / std::sqrt(double(run.samples)) * normal(random));
            return holds(error_slope(runs), -1.0);
        });
    }
    SECTION("floor: differences with variance in proportion to 1 / (n (n - 1))") {
        check_coverage([&] {
            const auto noise = [&](std::uint32_t n) { return 0.3 / std::sqrt(n * (n - 0.999)) * normal(random); };
            return holds(bias_floor(runs_of(0.01, noise), 0.0), 0.01);
        });
    }
    SECTION("efficiency: log relMSE with equal variance, equal seconds") {
        check_coverage([&] {
            std::vector<BenchRun> runs(6, BenchRun{4, 0, 2.0, 0.0, std::nullopt});
            for (BenchRun& run : runs)
                run.relmse = std::exp(0.3 * normal(random));
            return holds(efficiency(runs), 0.5);
        });
    }
    SECTION("ratio of efficiencies: likewise, and Welch's t is exact for equal variances and counts") {
        check_coverage([&] {
            std::vector<BenchRun> a(6, BenchRun{4, 0, 1.0, 0.0, std::nullopt}), b = a;
            for (std::size_t i = 0; i < a.size(); ++i) {
                a[i].relmse = std::exp(0.3 * normal(random));
                b[i].relmse = 2.0 * std::exp(0.3 * normal(random));
            }
            return holds(efficiency_ratio(a, b), 2.0);
        });
    }
}

// Where relMSE scatters alike at all counts, the weights are not the best, but the intervals err on the safe side.
TEST_CASE("scatter that does not fall with samples makes slope and efficiency no surer than they are", "[cpu][bench]") {
    std::mt19937_64 random(11);
    std::normal_distribution<double> normal;
    constexpr int trials = 4000;
    int slopes = 0, efficiencies = 0;
    for (int i = 0; i < trials; ++i) {
        std::vector<BenchRun> runs = runs_of(0.0);
        for (BenchRun& run : runs)
            run.relmse *= std::exp(0.05 * normal(random));
        slopes += holds(error_slope(runs), -1.0) ? 1 : 0;
        efficiencies += holds(efficiency(runs), 1.0) ? 1 : 0;
    }
    const double least = 0.95 * trials - 4.0 * std::sqrt(trials * 0.95 * 0.05);
    CHECK(slopes >= least);
    CHECK(efficiencies >= least);
}

TEST_CASE("relMSE against a noisy reference has the expectation of that against the truth", "[cpu][bench]") {
    // Uniform numbers in [0, 2]: mean 1, variance 1/3. Image of 4 samples, reference of 32.
    constexpr int edge = 16, trials = 40;
    const double expected = 1.0 / 3.0 / 4.0 / 1.01;
    std::mt19937_64 random(3);
    double sum = 0.0, squares = 0.0, predicted = 0.0;
    for (int i = 0; i < trials; ++i) {
        const Film reference = random_film(random, edge, 32);
        const Film image = random_film(random, edge, 4);
        const double value = relative_mse(image, reference);
        sum += value / trials;
        squares += value * value / trials;
        predicted += relative_variance(image, reference) / trials;
    }
    const double error = std::sqrt((squares - sum * sum) / (trials - 1));
    // 1 / (R^2 + 0.01) is larger in the mean than at R = 1: by half of its second derivative, 6, times the variance of
    // R, s = 1/96; of ((R - 1)^2 - var_R), which has fourth moment at most 3 s^2, that leaves 6 s^2.
    const double s = 1.0 / 96.0;
    const double curvature = 3.0 * s * expected + 6.0 * s * s;
    CHECK(std::abs(sum - expected) < 4.0 * error + curvature);
    CHECK(std::abs(predicted - expected) < 4.0 * error + curvature);
    CHECK(4.0 * error + curvature < s); // else this would not see a reference whose variance is not subtracted
}

TEST_CASE("the floor of pictures that are off by a tenth is a hundredth", "[cpu][bench]") {
    constexpr int count = 12, edge = 16;
    constexpr std::uint32_t samples = 32;
    std::mt19937_64 random(5);
    const Film exact = flat_film(edge, 1.0f, 0, 0.0f);
    std::vector<BenchRun> runs;
    for (int i = 0; i < count; ++i) {
        Film image = random_film(random, edge, samples);
        for (glm::vec3& mean : image.mean)
            mean += 0.1f;
        runs.push_back({samples, 0, 1.0, relative_mse(image, exact), relative_variance(image, exact)});
    }
    const Interval floor = *bias_floor(runs, 0.0);
    // Of one value the difference has variance 2 v^2 / (n (n - 1)) + 4 b^2 v / n, v = 1/3 and b = 0.1.
    const double v = 1.0 / 3.0, n = samples;
    const double variance = (2.0 * v * v / (n * (n - 1.0)) + 4.0 * 0.01 * v / n) / (count * 3.0 * edge * edge);
    CHECK(std::abs(floor.value - 0.01 / 1.01) < 4.0 * std::sqrt(variance) / 1.01);
    CHECK(floor.low > 0.0);
}

TEST_CASE("pixels of too few samples and values that are not finite are left out", "[cpu][bench]") {
    Film reference = flat_film(2, 1.0f, 4, 0.01f), image = flat_film(2, 2.0f, 1, 0.0f);
    image.mean[0] = glm::vec3(100.0f);
    reference.samples[0] = 1;
    image.mean[1].y = std::numeric_limits<float>::quiet_NaN();
    CHECK(relative_mse(image, reference) == Approx((1.0 - 0.01) / 1.01));
    // Eight values of 0.01 / 1.01, those of a pixel together: 3, 3 and 2.
    CHECK(reference_offset_error(flat_film(2, 1.0f, 4, 0.01f)) == Approx(std::sqrt(2.0 * 4 * 9) * 0.01 / 1.01 / 12.0));
}

namespace {

struct Call {
    std::size_t estimator;
    std::uint32_t samples;
};

// What the schedule asks of estimators that take so many seconds a sample, and 0.01 s more.
std::vector<Call> schedule(const std::vector<double>& seconds_per_sample, double budget, double& spent) {
    std::vector<Call> calls;
    spent = 0.0;
    std::vector<double> warm;
    for (const double seconds : seconds_per_sample)
        warm.push_back(seconds + 0.01);
    run_rounds(
        warm, budget,
        [&](std::size_t estimator, std::uint32_t samples, double limit) -> std::optional<double> {
            const double seconds = 0.01 + seconds_per_sample[estimator] * samples;
            CHECK(limit == Approx(budget - spent));
            CHECK(seconds <= limit);
            spent += seconds;
            calls.push_back({estimator, samples});
            return seconds;
        },
        [] { return false; });
    return calls;
}

} // namespace

TEST_CASE("rounds double their samples, share the budget and keep to it", "[cpu][bench]") {
    const std::vector<double> seconds = {0.01, 0.02, 0.3};
    double spent = 0.0;
    const std::vector<Call> calls = schedule(seconds, 60.0, spent);
    CHECK(spent <= 60.0);
    CHECK(spent > 0.75 * 60.0);
    std::vector<std::map<std::uint32_t, int>> runs(seconds.size());
    std::vector<double> share(seconds.size());
    for (const Call& call : calls) {
        ++runs[call.estimator][call.samples];
        share[call.estimator] += 0.01 + seconds[call.estimator] * call.samples;
    }
    for (std::size_t i = 0; i < seconds.size(); ++i) {
        CAPTURE(i);
        std::uint32_t expected = 1;
        for (const auto& [samples, count] : runs[i]) {
            CHECK(samples == expected); // none is left out
            expected *= 2;
        }
        CHECK(runs[i].rbegin()->second >= 5);
        // The 0.01 s of starting up count less for more samples than the prediction thinks.
        const std::uint32_t predicted = predicted_count(seconds[i] + 0.01, 20.0), reached = runs[i].rbegin()->first;
        CHECK((reached == predicted || reached == 2 * predicted));
        CHECK(share[i] < 2 * 20.0);
    }
    // Each round begins with another one.
    CHECK(calls[0].estimator == 0);
    CHECK(calls[3].estimator == 1);
}

TEST_CASE("the budget ends a bench of slow estimators, and one that is cut short is asked no more", "[cpu][bench]") {
    double spent = 0.0;
    CHECK(schedule({2.0, 3.0, 100.0}, 6.5, spent).size() == 2);
    CHECK(schedule({10.0}, 5.0, spent).empty());
    int asked = 0;
    run_rounds(
        {0.01}, 10.0,
        [&](std::size_t, std::uint32_t, double) -> std::optional<double> {
            ++asked;
            return std::nullopt;
        },
        [] { return false; });
    CHECK(asked == 1);
    CHECK_FALSE(is_worth_measuring(1.0, 5.0));
    CHECK(is_worth_measuring(1.0, 6.1));
}

TEST_CASE("no two runs have the same seed", "[cpu][bench]") {
    for (const std::uint32_t seed : {0u, 1u, 4294967295u}) {
        std::set<std::uint32_t> seeds;
        for (std::uint32_t number = 0; number < 10000; ++number)
            seeds.insert(seed_of_run(seed, number));
        CHECK(seeds.size() == 10000);
    }
}

namespace {

struct Run {
    int code = -1;
    std::string text;
};

// A folder with a ball of optical depth 4 under the sun, and a cache of its own.
class Folder {
public:
    Folder() {
        std::filesystem::create_directories(path_ / "cache" / "vkvol");
        std::ofstream(file("ball.xml")) << "<options><sphere radius=\"1\"/><sigma_a>1</sigma_a><sigma_s>1</sigma_s>"
                                           "<width>16</width><height>16</height><rayPerPixelCount>8</rayPerPixelCount>"
                                           "<camera z=\"5\" fov=\"30\"/><backgroundColor r=\"1\" g=\"1\" b=\"1\"/>"
                                           "<light x=\"0\" y=\"1\" z=\"0\" r=\"1\" g=\"1\" b=\"1\"/></options>";
    }
    ~Folder() { std::filesystem::remove_all(path_); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    Run vkvol(const std::string& arguments) const { return shell(command(arguments)); }
    std::string command(const std::string& arguments) const {
        const char* device = std::getenv("VKVOL_TEST_DEVICE");
        return fmt::format("'{}' {}{}", VKVOL_BINARY, arguments, device ? fmt::format(" --device '{}'", device) : "");
    }
    Run shell(const std::string& script) const {
        Run result;
        FILE* pipe = popen(fmt::format("cd '{}' && export XDG_CACHE_HOME='{}' && {{ {}\n}} 2>&1", path_.string(),
                                       (path_ / "cache").string(), script)
                               .c_str(),
                           "r");
        REQUIRE(pipe);
        char part[4096];
        while (const std::size_t size = fread(part, 1, sizeof part, pipe))
            result.text.append(part, size);
        const int status = pclose(pipe);
        result.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
        return result;
    }
    std::filesystem::path file(const std::string& name) const { return path_ / name; }
    nlohmann::json json(const std::string& name) const { return nlohmann::json::parse(std::ifstream(file(name))); }
    std::vector<std::filesystem::path> cached_references() const {
        std::vector<std::filesystem::path> files;
        for (const auto& entry : std::filesystem::directory_iterator(path_ / "cache" / "vkvol"))
            if (entry.path().extension() == ".exr")
                files.push_back(entry.path());
        return files;
    }

private:
    std::filesystem::path path_ = std::filesystem::temp_directory_path() / fmt::format("vkvol-bench-{}", getpid());
};

void check_keys(const nlohmann::json& object, const std::vector<const char*>& keys) {
    for (const char* key : keys) {
        CAPTURE(key);
        CHECK(object.contains(key));
    }
}

// Rows of the CSV: integrator and samples -> relMSE of each run.
std::map<std::pair<std::string, std::uint32_t>, std::vector<double>> read_csv(const std::filesystem::path& path) {
    std::map<std::pair<std::string, std::uint32_t>, std::vector<double>> rows;
    std::ifstream file(path);
    std::string line;
    std::getline(file, line);
    CHECK(line == "integrator,samples,run,seed,seconds,relMse,relMseFromVariance");
    while (std::getline(file, line)) {
        std::vector<std::string> cells;
        std::stringstream stream(line);
        for (std::string cell; std::getline(stream, cell, ',');)
            cells.push_back(cell);
        REQUIRE(cells.size() >= 6);
        std::vector<double>& row = rows[{cells[0], std::uint32_t(std::stoul(cells[1]))}];
        row.push_back(std::stod(cells[5]));
        CHECK(std::stoul(cells[2]) == row.size());
    }
    return rows;
}

void check_estimator(const nlohmann::json& estimator, const Folder& folder) {
    check_keys(estimator,
               {"integrator", "isDefault", "biased", "setupSeconds", "points", "slope", "biasFloor", "efficiency",
                "secondsToOnePercent", "perPath", "laneUse", "passSeconds", "samplesPerSecond", "image"});
    check_keys(estimator["setupSeconds"], {"load", "upload", "pipeline"});
    check_keys(estimator["perPath"], {"realCollisions", "nullCollisions", "lookups", "majorantCells", "shadowRays"});
    check_keys(estimator["passSeconds"], {"sky", "generate", "track", "accumulate"});
    for (const char* figure : {"slope", "biasFloor", "efficiency"}) {
        check_keys(estimator[figure], {"value", "low", "high"});
        CHECK(estimator[figure]["low"] <= estimator[figure]["value"]);
        CHECK(estimator[figure]["value"] <= estimator[figure]["high"]);
    }
    CHECK(std::filesystem::exists(folder.file(estimator["image"])));
    CHECK(estimator["points"].back()["runs"] >= 5);
}

} // namespace

TEST_CASE("a bench writes what it measured, as JSON, CSV and pictures", "[gpu][bench]") {
    const Folder folder;
    const Run run = folder.vkvol("bench ball.xml --time 2s --integrators ratioTracking,ratioTracking:flight=delta");
    CAPTURE(run.text);
    REQUIRE(run.code == exit_done);
    CHECK_THAT(run.text, Contains("bias floor") && Contains("ratioTracking:flight=delta"));
    const nlohmann::json json = folder.json("ball.bench.json");
    check_keys(json, {"format", "version", "scene", "sceneHash", "command", "program", "date", "device", "machine",
                      "image", "budgetSeconds", "seed", "reference", "estimators", "ranking"});
    CHECK(json["format"] == "vkvol-bench");
    check_keys(json["device"], {"name", "driver", "api"});
    check_keys(json["machine"], {"processor", "cores", "load"});
    check_keys(json["reference"], {"file", "integrator", "samples", "seconds", "cached", "relMse"});
    CHECK(json["reference"]["integrator"] != "ratioTracking");
    CHECK(json["reference"]["relMse"] > 0.0);
    REQUIRE(json["estimators"].size() == 2);
    CHECK(json["ranking"].size() == 2);
    CHECK(json["estimators"][0]["isDefault"] == true);
    CHECK(json["estimators"][1]["isDefault"] == false);

    auto rows = read_csv(folder.file("ball.bench.csv"));
    double seconds = 0.0;
    for (const nlohmann::json& estimator : json["estimators"]) {
        check_estimator(estimator, folder);
        for (const nlohmann::json& point : estimator["points"]) {
            check_keys(point, {"samples", "runs", "seconds", "secondsLow", "secondsHigh", "relMse", "relMseError",
                               "relMseFromVariance"});
            seconds += double(point["secondsLow"]) * double(point["runs"]);
            const std::vector<double> row = rows[{estimator["integrator"], point["samples"]}];
            CHECK(point["runs"] == row.size());
            double mean = 0.0;
            for (const double value : row)
                mean += value / double(row.size());
            CHECK(double(point["relMse"]) == Approx(mean).epsilon(1e-12)); // the order of the sum
        }
    }
    CHECK(seconds <= 2.0);
    Metadata metadata;
    const Film film = read_exr(folder.file("ball.ratioTracking.exr"), &metadata);
    CHECK(film.samples.front() == json["estimators"][0]["points"].back()["samples"]);
}

TEST_CASE("a reference is kept, read again, and rendered anew if it is damaged", "[gpu][bench]") {
    const Folder folder;
    const std::string command = "bench ball.xml --time 2s --integrators ratioTracking -q";
    const auto is_cached = [&] {
        const Run run = folder.vkvol(command);
        INFO(run.text);
        REQUIRE(run.code == exit_done);
        return bool(folder.json("ball.bench.json")["reference"]["cached"]);
    };
    const auto used = [&] { return std::string(folder.json("ball.bench.json")["reference"]["file"]); };
    CHECK_FALSE(is_cached());
    const std::string reference = used();
    REQUIRE(folder.cached_references() == std::vector<std::filesystem::path>{reference});
    // Enough for any bench so short, whatever the machine does meanwhile.
    Metadata metadata;
    const Film film = read_exr(reference, &metadata);
    metadata["renderTimeSeconds"] = 2.0f;
    write_exr(reference, film, metadata);
    CHECK(is_cached());
    CHECK(used() == reference);
    std::filesystem::resize_file(reference, std::filesystem::file_size(reference) / 2);
    CHECK_FALSE(is_cached());
    for (const std::filesystem::path& file : folder.cached_references()) {
        metadata["vkvol/sceneHash"] = std::string("0123456789abcdef"); // the name promises another
        write_exr(file, film, metadata);
    }
    CHECK_FALSE(is_cached());
    CHECK(read_exr(used()).samples.front() > 1);
}

TEST_CASE("a bench against a given reference checks what that shows", "[gpu][bench]") {
    const Folder folder;
    REQUIRE(folder.vkvol("ball.xml --spp 64 --seed 9 -o reference.exr -q").code == exit_done);
    REQUIRE(folder.vkvol("ball.xml --spp 1 -o one.exr -q").code == exit_done);
    REQUIRE(folder.vkvol("ball.xml --spp 4 --integrator deltaTracking -o dark.exr -q").code == exit_done);
    const std::string command = "bench ball.xml --time 2s --integrators ratioTracking --reference ";
    const Run good = folder.vkvol(command + "reference.exr -o good");
    CAPTURE(good.text);
    CHECK(good.code == exit_done);
    CHECK(folder.json("good.bench.json")["reference"]["samples"] == 64);
    CHECK(folder.cached_references().empty());
    for (const auto& [arguments, message] : {std::pair{"dark.exr", "no unbiased render of this scene"},
                                             {"reference.exr --width 8", "render the reference in that size"},
                                             {"one.exr", "render more"},
                                             {"none.exr", "none.exr"}}) {
        const Run bad = folder.vkvol(command + arguments);
        CAPTURE(arguments, bad.text);
        CHECK(bad.code == exit_bad_input);
        CHECK_THAT(bad.text, Contains(message));
    }
}

TEST_CASE("bench refuses command lines that make no sense", "[gpu][bench][options]") {
    const Folder folder;
    for (const auto& [arguments, message] : {
             std::pair{"", "no scene given"},
             {"none.xml", "none.xml"},
             {"ball.xml --time fast", "--time"},
             {"ball.xml --spp 4", "unknown option --spp"},
             {"ball.xml --integrators ratioTraking", "did you mean ratioTracking"},
             {"ball.xml --integrators ratioTracking,", "empty name"},
             {"ball.xml --integrators ratioTracking,ratioTracking", "given twice"},
             {"ball.xml --integrators ratioTracking,deltaTracking", "do not estimate the same picture"},
             {"ball.xml -o none/there", "does not exist"},
         }) {
        const Run run = folder.vkvol(std::string("bench ") + arguments);
        CAPTURE(arguments, run.text);
        CHECK(run.code == exit_bad_input);
        CHECK_THAT(run.text, Contains(message));
    }
}

TEST_CASE("an interrupted bench writes what there is", "[gpu][bench]") {
    const Folder folder;
    REQUIRE(folder.vkvol("ball.xml --spp 64 --seed 9 -o reference.exr -q").code == exit_done);
    // After ten measured renders of many.
    const Run run =
        folder.shell(folder.command("bench ball.xml --time 10m --reference reference.exr") + " >log 2>&1 &\n" +
                     "for i in $(seq 600); do [ $(grep -c ' of 600 s' log) -ge 10 ] && break; sleep 0.1; done\n"
                     "kill -TERM $!; wait $!");
    CAPTURE(run.text);
    CHECK(run.code == exit_interrupted);
    const nlohmann::json json = folder.json("ball.bench.json");
    CHECK(json["interrupted"] == true);
    CHECK_FALSE(json["estimators"].empty());
    CHECK_FALSE(read_csv(folder.file("ball.bench.csv")).empty());
}
