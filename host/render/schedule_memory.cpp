#include "schedule_memory.h"

#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <sstream>
#include <system_error>

#include "atomic_file.h"
#include "cache_directory.h"

namespace vkvol {

namespace {

std::mutex mutex;
std::map<std::string, Schedule> of_this_process;

std::filesystem::path memory_file() {
    const std::filesystem::path directory = cache_directory();
    return directory.empty() ? directory : directory / "schedules";
}

std::string line_of(const std::string& kind, Schedule schedule) {
    return std::string(name_of(schedule)) + " " + kind;
}

} // namespace

std::optional<Schedule> recall_schedule(const std::string& kind, bool use_disk) {
    {
        const std::scoped_lock lock(mutex);
        if (const auto found = of_this_process.find(kind); found != of_this_process.end())
            return found->second;
    }
    if (!use_disk)
        return std::nullopt;
    std::ifstream file(memory_file());
    for (std::string line; std::getline(file, line);)
        for (const Schedule schedule : {Schedule::fused, Schedule::staged})
            if (line == line_of(kind, schedule))
                return schedule;
    return std::nullopt;
}

void remember_schedule(const std::string& kind, Schedule schedule, bool use_disk) {
    const std::scoped_lock lock(mutex);
    of_this_process[kind] = schedule;
    const std::filesystem::path name = memory_file();
    if (name.empty() || !use_disk)
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
