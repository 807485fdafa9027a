#include "view_server.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <httplib.h>
#include <iterator>
#include <list>
#include <mutex>
#include <nlohmann/json.hpp>
#include <sys/random.h>
#include <thread>
#include <unistd.h>

#include "error.h"
#include "image_io.h"
#include "tone_choice.h"
#include "view_json.h"
#include "view_page.h"

namespace vkvol {

namespace {

using httplib::Request;
using httplib::Response;

constexpr auto longest_wait = std::chrono::milliseconds(1000); // for a new picture
constexpr std::size_t largest_wish = 1u << 20u;                // bytes
constexpr std::size_t threads = 32;                            // tabs of a browser keep one each, and sometimes two

std::string random_key() {
    std::array<unsigned char, 16> bytes{};
    for (std::size_t got = 0; got < bytes.size();) {
        const ssize_t more = getrandom(bytes.data() + got, bytes.size() - got, 0);
        if (more < 0 && errno != EINTR)
            throw RenderError(fmt::format("no random numbers for the viewer's key: {}", std::strerror(errno)));
        got += more > 0 ? static_cast<std::size_t>(more) : 0;
    }
    return fmt::format("{:02x}", fmt::join(bytes, ""));
}

// In a time that does not tell how much of it is right.
bool is_equal(const std::string& given, const std::string& key) {
    unsigned different = given.size() == key.size() ? 0 : 1;
    for (std::size_t i = 0; i < key.size(); ++i)
        different |= static_cast<unsigned char>(key[i]) ^ static_cast<unsigned char>(i < given.size() ? given[i] : 0);
    return different == 0;
}

// 0 for what is none.
template <class Number> Number number_of(const Request& request, const char* name) {
    const std::string text = request.get_param_value(name);
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() ? value : Number{};
}

ToneRequest tone_of(const Request& request) {
    ToneRequest tone;
    tone.curve = find_tone_curve(request.get_param_value("curve"));
    if (const std::string exposure = request.get_param_value("exposure"); exposure == "auto")
        tone.automatic_exposure = true;
    else if (!exposure.empty())
        tone.exposure = std::clamp(number_of<double>(request, "exposure"), -100.0, 100.0);
    if (tone.exposure && std::isnan(*tone.exposure))
        tone.exposure = 0.0;
    return tone;
}

// As files of the command line's are made, so that they have the same bytes.
std::string image_file(const Shot& shot, const char* name, const ToneRequest& request) {
    std::string folder = (std::filesystem::temp_directory_path() / "vkvol-view-XXXXXX").string();
    if (!mkdtemp(folder.data()))
        throw RenderError(fmt::format("{}: {}", folder, std::strerror(errno)));
    const std::filesystem::path file = std::filesystem::path(folder) / name;
    std::string bytes, failure;
    try {
        const Tone tone = choose_tone(request, shot.film, shot.metadata);
        Metadata metadata = shot.metadata;
        record_tone(request, metadata);
        write_image(file, shot.film, metadata, tone.mapping);
        std::ifstream in(file, std::ios::binary);
        bytes.assign(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
    } catch (const std::exception& error) {
        failure = error.what();
    }
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
    if (!failure.empty())
        throw RenderError(failure);
    return bytes;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
        text.replace(at, from.size(), to);
    return text;
}

} // namespace

bool is_own_address(const std::string& host, int port) {
    for (const char* const name : {"127.0.0.1", "localhost"})
        if (host == fmt::format("{}:{}", name, port) || (port == 80 && host == name))
            return true;
    return false;
}

struct ViewServer::Serving {
    explicit Serving(ViewBoard& with) : board(with) {}

    ViewBoard& board;
    httplib::Server server;
    std::string key = random_key();
    std::string page;
    int port = 0;
    std::thread thread;

    // What many tabs ask for alike is made once.
    struct Made {
        std::string asked;
        std::shared_ptr<const std::string> body;
    };
    std::mutex mutex;
    std::list<Made> made;

    bool knows(const Request& request) const;
    bool has_key(const Request& request) const;
    bool refuses(const Request& request, Response& response) const;
    void route();
    static void answer(Response& response, const std::function<void()>& content);
    std::shared_ptr<const std::string> frame(const std::shared_ptr<const Shot>& shot, const Request& request);
    void send_watched(const std::shared_ptr<const std::string>& body, Response& response) const;
    void send_file(const Request& request, Response& response, const char* ending, const char* type);
};

// Pages of other sites can send a browser here, by any name that leads to this machine, but do not know the key.
bool ViewServer::Serving::knows(const Request& request) const {
    return is_own_address(request.get_header_value("Host"), port) && has_key(request);
}

bool ViewServer::Serving::has_key(const Request& request) const {
    return is_equal(request.get_param_value("key"), key);
}

// Before any body is read: of strangers none is, and a body without a length could be of any. What is not there is not
// for strangers to know either.
bool ViewServer::Serving::refuses(const Request& request, Response& response) const {
    response.set_header("Cache-Control", "no-store");
    response.set_header("Referrer-Policy", "no-referrer");
    response.set_header("X-Content-Type-Options", "nosniff");
    if (!knows(request)) {
        response.status = 403;
        response.set_content(
            has_key(request)
                ? fmt::format("This is another address than the one printed: open 127.0.0.1:{0}; from another machine "
                              "forward its port {0}, by this number.\n",
                              port)
                : "The address is not complete: vkvol view has printed one with a key.\n",
            "text/plain");
        return true;
    }
    if (!request.has_header("Transfer-Encoding"))
        return false;
    response.status = 411;
    response.set_content("a body needs its Content-Length\n", "text/plain");
    return true;
}

void ViewServer::Serving::answer(Response& response, const std::function<void()>& content) {
    try {
        content();
    } catch (const InputError& error) {
        response.status = 400;
        response.set_content(error.what(), "text/plain");
    } catch (const std::exception& error) {
        response.status = 500;
        response.set_content(error.what(), "text/plain");
    }
}

// The state as JSON behind its length in four bytes, little-endian, and then the pixels.
std::shared_ptr<const std::string> ViewServer::Serving::frame(const std::shared_ptr<const Shot>& shot,
                                                              const Request& request) {
    std::uint64_t wish_number = 0;
    const ViewWish wish = board.wish(&wish_number);
    const std::string asked = fmt::format("{} {} {} {}", shot ? shot->version : 0, wish_number,
                                          request.get_param_value("exposure"), request.get_param_value("curve"));
    const std::scoped_lock lock(mutex);
    for (const Made& each : made)
        if (each.asked == asked)
            return each.body;
    const ShownLayer shown =
        shot ? show_layer(shot->film, shot->sketch.get(), wish.layer, tone_of(request), shot->metadata) : ShownLayer{};
    const std::string state = state_json(shot.get(), shown, wish, wish_number, board.message());
    std::string body;
    for (unsigned byte = 0; byte < 4; ++byte)
        body += static_cast<char>(state.size() >> 8 * byte & 255u);
    body += state;
    body.append(shown.rgba.begin(), shown.rgba.end());
    made.push_front({asked, std::make_shared<const std::string>(std::move(body))});
    if (made.size() > 4)
        made.pop_back();
    return made.front().body;
}

// Who is being sent a picture is looking, however slow the way.
void ViewServer::Serving::send_watched(const std::shared_ptr<const std::string>& body, Response& response) const {
    static constexpr std::size_t piece = 1 << 18;
    response.set_content_provider(body->size(), "application/octet-stream",
                                  [this, body](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
                                      board.see();
                                      return sink.write(body->data() + offset, std::min(length, piece));
                                  });
}

void ViewServer::Serving::send_file(const Request& request, Response& response, const char* ending, const char* type) {
    const std::shared_ptr<const Shot> shot = board.shot();
    if (!shot || !shot->scene || shot->film.pixel_count() == 0)
        throw InputError("there is no picture yet");
    const bool is_scene = std::string(ending) == ".xml";
    if (shot->scene->has_grids && is_scene)
        throw InputError(
            "grids of this scene stand in it, and in no file that a scene could name; vkvol convert writes them "
            "beside it\n");
    const std::string name = std::filesystem::path(shot->scene->name).stem().string() +
                             (shot->is_sketch && !is_scene ? "-sketch" : "") + ending;
    response.set_header("Content-Disposition",
                        fmt::format("attachment; filename=\"{}\"", replaced(replaced(name, "\"", "_"), "\\", "_")));
    response.set_content(is_scene ? shot->scene->xml
                                  : image_file(*shot, ("picture" + std::string(ending)).c_str(), tone_of(request)),
                         type);
}

void ViewServer::Serving::route() {
    server.set_pre_routing_handler([this](const Request& request, Response& response) {
        return refuses(request, response) ? httplib::Server::HandlerResponse::Handled
                                          : httplib::Server::HandlerResponse::Unhandled;
    });
    server.Get("/", [this](const Request&, Response& response) {
        answer(response, [&] {
            // Nothing but this page's own script and style runs in it.
            const std::string nonce = random_key();
            response.set_header("Content-Security-Policy",
                                fmt::format("default-src 'none'; script-src 'nonce-{0}'; style-src 'nonce-{0}'; "
                                            "connect-src 'self'; base-uri 'none'; form-action 'none'; "
                                            "frame-ancestors 'none'",
                                            nonce));
            response.set_content(replaced(page, "{{nonce}}", nonce), "text/html; charset=utf-8");
        });
    });
    server.Get("/frame", [this](const Request& request, Response& response) {
        answer(response, [&] {
            const auto since = number_of<std::uint64_t>(request, "since");
            const std::shared_ptr<const Shot> shot = board.next_shot(since, longest_wait);
            if (const std::uint64_t version = shot ? shot->version : 0; version == since && since != 0) {
                response.status = 204; // nothing new
                return;
            }
            send_watched(frame(shot, request), response);
        });
    });
    server.Post("/wish", [this](const Request& request, Response& response) {
        answer(response, [&] {
            const std::uint64_t number = board.want(wish_of(request.body));
            response.set_content(nlohmann::json{{"wish", number}}.dump(), "application/json");
        });
    });
    server.Get("/picture.exr", [this](const Request& request, Response& response) {
        answer(response, [&] { send_file(request, response, ".exr", "image/x-exr"); });
    });
    server.Get("/picture.png", [this](const Request& request, Response& response) {
        answer(response, [&] { send_file(request, response, ".png", "image/png"); });
    });
    server.Get("/scene.xml", [this](const Request& request, Response& response) {
        answer(response, [&] { send_file(request, response, ".xml", "application/xml"); });
    });
    server.set_error_handler([](const Request&, Response& response) {
        if (response.status == 404)
            response.set_content("not here\n", "text/plain");
    });
}

ViewServer::ViewServer(ViewBoard& board, int port, const std::vector<std::string>& integrators)
    : serving_(std::make_unique<Serving>(board)) {
    Serving& serving = *serving_;
    serving.page = replaced(view_page, "{{integrators}}", nlohmann::json(integrators).dump());
    serving.server.new_task_queue = [] { return new httplib::ThreadPool(threads); };
    serving.server.set_payload_max_length(largest_wish);
    serving.server.set_keep_alive_timeout(2);
    serving.server.set_tcp_nodelay(true);
    serving.server.set_socket_options([](socket_t socket) { // but not a port that another program listens at
        const int yes = 1;
        setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    serving.route();
    constexpr const char* loopback = "127.0.0.1";
    serving.port = port;
    if (port == 0)
        serving.port = serving.server.bind_to_any_port(loopback);
    else if (!serving.server.bind_to_port(loopback, port))
        serving.port = -1;
    if (serving.port < 0)
        throw InputError(fmt::format("--port: {} cannot be had on {}; another program may have it, give another, or "
                                     "none for any that is free",
                                     port, loopback));
    serving.thread = std::thread([&serving] { serving.server.listen_after_bind(); });
    while (!serving.server.is_running()) // or stop() would not know of it
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

ViewServer::~ViewServer() {
    serving_->board.close();
    serving_->server.stop();
    serving_->thread.join();
}

std::string ViewServer::address() const {
    return fmt::format("http://127.0.0.1:{}/?key={}", serving_->port, serving_->key);
}

} // namespace vkvol
