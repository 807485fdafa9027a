#include "tev_picture.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <memory>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include "error.h"
#include "film_channels.h"
#include "interrupt.h"

namespace vkvol {

namespace {

static_assert(std::endian::native == std::endian::little, "packets are written as they lie in memory");

using Clock = std::chrono::steady_clock;

constexpr timeval patience{5, 0}; // to connect
// For a viewer to take a picture, whole, or as long as one of its size takes over half a gigabit a second; where the
// render is to end, the little that others need.
constexpr std::chrono::milliseconds to_take{5000}, to_take_at_last{500};
constexpr std::size_t bytes_a_millisecond = 60000;
constexpr std::size_t largest_packet = 64u << 20u; // bytes of pixels; larger pictures go some rows at a time

enum class PacketType : char { create_image = 4, update_image = 6 };

class Packet {
public:
    explicit Packet(PacketType type) : bytes_(4, '\0') { bytes_ += static_cast<char>(type); }
    template <class T> Packet& add(const T& value) {
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
        return *this;
    }
    Packet& text(const std::string& value) {
        bytes_.append(value.c_str(), value.size() + 1);
        return *this;
    }
    Packet& data(const void* begin, std::size_t size) {
        bytes_.append(static_cast<const char*>(begin), size);
        return *this;
    }
    const std::string& finished() {
        const auto size = static_cast<std::uint32_t>(bytes_.size());
        std::memcpy(bytes_.data(), &size, sizeof size);
        return bytes_;
    }

private:
    std::string bytes_;
};

using Addresses = std::unique_ptr<addrinfo, decltype(&freeaddrinfo)>;

Addresses look_up(const std::string& address) {
    const std::size_t colon = address.rfind(':');
    if (colon == std::string::npos || colon == 0 || colon + 1 == address.size())
        throw InputError(fmt::format("--tev: '{}' is not HOST:PORT; e.g. --tev={}", address, tev_address));
    std::string host = address.substr(0, colon);
    if (host.starts_with('[') && host.ends_with(']')) // whose numbers have colons of their own
        host = host.substr(1, host.size() - 2);
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    if (const int error = getaddrinfo(host.c_str(), address.substr(colon + 1).c_str(), &hints, &found); error != 0)
        throw InputError(
            fmt::format("--tev: {}: {}; expected HOST:PORT, e.g. --tev={}", address, gai_strerror(error), tev_address));
    return {found, freeaddrinfo};
}

int connect_to(const std::string& address) {
    int error = 0;
    const Addresses addresses = look_up(address);
    for (const addrinfo* each = addresses.get(); each; each = each->ai_next) {
        const int made = socket(each->ai_family, each->ai_socktype | SOCK_CLOEXEC, each->ai_protocol);
        if (made < 0) {
            error = errno;
            continue;
        }
        setsockopt(made, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience); // of connect() as well
        if (connect(made, each->ai_addr, each->ai_addrlen) == 0)
            return made;
        error = errno;
        close(made);
        if (interrupted())
            throw Interrupted("interrupted before tev had answered");
    }
    throw InputError(fmt::format("--tev: {} takes no picture: {}; start tev first, or say where it listens: "
                                 "--tev=HOST:PORT",
                                 address, std::strerror(error == EINPROGRESS ? ETIMEDOUT : error)));
}

} // namespace

TevPicture::TevPicture(const std::string& address, const std::string& name)
    : address_(address), name_(name), socket_(connect_to(address)) {}

TevPicture::~TevPicture() {
    close(socket_);
}

void TevPicture::show(const Film& film, const ToneMapping&) {
    begun_ = Clock::now();
    const std::vector<std::string> channels = channel_names(film);
    if (!is_there_)
        create(film, channels);
    is_there_ = true;
    update(film, channels);
}

void TevPicture::create(const Film& film, const std::vector<std::string>& channels) {
    Packet packet(PacketType::create_image);
    packet.add(true).text(name_).add(std::int32_t{film.width()}).add(std::int32_t{film.height()});
    packet.add(static_cast<std::int32_t>(channels.size()));
    for (const std::string& channel : channels)
        packet.text(channel);
    send(packet.finished());
}

// In as many rows at a time as a packet takes.
void TevPicture::update(const Film& film, const std::vector<std::string>& channels) {
    const auto count = static_cast<std::int64_t>(channels.size());
    std::vector<std::uint32_t> pixels = interleaved_channels(film);
    for (std::size_t i = samples_channel; i < pixels.size(); i += channels.size())
        pixels[i] = std::bit_cast<std::uint32_t>(static_cast<float>(pixels[i]));
    to_take_ = std::max(to_take, std::chrono::milliseconds(4 * pixels.size() / bytes_a_millisecond));
    const std::size_t row = std::size_t(film.width()) * channels.size();
    const int rows = static_cast<int>(std::max<std::size_t>(largest_packet / (4 * row), 1));
    for (int y = 0; y < film.height(); y += rows) {
        const int here = std::min(rows, film.height() - y);
        Packet packet(PacketType::update_image);
        packet.add(false).text(name_).add(static_cast<std::int32_t>(count));
        for (const std::string& channel : channels)
            packet.text(channel);
        packet.add(std::int32_t{0}).add(std::int32_t{y}).add(std::int32_t{film.width()}).add(std::int32_t{here});
        for (std::int64_t channel = 0; channel < count; ++channel)
            packet.add(channel); // where its first pixel is
        for (std::int64_t channel = 0; channel < count; ++channel)
            packet.add(count); // from one of its pixels to the next
        packet.data(&pixels[y * row], 4 * here * row);
        if (!send(packet.finished()))
            return;
    }
}

bool TevPicture::send(const std::string& packet) {
    for (std::size_t sent = 0; failure_.empty() && sent < packet.size();) {
        pollfd ready{socket_, POLLOUT, 0};
        poll(&ready, 1, 100);
        const ssize_t taken = ::send(socket_, packet.data() + sent, packet.size() - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
        const int error = taken > 0 ? 0 : errno;
        const Clock::duration limit = interrupted() ? to_take_at_last : to_take_;
        if (taken > 0)
            sent += static_cast<std::size_t>(taken);
        if (sent < packet.size() && Clock::now() - begun_ > limit)
            failure_ = fmt::format("tev at {} takes pictures too slowly", address_);
        else if (error != 0 && error != EINTR && error != EAGAIN)
            failure_ = fmt::format("tev at {} takes no more pictures: {}", address_, std::strerror(error));
    }
    return failure_.empty();
}

} // namespace vkvol
