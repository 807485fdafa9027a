#include "device_command.h"

#include <algorithm>
#include <fmt/format.h>

#include "device.h"
#include "device_json.h"
#include "error.h"
#include "messages.h"

namespace vkvol {

namespace {

constexpr double mib = 1048576.0;

void print_table(const std::vector<DeviceInfo>& devices) {
    for (const DeviceInfo& d : devices) {
        tell(stdout, "{}  {} ({}), Vulkan {}\n", d.index, d.name, d.type, d.api);
        tell(stdout, "   driver {}; uuid {}\n", d.driver, d.uuid);
        tell(stdout, "   {:.0f} MiB of memory, {:.0f} MiB per storage buffer; grids {}{}\n", d.memory / mib,
             d.storage_range / mib, d.addresses ? "may be larger" : "may be no larger",
             d.ray_queries ? "; ray queries" : "");
        tell(stdout, "   {}\n",
             !d.rejection.empty() ? "not usable: " + d.rejection
             : d.conformant       ? "usable"
                                  : "usable, but not conformant: it has not passed the tests of Vulkan");
    }
}

} // namespace

int run_devices(bool json) {
    const std::vector<DeviceInfo> devices = list_devices();
    if (json)
        put(stdout, devices_json(devices));
    else
        print_table(devices);
    const bool usable =
        std::any_of(devices.begin(), devices.end(), [](const DeviceInfo& d) { return d.rejection.empty(); });
    if (!usable)
        throw DeviceError("no device here can be used; on Debian, `apt install mesa-vulkan-drivers` brings a software "
                          "driver that runs anywhere");
    return exit_done;
}

} // namespace vkvol
