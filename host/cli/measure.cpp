#include "measure.h"

#include <algorithm>
#include <cstdint>
#include <fmt/format.h>
#include <glm/glm.hpp>
#include <optional>
#include <utility>

#include "atomic_file.h"
#include "bench.h"
#include "error.h"
#include "file_ending.h"
#include "file_uses.h"
#include "film_table.h"
#include "image_io.h"
#include "input_file.h"
#include "input_files.h"
#include "interrupt.h"
#include "messages.h"
#include "render_notes.h"
#include "render_scene.h"
#include "requested_scene.h"
#include "session.h"
#include "spectral_bands.h"
#include "stopwatch.h"
#include "table_rows.h"
#include "workshop.h"

namespace vkvol {

namespace {

using Values = std::vector<std::string>; // of each swept key

// One after another, the last key fastest.
std::vector<Values> combinations(const std::vector<Sweep>& sweeps) {
    std::vector<Values> all{{}};
    for (const Sweep& sweep : sweeps) {
        std::vector<Values> longer;
        for (const Values& before : all)
            for (const std::string& value : sweep.values) {
                longer.push_back(before);
                longer.back().push_back(value);
            }
        all = std::move(longer);
    }
    return all;
}

RenderOptions request_of(const MeasureOptions& options, const Values& values, const SpectralBand& band) {
    RenderOptions render;
    static_cast<RenderRequest&>(render) = options.request;
    for (std::size_t i = 0; i < values.size(); ++i)
        render.defines[options.sweeps[i].key] = values[i];
    render.defines.insert(band.values.begin(), band.values.end());
    return render;
}

RenderResult measure(const MeasureOptions& options, const Scene& scene, std::uint32_t band, Workshop& workshop) {
    RenderJob job;
    job.workshop = &workshop;
    job.crop = {0, scene.picture.width, 0, scene.picture.height};
    job.seed = band == 0 ? options.request.seed : seed_of_run(options.request.seed, band);
    job.plan = options.request.plan;
    job.time_limit = options.request.time_limit;
    job.noise_goal = options.request.noise_goal;
    job.disk_cache = !options.request.no_cache;
    job.interrupted = interrupted;
    const Device& device = workshop.device(options.request.device);
    RenderResult result = render(device, scene, job);
    check_validation(device);
    return result;
}

// A line of a table that has one.
std::string mean_table(const Film& film) {
    const ImageMean mean = image_mean(film);
    std::uint64_t samples = 0;
    for (const std::uint32_t n : film.samples)
        samples += n;
    std::string text = "R,G,B,standardError.R,standardError.G,standardError.B,samples\n";
    const auto numbers = [&text](const glm::dvec3& v) { text += fmt::format("{:.9g},{:.9g},{:.9g},", v.x, v.y, v.z); };
    numbers(mean.value);
    if (mean.standard_error)
        numbers(*mean.standard_error);
    else
        text += ",,,";
    return text + fmt::format("{}\n", samples);
}

// A table's rows behind the values that they are of.
void add(const std::vector<Sweep>& sweeps, const Values& values, const std::string& table, TableRows& rows) {
    TableRows found = rows_of(table);
    if (rows.empty()) {
        Values heading;
        for (const Sweep& sweep : sweeps)
            heading.push_back(sweep.key);
        heading.insert(heading.end(), found.front().begin(), found.front().end());
        rows.push_back(std::move(heading));
    }
    for (std::size_t i = 1; i < found.size(); ++i) {
        found[i].insert(found[i].begin(), values.begin(), values.end());
        rows.push_back(std::move(found[i]));
    }
}

// Which of several values it was.
template <class Work>
void of_values(const std::vector<Sweep>& sweeps, const Values& values, const SpectralBand& band, const Work& work) {
    std::string which;
    for (std::size_t i = 0; i < values.size(); ++i)
        which += fmt::format("-D {}={}: ", sweeps[i].key, values[i]);
    for (const auto& [key, value] : band.values)
        which += fmt::format("band of {}={}: ", key, value);
    try {
        work();
    } catch (const InputError& error) {
        throw InputError(which + error.what());
    } catch (const RenderError& error) {
        throw RenderError(which + error.what());
    }
}

void check_output(const MeasureOptions& options, const Scene& scene) {
    if (!options.output)
        return;
    const std::string ending = file_ending(*options.output);
    if (ending != ".csv" && ending != ".json" && !is_special(*options.output))
        throw InputError(fmt::format("{}: measure writes a table; expected .csv or .json", options.output->string()));
    FileUses uses;
    uses.reads("the scene", options.request.scene);
    uses.reads_files_of(scene);
    if (options.bands)
        uses.reads("the bands", *options.bands);
    uses.writes("the table", *options.output, "-o");
    uses.check();
    check_directory_writable(*options.output, "-o");
}

// A table has one column of a name.
void check_keys(const MeasureOptions& options, const Scene& scene) {
    Values columns = {"R", "G", "B", "samples"};
    if (!options.means)
        columns.insert(columns.end(), {"column", "row"});
    if (!options.means && reads_flux(scene.camera))
        columns.insert(columns.end(), {"x", "y", "z"});
    for (const Sweep& sweep : options.sweeps)
        if (std::find(columns.begin(), columns.end(), sweep.key) != columns.end())
            throw InputError(fmt::format("-D {}: the table has a column of that name; rename the key", sweep.key));
}

// A table that no file takes is printed: it may be of hours.
void write(const MeasureOptions& options, const TableRows& rows) {
    if (rows.empty())
        return;
    if (!options.output) {
        put(stdout, as_text(rows));
        return;
    }
    try {
        write_text(*options.output, as_file(*options.output, rows));
    } catch (const RenderError& error) {
        put(stdout, as_file(*options.output, rows));
        throw RenderError(fmt::format("{}; the readings are on standard output instead", error.what()));
    }
}

// From reading to reading, so that none is lost. Whether it is written: a disk may be full for a moment.
bool keep(const MeasureOptions& options, const TableRows& rows) {
    if (!options.output || is_special(*options.output) || rows.empty())
        return false;
    try {
        write_text(*options.output, as_file(*options.output, rows));
        return true;
    } catch (const RenderError& error) {
        tell(stderr, "vkvol: warning: {}; tried again after the next reading\n", error.what());
        return false;
    }
}

// All readings are of one scene: throws InputError where it changes between them.
void see(const MeasureOptions& options, const Scene& scene, SeenFiles& seen) {
    seen.see({"the scene", options.request.scene});
    seen.see(scene);
}

// Before any time is spent: what is wrong with the last of many values is wrong now.
void check_all(const MeasureOptions& options, const std::vector<SpectralBand>& bands, Workshop& workshop,
               SeenFiles& seen) {
    for (const Values& values : combinations(options.sweeps)) {
        std::optional<glm::ivec2> size;
        for (const SpectralBand& band : bands)
            of_values(options.sweeps, values, band, [&] {
                if (interrupted())
                    return;
                const RenderScene loaded = load_render_scene(request_of(options, values, band), workshop.fields());
                see(options, loaded.scene, seen);
                const glm::ivec2 its(loaded.scene.picture.width, loaded.scene.picture.height);
                if (size.value_or(its) != its)
                    throw InputError(another_size);
                size = its;
                check_output(options, loaded.scene);
                check_keys(options, loaded.scene);
                FileUses uses;
                uses.reads_files_of(loaded.scene);
                uses.check_inputs();
            });
    }
}

// One, of weight 1, without a table of them.
std::vector<SpectralBand> bands_of(const MeasureOptions& options) {
    if (!options.bands)
        return {SpectralBand{}};
    std::vector<SpectralBand> bands = read_bands(*options.bands);
    for (const Sweep& sweep : options.sweeps)
        if (bands.front().values.contains(sweep.key))
            throw InputError(
                fmt::format("-D {}: is a column of {} too; leave out one of them", sweep.key, options.bands->string()));
    return bands;
}

// Of what a reading warns and is biased by: each line once, however many readings have it.
void tell_once(const MeasureOptions& options, const RenderScene& loaded, const RenderResult& result,
               Workshop& workshop) {
    std::vector<std::string> warnings = loaded.scene.warnings;
    warnings.insert(warnings.end(), result.warnings.begin(), result.warnings.end());
    for (const std::string& warning : workshop.new_warnings(warnings))
        tell(stderr, "vkvol: warning: {}\n", warning);
    std::vector<std::string> notes;
    if (!loaded.assumed.empty())
        notes.push_back(loaded.assumed);
    if (!result.biased.empty())
        notes.push_back("the readings are biased: " + result.biased);
    if (!result.interrupted && result.samples > 1 && !relative_noise(result.film))
        notes.push_back(fmt::format("no light came in {} samples{}: such readings are 0 as far as these tell",
                                    result.samples,
                                    options.request.noise_goal ? ", and --noise has nothing to go by" : ""));
    for (const std::string& note : workshop.new_warnings(notes))
        tell(stderr, "vkvol: note: {}\n", note);
}

// Reading after reading, band after band, on one device.
class Readings {
public:
    // Throws InputError for what is wrong with any reading.
    explicit Readings(const MeasureOptions& options) : options_(options), bands_(bands_of(options)) {
        check_all(options_, bands_, workshop_, seen_);
    }

    // One reading, summed over its bands; nothing if interrupted before: of some bands alone it would be another.
    std::optional<std::string> table_of(const Values& values) {
        Film sum;
        std::size_t added = 0;
        for (std::size_t band = 0; band < bands_.size() && !was_interrupted_; ++band)
            of_values(options_.sweeps, values, bands_[band], [&] {
                const RenderResult result = measure_band(values, band);
                if (result.samples == 0)
                    return;
                add_band(result.film, bands_[band].weight, sum);
                ++added;
            });
        if (added < bands_.size())
            return {};
        return options_.means ? mean_table(sum) : film_table(sum);
    }

    bool was_interrupted() const { return was_interrupted_; }

    // What all readings together were cut short by.
    const RenderResult& told() const { return told_; }

private:
    RenderScene scene_of(const Values& values, std::size_t band) {
        RenderScene loaded = load_render_scene(request_of(options_, values, bands_[band]), workshop_.fields());
        see(options_, loaded.scene, seen_);
        if ((std::exchange(loaded.scene.layers, 0u) & ~layer_alpha) != 0)
            loaded.scene.warnings.push_back("<film aov>: a table has no layers, and none is rendered; leave it out");
        if (std::exchange(loaded.scene.holds_out, false))
            loaded.scene.warnings.push_back(
                "<film alpha>: a table has none, and readings have the light from behind the media; leave it out");
        return loaded;
    }

    RenderResult measure_band(const Values& values, std::size_t band) {
        const RenderScene loaded = scene_of(values, band);
        RenderResult result = measure(options_, loaded.scene, static_cast<std::uint32_t>(band), workshop_);
        was_interrupted_ = result.interrupted;
        add_counts(told_.counts, result.counts);
        told_.counts.cleaned_voxels = std::max(told_.counts.cleaned_voxels, result.counts.cleaned_voxels);
        if (!options_.quiet)
            tell_once(options_, loaded, result, workshop_);
        if (result.samples == 0 && !was_interrupted_)
            throw RenderError("ended before any sample was done");
        return result;
    }

    const MeasureOptions& options_;
    std::vector<SpectralBand> bands_;
    Workshop workshop_{true};
    SeenFiles seen_;
    bool was_interrupted_ = false;
    RenderResult told_;
};

// Each reading's rows, written between readings where that takes little of the time.
void measure_all(const MeasureOptions& options, Readings& readings) {
    constexpr double pause = 20.0; // times what writing takes: of many readings the table is long
    TableRows rows;
    bool is_written = false;
    double writing = 0.0; // seconds
    Stopwatch unwritten;
    try {
        for (const Values& values : combinations(options.sweeps)) {
            if (readings.was_interrupted())
                break;
            if (const std::optional<std::string> table = readings.table_of(values))
                add(options.sweeps, values, *table, rows);
            is_written = false;
            if (unwritten.seconds() < pause * writing)
                continue;
            unwritten.lap();
            is_written = keep(options, rows);
            writing = unwritten.lap();
        }
    } catch (const std::exception&) { // what was measured is not lost
        if (!is_written)
            write(options, rows);
        throw;
    }
    if (!is_written)
        write(options, rows);
}

} // namespace

int run_measure(const MeasureOptions& options) {
    install_interrupt_handler();
    check_read_again(options.request.scene, "measure reads the scene for each reading, and to check all of them first");
    Readings readings(options);
    measure_all(options, readings);
    if (!options.quiet)
        print_caps(options.request, readings.told());
    return readings.was_interrupted() ? exit_interrupted : exit_done;
}

} // namespace vkvol
