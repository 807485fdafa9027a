#include "device_json.h"

#include <nlohmann/json.hpp>

namespace vkvol {

std::string devices_json(const std::vector<DeviceInfo>& devices) {
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
                        {"rayQueries", d.ray_queries},
                        {"conformant", d.conformant},
                        {"usable", d.rejection.empty()},
                        {"rejection", d.rejection}});
    return list.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

} // namespace vkvol
