#include "schedule_memory.h"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

#include "atomic_file.h"
#include "cache_directory.h"

namespace vkvol {

namespace {

std::filesystem::path memory_file() {
    const std::filesystem::path directory = cache_directory();
    return directory.empty() ? directory : directory / "schedules";
}

std::string line_of(const std::string& kind, Schedule schedule) {
    return std::string(name_of(schedule)) + " " + kind;
}

} // namespace

std::optional<Schedule> recall_schedule(const std::string& kind) {
    std::ifstream file(memory_file());
    for (std::string line; std::getline(file, line);)
        for (const Schedule schedule : {Schedule::fused, Schedule::staged})
            if (line == line_of(kind, schedule))
                return schedule;
    return std::nullopt;
}

void remember_schedule(const std::string& kind, Schedule schedule) {
    const std::filesystem::path name = memory_file();
    if (name.empty())
        return;
    std::ostringstream text;
    text << std::ifstream(name).rdbuf();
    const std::string lines = text.str() + line_of(kind, schedule) + "\n";
    try {
        std::filesystem::create_directories(name.parent_path());
        AtomicFile file(name);
        file.write(lines.data(), lines.size(), 0);
        file.put_in_place();
    } catch (const std::system_error&) {
        // Said in the header.
    }
}

} // namespace vkvol
