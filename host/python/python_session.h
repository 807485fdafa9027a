// A render as Python holds it: samples as wanted, with Python's lock free while it works.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "device_shop.h"
#include "python_picture.h"
#include "scene_source.h"
#include "session.h"

namespace vkvol::python {

// Called without Python's lock.
struct Callbacks {
    std::function<void(double samples, std::optional<double> noise)> progress; // may be empty
    std::function<bool()> interrupted;
};

class PythonSession {
public:
    // Reads the scene, uploads it and compiles its kernels. Throws InputError, DeviceError and RenderError.
    PythonSession(const SceneSource& source, const RenderRequest& request, bool strict, Callbacks callbacks);
    ~PythonSession();

    // Until every pixel has `samples` in all; none: as many as were asked for with the session.
    void render(std::optional<std::uint32_t> samples);
    PythonPicture picture();
    std::uint32_t samples() const { return work_->session->samples(); }
    const std::vector<std::string>& warnings() const { return warnings_; }
    const std::string& assumed() const { return assumed_; }

private:
    struct Work { // what ends in a turn of its device
        Scene scene;
        RenderJob job;
        std::unique_ptr<Session> session;
    };

    void on_device(const std::function<void()>& work);

    RenderRequest request_;
    std::shared_ptr<DeviceShop> shop_;
    std::string assumed_;
    std::vector<std::string> warnings_;
    std::shared_ptr<Work> work_ = std::make_shared<Work>();
};

} // namespace vkvol::python
