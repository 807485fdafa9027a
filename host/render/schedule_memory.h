// Which schedule was found faster, by device and kind of scene: within the process; and a line each in
// ${XDG_CACHE_HOME:-~/.cache}/vkvol/schedules.
#pragma once

#include <optional>
#include <string>

#include "plan.h"

namespace vkvol {

std::optional<Schedule> recall_schedule(const std::string& kind, bool use_disk);

// Failure to write is no error, only another trial next time.
void remember_schedule(const std::string& kind, Schedule schedule, bool use_disk);

} // namespace vkvol
