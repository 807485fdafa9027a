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
    std::uint32_t samples() const { return session_->samples(); }
    const std::vector<std::string>& warnings() const { return scene_.warnings; }
    const std::string& assumed() const { return assumed_; }

private:
    RenderRequest request_;
    std::shared_ptr<DeviceShop> shop_;
    std::string assumed_;
    Scene scene_;
    RenderJob job_;
    std::unique_ptr<Session> session_;
};

} // namespace vkvol::python
