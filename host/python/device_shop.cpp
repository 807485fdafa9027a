#include "device_shop.h"

#include <map>
#include <tuple>

namespace vkvol::python {

namespace {

using Key = std::tuple<std::string, bool, bool>;

std::mutex mutex;
std::map<Key, std::shared_ptr<DeviceShop>>& shops() {
    static auto* all = new std::map<Key, std::shared_ptr<DeviceShop>>; // outlives drivers, which end at exit as well
    return *all;
}

} // namespace

std::shared_ptr<DeviceShop> device_shop(const DeviceOptions& options) {
    const std::lock_guard lock(mutex);
    std::shared_ptr<DeviceShop>& shop = shops()[{options.choice, options.validate, options.robust}];
    if (!shop)
        shop = std::make_shared<DeviceShop>(options);
    return shop;
}

void close_device_shops() {
    const std::lock_guard lock(mutex);
    shops().clear();
}

} // namespace vkvol::python
