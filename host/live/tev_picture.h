// A picture in tev (Müller's viewer of high dynamic range, github.com/Tom94/tev), by its protocol: packets over TCP,
// little-endian, each a length of 32 bits that counts itself, a byte for what it is, and fields; texts end in a zero.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "live_picture.h"

namespace vkvol {

inline constexpr const char* tev_address = "127.0.0.1:14158"; // where it listens by default

class TevPicture : public LivePicture {
public:
    // `address`: HOST:PORT; `name`: what tev calls the picture. Throws InputError if nobody listens there.
    TevPicture(const std::string& address, const std::string& name);
    ~TevPicture() override;
    TevPicture(const TevPicture&) = delete;
    TevPicture& operator=(const TevPicture&) = delete;

    // All channels of the film. It is made there when it is first shown.
    void show(const Film& film, const ToneMapping& mapping) override;
    std::string failure() const override { return failure_; }

private:
    void create(const Film& film, const std::vector<std::string>& channels);
    void update(const Film& film, const std::vector<std::string>& channels);
    bool send(const std::string& packet);

    std::string address_, name_;
    int socket_ = -1;
    std::chrono::steady_clock::time_point begun_; // with the picture that is being sent
    std::chrono::milliseconds to_take_{5000};
    bool is_there_ = false;
    std::string failure_;
};

} // namespace vkvol
