// Devices for machines.
#pragma once

#include <string>
#include <vector>

#include "device.h"

namespace vkvol {

// A JSON array with an object for each, as `vkvol devices --json` prints it.
std::string devices_json(const std::vector<DeviceInfo>& devices);

} // namespace vkvol
