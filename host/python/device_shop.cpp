#include "device_shop.h"

#include <chrono>
#include <map>
#include <tuple>

#include "error.h"

namespace vkvol::python {

namespace {

using Key = std::tuple<std::string, bool, bool>;

std::mutex mutex;
std::map<Key, std::shared_ptr<DeviceShop>>& shops() {
    static auto* all = new std::map<Key, std::shared_ptr<DeviceShop>>; // outlives drivers, which end at exit as well
    return *all;
}

} // namespace

Turn::Turn(DeviceShop& shop, const std::function<bool()>& interrupted) : shop_(shop) {
    if (shop.owner_ == std::this_thread::get_id())
        throw RenderError("a session of this device is rendering on this thread: what it calls, progress or a signal's "
                          "handler, cannot use one");
    while (!shop.mutex_.try_lock_for(std::chrono::milliseconds(100)))
        if (interrupted && interrupted())
            throw RenderError("interrupted while another session was rendering");
    shop.owner_ = std::this_thread::get_id();
}

Turn::~Turn() {
    shop_.retired_.clear();
    shop_.owner_ = std::thread::id();
    shop_.mutex_.unlock();
}

void retire(const std::shared_ptr<DeviceShop>& shop, std::shared_ptr<void> things) {
    if (shop->owner_ == std::this_thread::get_id()) {
        shop->retired_.push_back(std::move(things));
        return;
    }
    const Turn turn(*shop);
    things.reset();
}

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
