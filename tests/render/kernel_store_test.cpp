// Specialised kernels that are kept as files.
#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "fused.spv.h"
#include "kernel_store.h"
#include "prepare.spv.h"
#include "support/test_directory.h"

using namespace vkvol;
namespace fs = std::filesystem;

namespace {

Specialization with_steps(int steps) {
    Specialization constants{};
    constants[SPEC_STEPS] = steps;
    return constants;
}

std::vector<fs::path> files_in(const fs::path& directory) {
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(directory))
        files.push_back(entry.path());
    return files;
}

std::string bytes_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

} // namespace

TEST_CASE("a specialised kernel is kept, and read again", "[cpu][specialization]") {
    const TestDirectory directory;
    const fs::path kernels = directory.path / "kernels";
    const KernelStore store(kernels);
    const auto expected = specialized(fused_spv, with_steps(3));
    CHECK(store.get(fused_spv, with_steps(3)) == expected);
    REQUIRE(files_in(kernels).size() == 1);
    const fs::path file = files_in(kernels).front();
    const std::string bytes = bytes_of(file);
    CHECK(store.get(fused_spv, with_steps(3)) == expected);
    CHECK(KernelStore(kernels).get(fused_spv, with_steps(3)) == expected); // another process
    CHECK(bytes_of(file) == bytes);

    SECTION("it is read, not made") {
        // A kernel in its place, with a digest that fits, is what comes.
        const auto other = specialized(fused_spv, with_steps(4));
        CHECK(store.get(fused_spv, with_steps(4)) == other);
        REQUIRE(files_in(kernels).size() == 2);
        for (const fs::path& each : files_in(kernels))
            if (each != file)
                fs::rename(each, file);
        CHECK(store.get(fused_spv, with_steps(3)) == other);
    }
    SECTION("what a kernel does not declare makes no other of it") {
        store.get(prepare_spv, with_steps(3));
        store.get(prepare_spv, with_steps(4));
        CHECK(files_in(kernels).size() == 2);
    }
    SECTION("a damaged file is made again") {
        for (const std::string& damaged : {std::string(), bytes.substr(0, 15), bytes.substr(0, bytes.size() - 4),
                                           bytes.substr(0, 200) + "x" + bytes.substr(201), bytes + "rest"}) {
            std::ofstream(file, std::ios::binary) << damaged;
            CHECK(store.get(fused_spv, with_steps(3)) == expected);
            CHECK(bytes_of(file) == bytes);
        }
    }
    SECTION("a directory that cannot be made is no error") {
        std::ofstream(directory.path / "file") << "x";
        CHECK(KernelStore(directory.path / "file" / "kernels").get(fused_spv, with_steps(3)) == expected);
        CHECK(KernelStore({}).get(fused_spv, with_steps(3)) == expected);
    }
}

TEST_CASE("of many specialised kernels those that were not used for longest go", "[cpu][specialization]") {
    const TestDirectory directory;
    const KernelStore unbounded(directory.path);
    using Clock = fs::file_time_type::clock;
    std::uintmax_t bytes = 0;
    for (int steps = 1; steps <= 4; ++steps) {
        unbounded.get(prepare_spv, {});
        const auto before = files_in(directory.path);
        unbounded.get(fused_spv, with_steps(steps));
        for (const fs::path& file : files_in(directory.path))
            if (std::find(before.begin(), before.end(), file) == before.end()) {
                fs::last_write_time(file, Clock::now() - std::chrono::hours(10 - steps));
                fs::rename(file, directory.path / (std::to_string(steps) + ".spv"));
                bytes = std::max(bytes, fs::file_size(directory.path / (std::to_string(steps) + ".spv")));
            }
    }
    std::ofstream(directory.path / "notes.txt") << "of somebody else";
    KernelStore(directory.path, 4 * bytes).get(fused_spv, with_steps(8)); // a fifth: half of the bound is left
    CHECK_FALSE(fs::exists(directory.path / "1.spv"));
    CHECK_FALSE(fs::exists(directory.path / "2.spv"));
    CHECK_FALSE(fs::exists(directory.path / "3.spv"));
    CHECK(fs::exists(directory.path / "notes.txt"));
    CHECK(files_in(directory.path).size() >= 3); // it, the newest one, and the notes
}
