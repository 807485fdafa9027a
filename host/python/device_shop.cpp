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

// The first that had a shop; locks that its threads held stay locked in others.
std::atomic<pid_t> process_of_shops = 0;

std::atomic<bool> ending = false;

bool is_forked() {
    const pid_t first = process_of_shops;
    return first != 0 && first != ::getpid();
}

[[noreturn]] void refuse_fork() {
    throw RenderError("this process was forked from one that has used a device, and what works beside it does so there "
                      "alone; start workers anew: multiprocessing.get_context(\"spawn\")");
}

} // namespace

Turn::Turn(DeviceShop& shop, const std::function<bool()>& interrupted) : shop_(shop) {
    if (shop.process != ::getpid())
        refuse_fork();
    if (shop.owner_ == std::this_thread::get_id())
        throw RenderError("a session of this device is rendering on this thread: what it calls, progress or a signal's "
                          "handler, cannot use one");
    while (!shop.mutex_.try_lock_for(std::chrono::milliseconds(100)))
        if (interrupted && interrupted())
            throw RenderError("interrupted while another session was rendering");
    if (ending) {
        shop.mutex_.unlock();
        throw RenderError("Python is ending: nothing is rendered any more");
    }
    shop.owner_ = std::this_thread::get_id();
}

Turn::~Turn() {
    shop_.clear_retired();
    shop_.owner_ = std::thread::id();
    shop_.mutex_.unlock();
    shop_.clear_retired_if_idle(); // what came between the first two
}

void retire(const std::shared_ptr<DeviceShop>& shop, std::shared_ptr<void> things) {
    if (shop->process != ::getpid()) {
        new std::shared_ptr<void>(std::move(things));
        new std::shared_ptr<DeviceShop>(shop);
        return;
    }
    {
        const std::lock_guard lock(shop->retired_mutex_);
        shop->retired_.push_back(std::move(things));
    }
    if (shop->owner_ != std::this_thread::get_id())
        shop->clear_retired_if_idle();
}

void DeviceShop::clear_retired() {
    std::vector<std::shared_ptr<void>> gone;
    const std::lock_guard lock(retired_mutex_);
    gone.swap(retired_);
}

void DeviceShop::clear_retired_if_idle() {
    if (const std::unique_lock turn(mutex_, std::try_to_lock); turn)
        clear_retired();
}

void check_not_forked() {
    if (is_forked())
        refuse_fork();
}

std::shared_ptr<DeviceShop> device_shop(const DeviceOptions& options) {
    check_not_forked();
    process_of_shops = ::getpid();
    const std::lock_guard lock(mutex);
    std::shared_ptr<DeviceShop>& shop = shops()[{options.choice, options.validate, options.robust}];
    if (!shop)
        shop = std::make_shared<DeviceShop>(options);
    return shop;
}

void forget_device_shop(const DeviceShop& shop) {
    const std::lock_guard lock(mutex);
    std::erase_if(shops(), [&](const auto& entry) { return entry.second.get() == &shop; });
}

void DeviceShop::wait_until_idle() {
    const std::unique_lock turn(mutex_, std::chrono::seconds(10)); // else something hangs, and so would we
}

void close_device_shops() {
    if (is_forked())
        return;
    ending = true;
    std::map<Key, std::shared_ptr<DeviceShop>> all;
    {
        const std::lock_guard lock(mutex);
        all.swap(shops());
    }
    for (const auto& [key, shop] : all)
        if (shop) // there is a device of that name
            shop->wait_until_idle();
}

bool is_ending() {
    return ending;
}

} // namespace vkvol::python
