// What renders of one device share: the device and what is compiled for it. One render at a time works there.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <unistd.h>
#include <vector>

#include "workshop.h"

namespace vkvol::python {

struct DeviceShop {
    explicit DeviceShop(const DeviceOptions& options) : devices(workshop.devices(options)) {}

    Workshop workshop{false};
    const std::vector<const Device*> devices; // at least one, which leads
    const Device& device = *devices.front();
    const pid_t process = ::getpid(); // after os.fork() the other one has none of the driver's threads

    void wait_until_idle();

private:
    friend class Turn;
    friend void retire(const std::shared_ptr<DeviceShop>& shop, std::shared_ptr<void> things);
    void clear_retired();
    void clear_retired_if_idle();

    std::timed_mutex mutex_; // never asked for with Python's lock held
    std::atomic<std::thread::id> owner_{};
    std::mutex retired_mutex_; // of the following, and of nothing that lasts
    std::vector<std::shared_ptr<void>> retired_;
};

// Whoever works in the shop. A render calls what Python wants to be called, and that may come here again, on the same
// thread: RenderError. `interrupted`, asked while others have their turn, ends the wait: RenderError as well; so does a
// shop of the process that this one was forked from, and any once Python is ending.
class Turn {
public:
    explicit Turn(DeviceShop& shop, const std::function<bool()>& interrupted = {});
    ~Turn();
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

private:
    DeviceShop& shop_;
};

// Destroys what has buffers of the device: at once, or at the end of the turn that somebody has. Never waits for that:
// whoever lets go of a session may hold what that turn waits for. In another process it is left where it is.
void retire(const std::shared_ptr<DeviceShop>& shop, std::shared_ptr<void> things);

// Throws RenderError in a process forked from one that had any shop.
void check_not_forked();

// The same for the same options. Throws DeviceError, or RenderError in a process forked from one that had some.
std::shared_ptr<DeviceShop> device_shop(const DeviceOptions& options);

// A device that was lost stays so, for the sessions that have it; the next get another shop.
void forget_device_shop(const DeviceShop& shop);

// At the end of Python, without its lock: nobody begins a turn from now on, and those who have one end it, since they
// are told that they are interrupted; drivers must not work while the process tears them down. Then forgets all shops;
// they end with the sessions that have them.
void close_device_shops();
bool is_ending();

} // namespace vkvol::python
