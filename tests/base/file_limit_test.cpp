// What grows beyond `ulimit -f` is told to who made it grow.
#include <catch2/catch.hpp>
#include <sys/mman.h>
#include <sys/resource.h>
#include <thread>
#include <unistd.h>

#include "file_limit.h"

using namespace vkvol;

TEST_CASE("the thread whose file may not grow is told so, once", "[cpu][command]") {
    install_file_limit_handler();
    file_limit_met(); // whatever came before
    const int file = memfd_create("limited", 0);
    REQUIRE(file >= 0);
    rlimit usual{};
    REQUIRE(getrlimit(RLIMIT_FSIZE, &usual) == 0);
    rlimit narrow = usual;
    narrow.rlim_cur = 4096;
    REQUIRE(setrlimit(RLIMIT_FSIZE, &narrow) == 0); // nothing may be written until it is as before
    const bool small = ftruncate(file, 4096) == 0 && !file_limit_met();
    const bool large = ftruncate(file, 4097) == 0;
    setrlimit(RLIMIT_FSIZE, &usual);
    close(file);
    CHECK(small);
    CHECK_FALSE(large);
    bool elsewhere = true;
    std::thread([&] { elsewhere = file_limit_met(); }).join();
    CHECK_FALSE(elsewhere);
    CHECK(file_limit_met());
    CHECK_FALSE(file_limit_met());
}
