// vkvol: command line in, exit code out. The only place that catches.

#include <cstdio>
#include <exception>
#include <new>

#include "compare.h"
#include "device_command.h"
#include "error.h"
#include "info.h"
#include "integrators_command.h"
#include "merge.h"
#include "options.h"
#include "render_command.h"

namespace {

int run(const vkvol::Options& options) {
    switch (options.command) {
    case vkvol::Command::render:
        return vkvol::run_render(options.render);
    case vkvol::Command::devices:
        return vkvol::run_devices(options.devices_json);
    case vkvol::Command::info:
        return vkvol::run_info(options.info_file);
    case vkvol::Command::integrators:
        return vkvol::run_integrators(options.integrators_json);
    case vkvol::Command::compare:
        return vkvol::run_compare(options.compare);
    case vkvol::Command::merge:
        return vkvol::run_merge(options.merge);
    case vkvol::Command::print:
        std::fputs(options.text.c_str(), stdout);
        break;
    }
    return vkvol::exit_done;
}

int complain(const char* message, vkvol::ExitCode code) {
    std::fprintf(stderr, "vkvol: error: %s\n", message);
    return code;
}

} // namespace

int main(int argc, char** argv) {
    try {
        return run(vkvol::parse_options(argc, argv));
    } catch (const vkvol::InputError& e) {
        return complain(e.what(), vkvol::exit_bad_input);
    } catch (const vkvol::DeviceError& e) {
        return complain(e.what(), vkvol::exit_no_device);
    } catch (const std::bad_alloc&) {
        return complain("out of memory; use a smaller picture or a quantised grid", vkvol::exit_render_failed);
    } catch (const std::exception& e) {
        return complain(e.what(), vkvol::exit_render_failed);
    }
}
