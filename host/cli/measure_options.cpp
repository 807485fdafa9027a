#include "measure_options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>

#include "error.h"
#include "option_groups.h"
#include "option_values.h"
#include "options_help.h"

namespace vkvol {

namespace {

struct MeasureTexts {
    std::vector<std::string> defines;
    std::string output, bands, time;
    SamplingTexts sampling;
};

constexpr std::size_t most_values = 100'000; // of all keys together

// "A..BxN"; none if it is no such text.
std::vector<std::string> evenly(const std::string& key, const std::string& text) {
    const std::size_t dots = text.find(".."), times = text.rfind('x');
    double begin = 0.0;
    const char* const end = text.data() + std::min(dots, text.size());
    const auto [rest, error] = std::from_chars(text.data(), end, begin);
    const bool is_range = error == std::errc() && rest == end && times != std::string::npos && times > dots;
    if (!is_range || dots == std::string::npos) // as names of files may be
        return {};
    const std::string what = fmt::format("-D {}", key);
    const double from = parse_number(text.substr(0, dots), what),
                 to = parse_number(text.substr(dots + 2, times - dots - 2), what),
                 count = parse_number(text.substr(times + 1), what);
    if (!(count >= 2.0 && count <= double(most_values)) || count != std::floor(count))
        fail_command_line(fmt::format("{}: '{}' values; expected a whole number from 2 to {}", what,
                                      text.substr(times + 1), most_values));
    std::vector<std::string> values;
    const int last = static_cast<int>(count) - 1;
    const double dust = 1e-12 * std::max(std::abs(from), std::abs(to)); // of rounding, where a step is at 0
    for (int i = 0; i <= last; ++i) {
        const double value = i == last ? to : from + (to - from) * i / last;
        values.push_back(fmt::format("{:.12g}", std::abs(value) > dust ? value : 0.0));
    }
    return values;
}

void add_options(CLI::App& app, MeasureOptions& measure, MeasureTexts& texts) {
    RenderRequest& request = measure.request;
    app.add_option("scene", request.scene, "Scene file, see scenes/README.md, or a scene of pbrt-v4")
        ->option_text("SCENE.xml|SCENE.pbrt|FILE.nvdb|FILE.vdb");
    app.add_option("-o,--output", texts.output, "Write the table as .csv or .json in place of printing it")
        ->option_text("FILE.csv|FILE.json")
        ->group("Picture");
    add_size_options(app, request);
    app.add_flag("--mean", measure.means, "The mean of the picture in place of all its pixels")->group("Picture");
    add_sampling_options(app, request, texts.sampling, "");
    const char* group = "Sampling";
    app.add_option("--time", texts.time, "At most this long for each combination of values, and band")
        ->option_text("T")
        ->group(group);
    app.add_option("--grid", request.grid, "A .nvdb or .vdb file in place of the scene's density field")
        ->option_text("FILE [scene]")
        ->group(group);
    add_list(app, "-D,--define", texts.defines,
             "Fills $KEY in the scene, with one value after the other; may be given several times. A..BxN: N values, "
             "both ends among them")
        ->option_text("KEY=A,B,...|KEY=A..BxN")
        ->group(group);
    app.add_option("--bands", texts.bands,
                   "Readings are the weighted sum over bands: lines of values, below a line of names, weight and $keys")
        ->option_text("FILE.csv")
        ->group(group);
    add_device_options(app, request);
    app.add_flag("-q,--quiet", measure.quiet, "Print errors and the table only")->group("Output");
    app.footer(measure_footer);
}

} // namespace

Sweep parse_sweep(const std::string& text) {
    std::map<std::string, std::string> one;
    add_define(one, text);
    const auto& [key, value] = *one.begin();
    Sweep sweep{key, evenly(key, value)};
    if (sweep.values.empty())
        sweep.values = split(value, ',');
    if (sweep.values.size() > 1 && std::count(sweep.values.begin(), sweep.values.end(), "") > 0)
        fail_command_line(
            fmt::format("-D {}: '{}' has nothing between two commas, or at an end; give a value there, or "
                        "remove the comma",
                        key, value));
    return sweep;
}

void parse_measure(const std::vector<std::string>& arguments, Options& options) {
    MeasureOptions& measure = options.measure;
    CLI::App app(measure_description, "vkvol measure");
    MeasureTexts texts;
    add_options(app, measure, texts);
    if (!run_parser(app, arguments, options))
        return;
    if (measure.request.scene.empty())
        fail_command_line("measure: no scene given; e.g. vkvol measure slab.xml -D sun=0.2,0.5,1");
    std::size_t count = 1;
    for (const std::string& define : texts.defines) {
        measure.sweeps.push_back(parse_sweep(define));
        const Sweep& sweep = measure.sweeps.back();
        if (std::count_if(measure.sweeps.begin(), measure.sweeps.end(),
                          [&](const Sweep& other) { return other.key == sweep.key; }) > 1)
            fail_command_line(fmt::format("-D: {} given twice; write its values with commas between", sweep.key));
        count *= sweep.values.size();
        if (count > most_values)
            fail_command_line(fmt::format("-D: more than {} combinations of values", most_values));
    }
    if (!texts.output.empty())
        measure.output = texts.output;
    if (!texts.bands.empty())
        measure.bands = texts.bands;
    if (!texts.time.empty())
        measure.request.time_limit = parse_duration(texts.time);
    finish_sampling(measure.request, texts.sampling);
}

} // namespace vkvol
