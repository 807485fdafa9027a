// The Python module vkvol._vkvol: what vkvol/__init__.py is made of, which has the documentation. A thin layer: nothing
// is decided here but what Python's objects come to.
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <unistd.h>

#include "device_json.h"
#include "error.h"
#include "image_io.h"
#include "integrators.h"
#include "interrupt.h"
#include "memory_grids.h"
#include "printable.h"
#include "python_session.h"
#include "software_lanes.h"
#include "version.h"

namespace py = pybind11;

namespace vkvol::python {

namespace {

using FloatArray = py::array_t<float, py::array::f_style | py::array::forcecast>; // x fastest

// What Python raises while this program works on this thread ends the work, and is raised when that has come to rest.
thread_local std::unique_ptr<py::error_already_set> raised;

bool ask() {
    if (is_ending())
        return true;
    const py::gil_scoped_acquire acquire;
    if (!raised && PyErr_CheckSignals() != 0)
        raised = std::make_unique<py::error_already_set>();
    return raised != nullptr;
}

// A daemon thread that asks for Python's lock at the interpreter's end is to be unwound, which would let go of Python's
// objects without that lock, and pass through destructors that must not throw: it rests until the process is gone.
[[noreturn]] void rest() {
    for (;;)
        ::pause();
}

// Without Python's lock. A forced unwind is an exception without an object.
template <class Work> void run(const Work& work) {
    std::exception_ptr failure;
    PyThreadState* const state = PyEval_SaveThread();
    try {
        const InterruptQuestion question(&ask);
        work();
    } catch (...) {
        failure = std::current_exception();
        if (!failure)
            rest();
    }
    try {
        PyEval_RestoreThread(state);
    } catch (...) {
        rest();
    }
    if (const auto error = std::move(raised)) // which is why
        throw py::error_already_set(*error);
    if (failure)
        std::rethrow_exception(failure);
}

// One grid by an array of shape (nx, ny, nz), or (nx, ny, nz, 3) of colours.
MemoryGrids::Grid grid_of(const std::string& name, const FloatArray& array, const GridPlace& place) {
    const bool is_color = array.ndim() == 4 && array.shape(3) == 3;
    if (array.ndim() != 3 && !is_color)
        throw InputError("grid \"" + name +
                         "\": expected an array of shape (nx, ny, nz), or (nx, ny, nz, 3) of colours");
    glm::ivec3 dims;
    for (int axis = 0; axis < 3; ++axis) {
        if (array.shape(axis) < 1 || array.shape(axis) > 65536)
            throw InputError("grid \"" + name + "\": each edge of the array is 1 to 65536");
        dims[axis] = static_cast<int>(array.shape(axis));
    }
    const std::size_t voxels = std::size_t(dims.x) * std::size_t(dims.y) * std::size_t(dims.z);
    const float* data = array.data();
    MemoryGrids::Grid grid{name, {}};
    run([&] {
        if (!is_color) {
            grid = {name, make_grid(name, dims, std::span(data, voxels), place)};
            return;
        }
        std::vector<glm::vec3> colors(voxels); // the array has its channels one after another
        for (std::size_t i = 0; i < voxels; ++i)
            colors[i] = {data[i], data[voxels + i], data[2 * voxels + i]};
        grid = {name, make_grid(name, dims, std::span<const glm::vec3>(colors), place)};
    });
    return grid;
}

std::shared_ptr<MemoryGrids> grids_of(const std::vector<std::pair<std::string, FloatArray>>& arrays,
                                      const std::array<double, 3>& voxel_size, const std::array<double, 3>& origin) {
    for (const double edge : voxel_size)
        if (!(edge >= 1e-11 && edge <= 1e11))
            throw InputError("voxel_size: expected 1e-11 to 1e11");
    const auto grids = std::make_shared<MemoryGrids>();
    for (const auto& [name, array] : arrays)
        grids->grids.push_back(
            grid_of(name, array, {{voxel_size[0], voxel_size[1], voxel_size[2]}, {origin[0], origin[1], origin[2]}}));
    return grids;
}

ToneRequest tone_of(const std::optional<std::string>& curve, const py::object& exposure) {
    ToneRequest tone;
    if (curve && !(tone.curve = find_tone_curve(*curve)))
        throw InputError("tonemap: '" + *curve + "' is none of srgb, aces, agx, reinhard");
    if (exposure.is_none())
        return tone;
    if (py::isinstance<py::str>(exposure)) {
        if (exposure.cast<std::string>() != "auto")
            throw InputError("exposure: expected a number of stops, or \"auto\"");
        tone.automatic_exposure = true;
        return tone;
    }
    try {
        tone.exposure = exposure.cast<double>();
    } catch (const py::cast_error&) {
        throw InputError("exposure: expected a number of stops, or \"auto\"");
    }
    if (!(std::abs(*tone.exposure) <= 100.0))
        throw InputError("exposure: expected -100 to 100 stops");
    return tone;
}

// Rows, columns and channels of an image; a copy.
py::array_t<float> channels_of(const Film& film, const std::vector<glm::vec3>& values, int channels = 3) {
    std::vector<py::ssize_t> shape = {film.height(), film.width()};
    if (channels > 1)
        shape.push_back(channels);
    py::array_t<float> array(shape);
    float* to = array.mutable_data();
    for (const glm::vec3& value : values)
        for (int channel = 0; channel < channels; ++channel)
            *to++ = value[channel];
    return array;
}

py::dict layers_of(const Film& film, std::vector<glm::vec3> FilmLayer::*values) {
    py::dict layers;
    for (const FilmLayer& layer : film.layers)
        if (!(layer.*values).empty())
            layers[py::str(layer.name)] =
                channels_of(film, layer.*values, static_cast<int>(std::string(layer.channels()).size()));
    return layers;
}

py::array_t<std::uint32_t> samples_of(const Film& film) {
    py::array_t<std::uint32_t> array({film.height(), film.width()});
    std::copy(film.samples.begin(), film.samples.end(), array.mutable_data());
    return array;
}

py::array_t<std::uint8_t> develop(const PythonPicture& picture, const std::optional<std::string>& curve,
                                  const py::object& exposure) {
    const std::vector<std::uint8_t> bytes = developed(picture, tone_of(curve, exposure));
    py::array_t<std::uint8_t> array({picture.film.height(), picture.film.width(), 3});
    std::copy(bytes.begin(), bytes.end(), array.mutable_data());
    return array;
}

// Set by name, from a dict that vkvol/__init__.py has checked.
template <class Value, class Member> void set(const py::dict& options, const char* name, Member& member) {
    if (options.contains(name))
        member = options[name].cast<Value>();
}

RenderRequest request_of(const py::dict& options) {
    RenderRequest request;
    set<std::uint32_t>(options, "spp", request.spp);
    set<std::uint32_t>(options, "seed", request.seed);
    set<std::uint32_t>(options, "sample_offset", request.sample_offset);
    set<double>(options, "time", request.time_limit);
    set<double>(options, "noise", request.noise_goal);
    set<int>(options, "width", request.width);
    set<int>(options, "height", request.height);
    set<std::string>(options, "integrator", request.integrator);
    set<std::string>(options, "aov", request.aov);
    set<bool>(options, "alpha", request.alpha);
    set<bool>(options, "frame", request.frame);
    set<std::filesystem::path>(options, "grid", request.grid);
    set<std::string>(options, "device", request.device.choice);
    set<bool>(options, "validate", request.device.validate);
    if (options.contains("crop"))
        request.crop = CropRequest{options["crop"].cast<std::array<double, 4>>(), false};
    if (options.contains("schedule")) {
        const auto name = options["schedule"].cast<std::string>();
        request.plan.schedule = name == "fused"    ? Schedule::fused
                                : name == "staged" ? Schedule::staged
                                                   : Schedule::automatic;
    }
    return request;
}

// Who is told of this thread's render. Python's objects are kept only meanwhile: nothing that refers to a session can
// be found by Python's collector through it.
class Told {
public:
    explicit Told(const py::object& progress) : before_(now_) { now_ = &progress; }
    ~Told() { now_ = before_; }
    Told(const Told&) = delete;
    Told& operator=(const Told&) = delete;

    static void tell(double samples, std::optional<double> noise) {
        if (is_ending())
            return;
        const py::gil_scoped_acquire acquire;
        if (raised || !now_ || now_->is_none())
            return;
        try {
            (*now_)(samples, noise);
        } catch (py::error_already_set& error) {
            raised = std::make_unique<py::error_already_set>(error);
        }
    }

private:
    static thread_local const py::object* now_;
    const py::object* const before_;
};

thread_local const py::object* Told::now_ = nullptr;

class SessionObject {
public:
    SessionObject(const SceneSource& source, const py::dict& options, bool strict) {
        Callbacks callbacks;
        callbacks.progress = &Told::tell;
        callbacks.interrupted = &ask;
        const RenderRequest request = request_of(options);
        run([&] { session_ = std::make_unique<PythonSession>(source, request, strict, std::move(callbacks)); });
    }
    ~SessionObject() {
        const py::gil_scoped_release release;
        session_.reset();
    }
    SessionObject(const SessionObject&) = delete;
    SessionObject& operator=(const SessionObject&) = delete;

    std::uint32_t render(std::optional<std::uint32_t> samples, const py::object& progress) {
        const Told told(progress);
        run([&] { session_->render(samples); });
        return session_->samples();
    }

    PythonPicture picture() {
        PythonPicture picture;
        run([&] { picture = session_->picture(); });
        return picture;
    }

    const PythonSession& session() const { return *session_; }

private:
    std::unique_ptr<PythonSession> session_;
};

// Names of files may be no UTF-8.
std::vector<std::string> printable_all(std::vector<std::string> texts) {
    for (std::string& text : texts)
        text = printable(text, true);
    return texts;
}

void add_errors(py::module_& module) {
    const py::exception<std::exception> error(module, "Error");
    const py::handle value_error = PyExc_ValueError, runtime_error = PyExc_RuntimeError;
    static const py::exception<InputError> input_error(module, "InputError", py::make_tuple(error, value_error));
    static const py::exception<DeviceError> device_error(module, "DeviceError", py::make_tuple(error, runtime_error));
    static const py::exception<RenderError> render_error(module, "RenderError", py::make_tuple(error, runtime_error));
    py::register_exception_translator([](std::exception_ptr thrown) {
        const auto raise = [](const py::object& type, const std::exception& error) {
            PyErr_SetString(type.ptr(), printable(error.what(), true).c_str());
        };
        try {
            if (thrown)
                std::rethrow_exception(thrown);
        } catch (const InputError& error) {
            raise(input_error, error);
        } catch (const DeviceError& error) {
            raise(device_error, error);
        } catch (const RenderError& error) {
            raise(render_error, error);
        }
    });
}

void add_classes(py::module_& module) {
    py::class_<MemoryGrids, std::shared_ptr<MemoryGrids>>(module, "Grids")
        .def(py::init(&grids_of), py::arg("arrays"), py::arg("voxel_size"), py::arg("origin"))
        .def(
            "write",
            [](const MemoryGrids& grids, const std::filesystem::path& file) {
                run([&] { write_text(file, nvdb_file_of(grids), "Grids.write"); });
            },
            py::arg("file"));
    py::class_<SceneSource>(module, "Scene")
        .def(py::init([](std::filesystem::path file, std::optional<std::string> xml, Defines defines,
                         const std::map<std::string, std::shared_ptr<MemoryGrids>>& grids, const std::string& up) {
                 return SceneSource{std::move(file), std::move(xml), std::move(defines),
                                    NamedGrids(grids.begin(), grids.end()), up == "z" ? Up::z : Up::y};
             }),
             py::arg("file"), py::arg("xml"), py::arg("defines"), py::arg("grids"), py::arg("up"));
    py::class_<PythonPicture>(module, "Picture")
        .def_property_readonly("mean", [](const PythonPicture& p) { return channels_of(p.film, p.film.mean); })
        .def_property_readonly("variance", [](const PythonPicture& p) { return channels_of(p.film, p.film.variance); })
        .def_property_readonly("samples", [](const PythonPicture& p) { return samples_of(p.film); })
        .def_property_readonly("layers", [](const PythonPicture& p) { return layers_of(p.film, &FilmLayer::mean); })
        .def_property_readonly("layer_variances",
                               [](const PythonPicture& p) { return layers_of(p.film, &FilmLayer::variance); })
        .def_property_readonly("noise", [](const PythonPicture& p) { return relative_noise(p.film); })
        .def_readonly("report_json", &PythonPicture::report)
        .def_readonly("notes", &PythonPicture::notes)
        .def("develop", &develop, py::arg("tonemap"), py::arg("exposure"))
        .def(
            "write",
            [](const PythonPicture& picture, const std::filesystem::path& file, const std::optional<std::string>& curve,
               const py::object& exposure) {
                const ToneRequest tone = tone_of(curve, exposure);
                run([&] { write_picture(picture, file, tone); });
            },
            py::arg("file"), py::arg("tonemap"), py::arg("exposure"));
    py::class_<SessionObject>(module, "Session")
        .def(py::init<const SceneSource&, const py::dict&, bool>(), py::arg("scene"), py::arg("options"),
             py::arg("strict"))
        .def("render", &SessionObject::render, py::arg("samples"), py::arg("progress"))
        .def("picture", &SessionObject::picture)
        .def_property_readonly("samples", [](const SessionObject& s) { return s.session().samples(); })
        .def_property_readonly("assumed", [](const SessionObject& s) { return printable(s.session().assumed(), true); })
        .def_property_readonly("warnings",
                               [](const SessionObject& s) { return printable_all(s.session().warnings()); });
}

} // namespace

} // namespace vkvol::python

PYBIND11_MODULE(_vkvol, module) {
    using namespace vkvol;
    take_all_lanes();
    python::add_errors(module);
    python::add_classes(module);
    module.attr("version") = version;
    module.def("devices_json", [] { return devices_json(list_devices()); });
    module.def("integrator_names", &integrator_names);
    module.def("layer_names", &layer_names);
    py::module_::import("atexit").attr("register")(
        py::cpp_function(&python::close_device_shops, py::call_guard<py::gil_scoped_release>()));
}
