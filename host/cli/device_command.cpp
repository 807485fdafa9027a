#include "device_command.h"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "device.h"
#include "error.h"
#include "messages.h"

namespace vkvol {

namespace {

constexpr double mib = 1048576.0;

void print_table(const std::vector<DeviceInfo>& devices) {
    for (const DeviceInfo& d : devices) {
        tell(stdout, "{}  {} ({}), Vulkan {}\n", d.index, d.name, d.type, d.api);
        tell(stdout, "   driver {}; uuid {}\n", d.driver, d.uuid);
        tell(stdout, "   {:.0f} MiB of memory, {:.0f} MiB per storage buffer; grids {}\n", d.memory / mib,
             d.storage_range / mib, d.addresses ? "may be larger" : "may be no larger");
        tell(stdout, "   {}\n", d.rejection.empty() ? "usable" : "not usable: " + d.rejection);
    }
}

void print_json(const std::vector<DeviceInfo>& devices) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const DeviceInfo& d : devices)
        list.push_back({{"index", d.index},
                        {"name", d.name},
                        {"type", d.type},
                        {"driver", d.driver},
                        {"uuid", d.uuid},
                        {"api", d.api},
                        {"memory", d.memory},
                        {"storageBufferRange", d.storage_range},
                        {"bufferDeviceAddress", d.addresses},
                        {"usable", d.rejection.empty()},
                        {"rejection", d.rejection}});
    put(stdout, list.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

} // namespace

int run_devices(bool json) {
    const std::vector<DeviceInfo> devices = list_devices();
    json ? print_json(devices) : print_table(devices);
    const bool usable =
        std::any_of(devices.begin(), devices.end(), [](const DeviceInfo& d) { return d.rejection.empty(); });
    if (!usable)
        throw DeviceError("no device here can be used; on Debian, `apt install mesa-vulkan-drivers` brings a software "
                          "driver that runs anywhere");
    return exit_done;
}

} // namespace vkvol
