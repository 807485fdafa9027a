// vkvol: command line in, exit code out. The only place where errors become exit codes.

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fcntl.h>
#include <new>
#include <poll.h>
#include <unistd.h>

#include "bench.h"
#include "compare.h"
#include "convert.h"
#include "develop.h"
#include "device_command.h"
#include "error.h"
#include "file_limit.h"
#include "info.h"
#include "init.h"
#include "integrators_command.h"
#include "interrupt.h"
#include "measure.h"
#include "merge.h"
#include "options.h"
#include "printable.h"
#include "render_command.h"
#include "software_lanes.h"
#include "view.h"

namespace {

// A file opened while one of the three standard streams is closed would take its number, and what is told its bytes. A
// reader who has seen enough is no reason to die.
void prepare_process() {
    while (true) {
        const int descriptor = open("/dev/null", O_RDWR);
        if (descriptor > 2)
            close(descriptor);
        if (descriptor < 0 || descriptor > 2)
            break;
    }
    vkvol::install_file_limit_handler();
    std::signal(SIGPIPE, SIG_IGN);
    vkvol::take_all_lanes();
}

// As in `vkvol info cloud.nvdb | head -1`.
bool is_reader_gone() {
    pollfd out{STDOUT_FILENO, POLLOUT, 0};
    return poll(&out, 1, 0) > 0 && (out.revents & POLLERR);
}

int run(const vkvol::Options& options) {
    switch (options.command) {
    case vkvol::Command::render:
        return vkvol::run_render(options.render);
    case vkvol::Command::devices:
        return vkvol::run_devices(options.devices_json);
    case vkvol::Command::info:
        return vkvol::run_info(options.info_file, options.info_json);
    case vkvol::Command::integrators:
        return vkvol::run_integrators(options.integrators_json);
    case vkvol::Command::compare:
        return vkvol::run_compare(options.compare);
    case vkvol::Command::merge:
        return vkvol::run_merge(options.merge);
    case vkvol::Command::develop:
        return vkvol::run_develop(options.develop);
    case vkvol::Command::convert:
        return vkvol::run_convert(options.convert);
    case vkvol::Command::init:
        return vkvol::run_init(options.init);
    case vkvol::Command::measure:
        return vkvol::run_measure(options.measure);
    case vkvol::Command::view:
        return vkvol::run_view(options.view);
    case vkvol::Command::bench:
        return vkvol::run_bench(options.bench);
    case vkvol::Command::print:
        std::fputs(options.text.c_str(), stdout);
        break;
    }
    return vkvol::exit_done;
}

int complain(const char* message, vkvol::ExitCode code) {
    std::fprintf(stderr, "vkvol: error: %s\n", vkvol::printable(message).c_str());
    return code;
}

int run_and_complain(int argc, char** argv) {
    try {
        const vkvol::Options options = vkvol::parse_options(argc, argv);
        const int code = run(options);
        // What a render prints is a word about its pictures; what the others print is their result.
        const bool is_result =
            options.command != vkvol::Command::render || options.render.trace || options.render.dry_run;
        const bool taken = std::fflush(stdout) == 0 && std::ferror(stdout) == 0; // long texts were written before
        if (!taken && is_result && !is_reader_gone())
            return complain("standard output takes no more: the result is incomplete; check free space",
                            vkvol::exit_render_failed);
        return code;
    } catch (const vkvol::InputError& e) {
        return complain(e.what(), vkvol::exit_bad_input);
    } catch (const vkvol::DeviceError& e) {
        return complain(e.what(), vkvol::exit_no_device);
    } catch (const vkvol::Interrupted& e) {
        return complain(e.what(), vkvol::exit_interrupted);
    } catch (const std::bad_alloc&) {
        return complain("out of memory; use a smaller picture, fewer at a time, or a quantised grid",
                        vkvol::exit_render_failed);
    } catch (const std::exception& e) {
        return complain(e.what(), vkvol::exit_render_failed);
    }
}

} // namespace

int main(int argc, char** argv) {
    prepare_process();
    const int code = run_and_complain(argc, argv);
    std::fflush(stdout);
    // Without the shutdown of libraries that we do not know: OpenBLAS, which OpenImageIO brings, waits for ever for its
    // threads where memory is short.
    std::_Exit(code);
}
