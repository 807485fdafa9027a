// What is fuzzed: how an input is made, and what is done with it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "random.h"

namespace vkvol::fuzz {

// Thrown where a promise is broken: the input is a finding.
struct Finding : std::runtime_error {
    using std::runtime_error::runtime_error;
};

inline void expect(bool good, const char* promise) {
    if (!good)
        throw Finding(promise);
}

class Target {
public:
    virtual ~Target() = default;

    // Before the first input. Files that inputs name may be put in `directory`.
    virtual void prepare(const std::filesystem::path& directory) = 0;
    virtual std::string make(Random& random) = 0;
    // Reads the input and does with it what the renderer would. Throws InputError or Finding.
    virtual void use(const std::string& input, Random& random) = 0;

    const char* name;
    const char* extension;   // of a file that holds an input
    std::uint64_t mebibytes; // that may be allocated at a time,
    std::uint64_t times;     // and as many times the input's size on top

protected:
    Target(const char* name, const char* extension, std::uint64_t mebibytes, std::uint64_t times)
        : name(name), extension(extension), mebibytes(mebibytes), times(times) {}
};

const std::vector<Target*>& targets();

Target& scene_target();
Target& pbrt_target();
Target& grid_target();
Target& vdb_target();
Target& mesh_target();
Target& image_target();
Target& options_target();
Target& sky_target();
Target& phase_target();

// Where the scene files lie.
std::filesystem::path source_directory();

std::string read_file(const std::filesystem::path& file);
void write_file(const std::filesystem::path& file, const std::string& bytes);

} // namespace vkvol::fuzz
