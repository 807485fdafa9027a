// vkvol_fuzz: reads damaged and absurd inputs by the thousand, and says which of them break a promise.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fmt/format.h>
#include <fstream>
#include <iterator>

#include "loop.h"

namespace vkvol::fuzz {

const std::vector<Target*>& targets() {
    static const std::vector<Target*> all = {&scene_target(), &pbrt_target(),  &grid_target(),
                                             &vdb_target(),   &mesh_target(),  &image_target(),
                                             &sky_target(),   &phase_target(), &options_target()};
    return all;
}

std::filesystem::path source_directory() {
    return VKVOL_SOURCE_DIR;
}

std::string read_file(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream)
        throw std::runtime_error(file.string() + ": cannot be read");
    return {std::istreambuf_iterator<char>(stream), {}};
}

void write_file(const std::filesystem::path& file, const std::string& bytes) {
    std::ofstream stream(file, std::ios::binary);
    if (!stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size())))
        throw std::runtime_error(file.string() + ": cannot be written");
}

} // namespace vkvol::fuzz

namespace {

using namespace vkvol::fuzz;

std::string description() {
    std::string text =
        "Reads inputs made by seeded mutation. Each must be read, or refused with one line of at most 4000 bytes, by "
        "an "
        "InputError; what is read is then used as the renderer would. A crash, a report of a sanitizer, another "
        "exception, more than 5 seconds of processor time (30 under sanitizers) or more memory than this is a finding, "
        "and exit code 1:\n";
    for (const Target* target : targets())
        text += fmt::format("  {:8} at most {} MiB + {} times the input's size\n", target->name, target->mebibytes,
                            target->times);
    return text;
}

} // namespace

int main(int argc, char** argv) {
    std::vector<std::string> names;
    for (const Target* target : targets())
        names.emplace_back(target->name);
    CLI::App app(description(), "vkvol_fuzz");
    std::string name, out = ".";
    Range range;
    std::int64_t only = -1;
    app.add_option("target", name, "What to read")->required()->check(CLI::IsMember(names));
    app.add_option("--runs", range.runs, "How many inputs [1000]");
    app.add_option("--seed", range.seed, "Input k of a target and seed is always the same [1]");
    app.add_option("--first", range.first, "Number of the first input [0]");
    app.add_option("--only", only, "This input alone");
    app.add_option("--out", out, "Directory for the inputs of findings [.]");
    CLI11_PARSE(app, argc, argv);
    if (only >= 0) {
        range.first = static_cast<std::uint64_t>(only);
        range.runs = 1;
    }
    Target& target =
        **std::find_if(targets().begin(), targets().end(), [&](const Target* t) { return t->name == name; });
    try {
        const Tally tally = run_inputs(target, range, out);
        fmt::print("{:8} {:9} runs {:9} accepted {:8.1f} s {:3} findings; slowest {:.2f} s (input {}), most memory "
                   "{:.1f} MiB\n",
                   target.name, tally.runs, tally.accepted, tally.seconds, tally.findings, tally.slowest,
                   tally.slowest_input, static_cast<double>(tally.peak_bytes) / 1048576.0);
        return tally.findings > 0;
    } catch (const std::exception& error) {
        fmt::print(stderr, "vkvol_fuzz: {}\n", error.what());
        return 2;
    }
}
