// What a viewer gets by tev's protocol, read by a stand-in that knows nothing of how it is written.
#include <arpa/inet.h>
#include <bit>
#include <catch2/catch.hpp>
#include <cstring>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

#include "error.h"
#include "support/command_folder.h"
#include "tev_picture.h"

using namespace vkvol;
using Catch::Contains;

namespace {

// Takes one connection, and all that comes until it ends or `most` bytes are there, with pauses after 64 KiB each. If
// it is `gone` afterwards nobody listens any more.
class Viewer {
public:
    explicit Viewer(std::size_t most = SIZE_MAX, std::chrono::milliseconds pause = {}, bool gone = false)
        : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        REQUIRE(bind(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0);
        REQUIRE(listen(socket_, 1) == 0);
        socklen_t size = sizeof address;
        getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
        port_ = ntohs(address.sin_port);
        thread_ = std::thread([this, most, pause, gone] {
            const int connection = accept(socket_, nullptr, nullptr);
            if (gone)
                shutdown(socket_, SHUT_RDWR);
            char bytes[65536];
            for (ssize_t got = 1; got > 0 && bytes_.size() < most;) {
                got = recv(connection, bytes, sizeof bytes, 0);
                bytes_.append(bytes, got > 0 ? std::size_t(got) : 0);
                std::this_thread::sleep_for(pause);
            }
            close(connection);
        });
    }
    ~Viewer() {
        if (thread_.joinable())
            thread_.join();
        close(socket_);
    }
    std::string address() const { return fmt::format("127.0.0.1:{}", port_); }
    const std::string& bytes() {
        if (thread_.joinable())
            thread_.join();
        return bytes_;
    }

private:
    int socket_ = -1, port_ = 0;
    std::thread thread_;
    std::string bytes_;
};

class Reader {
public:
    explicit Reader(const std::string& bytes) : bytes_(bytes) {}
    template <class T> T next() {
        T value;
        REQUIRE(at_ + sizeof value <= bytes_.size());
        std::memcpy(&value, &bytes_[at_], sizeof value);
        at_ += sizeof value;
        return value;
    }
    std::string text() {
        const std::string value = bytes_.c_str() + at_;
        at_ += value.size() + 1;
        return value;
    }
    std::size_t at() const { return at_; }
    bool over() const { return at_ == bytes_.size(); }

private:
    const std::string& bytes_;
    std::size_t at_ = 0;
};

Film film_of(int width, int height) {
    Film film;
    film.picture_width = width;
    film.picture_height = height;
    film.crop = {0, width, 0, height};
    FilmLayer depth{"depth", {}, {}};
    for (int i = 0; i < width * height; ++i) {
        film.mean.emplace_back(i, i + 0.25f, -i);
        film.variance.emplace_back(0.5f * i);
        film.samples.push_back(std::uint32_t(i) + 7);
        depth.mean.emplace_back(100.0f + i);
    }
    film.layers = {depth};
    return film;
}

} // namespace

TEST_CASE("tev gets a picture with all its channels", "[cpu][live]") {
    Viewer viewer;
    const Film film = film_of(3, 2);
    {
        TevPicture picture(viewer.address(), "a.exr");
        picture.show(film, {});
        picture.show(film, {});
        CHECK(picture.failure().empty());
    }
    const std::string& bytes = viewer.bytes();
    Reader reader(bytes);
    const std::vector<std::string> channels = {"R",          "G",          "B",       "variance.R",
                                               "variance.G", "variance.B", "samples", "depth.Z"};
    const auto size = reader.next<std::uint32_t>();
    CHECK(reader.next<char>() == 4); // makes a picture
    reader.next<char>();
    CHECK(reader.text() == "a.exr");
    CHECK(reader.next<std::int32_t>() == 3);
    CHECK(reader.next<std::int32_t>() == 2);
    REQUIRE(reader.next<std::int32_t>() == 8);
    for (const std::string& channel : channels)
        CHECK(reader.text() == channel);
    CHECK(reader.at() == size);
    for (int shown = 0; shown < 2; ++shown) {
        const std::size_t begin = reader.at();
        const auto packet = reader.next<std::uint32_t>();
        CHECK(reader.next<char>() == 6); // its pixels, with places and strides
        CHECK(reader.next<char>() == 0);
        CHECK(reader.text() == "a.exr");
        REQUIRE(reader.next<std::int32_t>() == 8);
        for (const std::string& channel : channels)
            CHECK(reader.text() == channel);
        for (const int window : {0, 0, 3, 2})
            CHECK(reader.next<std::int32_t>() == window);
        std::vector<std::int64_t> offsets, strides;
        for (int c = 0; c < 8; ++c)
            offsets.push_back(reader.next<std::int64_t>());
        for (int c = 0; c < 8; ++c)
            strides.push_back(reader.next<std::int64_t>());
        std::vector<float> values;
        for (int i = 0; i < 6 * 8; ++i)
            values.push_back(reader.next<float>());
        for (int pixel = 0; pixel < 6; ++pixel) {
            const float expected[] = {float(pixel), pixel + 0.25f, float(-pixel), 0.5f * pixel,
                                      0.5f * pixel, 0.5f * pixel,  pixel + 7.0f,  100.0f + pixel};
            for (int c = 0; c < 8; ++c)
                CHECK(values.at(std::size_t(offsets[c] + pixel * strides[c])) == expected[c]);
        }
        CHECK(reader.at() - begin == packet);
    }
    CHECK(reader.over());
}

TEST_CASE("a viewer that is not there, or goes away", "[cpu][live]") {
    CHECK_THROWS_WITH(TevPicture("127.0.0.1:1", "a"), Contains("127.0.0.1:1") && Contains("start tev"));
    CHECK_THROWS_WITH(TevPicture("[::1]:1", "a"), Contains("start tev"));
    CHECK_THROWS_WITH(TevPicture("nowhere", "a"), Contains("HOST:PORT"));
    CHECK_THROWS_WITH(TevPicture(":5", "a"), Contains("HOST:PORT"));
    CHECK_THROWS_WITH(TevPicture("127.0.0.1:port", "a"), Contains("HOST:PORT"));
    Viewer viewer(1);
    TevPicture picture(viewer.address(), "a");
    const Film film = film_of(512, 512);
    for (int i = 0; i < 20 && picture.failure().empty(); ++i)
        picture.show(film, {});
    CHECK_THAT(picture.failure(), Contains(viewer.address()));
    picture.show(film, {}); // which it does not mind
}

TEST_CASE("a sequence goes on where its viewer has gone", "[gpu][live]") {
    const Folder folder("");
    folder.write("ball.xml",
                 "<options><sphere/><sigma_a>1</sigma_a><width>8</width><height>8</height><camera z='${= 5+F}'/>"
                 "<rayPerPixelCount>2</rayPerPixelCount><backgroundColor r='1'/></options>");
    const Viewer viewer(SIZE_MAX, {}, true);
    const Run all = folder.vkvol(fmt::format("ball.xml -f 1..3 -o a.#.exr --tev={}", viewer.address()));
    INFO(all.text);
    CHECK(all.code == exit_done);
    for (const char* frame : {"a.1.exr", "a.2.exr", "a.3.exr"})
        CHECK(std::filesystem::exists(folder.file(frame)));
    const std::string told = "further frames are not shown";
    CHECK_THAT(all.text, Contains(told));
    CHECK(all.text.find(told) == all.text.rfind(told));
    // Where there never was one nothing is rendered.
    CHECK(folder.vkvol(fmt::format("ball.xml -f 4..5 -o a.#.exr --tev={}", viewer.address())).code == exit_bad_input);
    CHECK_FALSE(std::filesystem::exists(folder.file("a.4.exr")));
}

// 29 MB, at 1.3 MB a second at most.
TEST_CASE("a viewer that takes pictures slowly is given up", "[cpu][live]") {
    Viewer viewer(SIZE_MAX, std::chrono::milliseconds(50));
    TevPicture picture(viewer.address(), "a");
    const auto begun = std::chrono::steady_clock::now();
    picture.show(film_of(1024, 1024), {});
    CHECK_THAT(picture.failure(), Contains("too slowly"));
    CHECK(std::chrono::steady_clock::now() - begun < std::chrono::seconds(10));
}
