// What renders of one device share: the device and what is compiled for it. One render at a time works there.
#pragma once

#include <memory>
#include <mutex>

#include "workshop.h"

namespace vkvol::python {

struct DeviceShop {
    explicit DeviceShop(const DeviceOptions& options) : device(workshop.device(options)) {}

    std::mutex mutex; // held by who uses the rest; never asked for with Python's lock held
    Workshop workshop{false};
    const Device& device;
};

// The same for the same options. Throws DeviceError.
std::shared_ptr<DeviceShop> device_shop(const DeviceOptions& options);

// Forgets them; they end with the sessions that have them.
void close_device_shops();

} // namespace vkvol::python
