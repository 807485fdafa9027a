#include "kernel_store.h"

#include <algorithm>
#include <fstream>
#include <mutex>
#include <optional>
#include <spirv-tools/libspirv.h>
#include <string>
#include <string_view>
#include <system_error>

#include "atomic_file.h"
#include "digest.h"

namespace vkvol {

namespace {

namespace fs = std::filesystem;

// All that makes a file's kernel: where two names are equal, so are the kernels.
std::string file_name(std::span<const std::uint32_t> spirv, const Specialization& specialization) {
    Digest digest;
    digest.add_all(spirv);
    digest.add_all(declared_of(spirv, specialization));
    digest.add_all(std::string_view(spvSoftwareVersionDetailsString()));
    digest.add_all(std::string_view(specialization_method));
    return digest.text() + ".spv";
}

std::string digest_of(const std::vector<std::uint32_t>& kernel) {
    return digest_text({reinterpret_cast<const char*>(kernel.data()), kernel.size() * sizeof(std::uint32_t)});
}

// Nothing if there is no such file, or one that ends early or was changed: behind the kernel stands its digest.
std::optional<std::vector<std::uint32_t>> read_kernel_if_possible(const fs::path& path) {
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    constexpr std::size_t digest_bytes = 16;
    const std::size_t size = file ? static_cast<std::size_t>(file.tellg()) : 0;
    if (size <= digest_bytes || (size - digest_bytes) % sizeof(std::uint32_t) != 0)
        return std::nullopt;
    std::vector<std::uint32_t> kernel((size - digest_bytes) / sizeof(std::uint32_t));
    std::string digest(digest_bytes, '\0');
    file.seekg(0);
    file.read(reinterpret_cast<char*>(kernel.data()), static_cast<std::streamsize>(size - digest_bytes));
    file.read(digest.data(), digest_bytes);
    if (!file || digest != digest_of(kernel))
        return std::nullopt;
    return kernel;
}

} // namespace

std::vector<std::uint32_t> KernelStore::get(std::span<const std::uint32_t> spirv,
                                            const Specialization& specialization) const {
    if (directory_.empty())
        return specialized(spirv, specialization);
    const fs::path path = directory_ / file_name(spirv, specialization);
    if (std::optional<std::vector<std::uint32_t>> kept = read_kernel_if_possible(path)) {
        std::error_code unimportant; // of a directory that others may read only
        fs::last_write_time(path, fs::file_time_type::clock::now(), unimportant);
        return *std::move(kept);
    }
    std::vector<std::uint32_t> kernel = specialized(spirv, specialization);
    put(path, kernel);
    return kernel;
}

void KernelStore::put(const fs::path& path, const std::vector<std::uint32_t>& kernel) const {
    static std::mutex mutex; // kernels are compiled on several threads
    const std::scoped_lock lock(mutex);
    try {
        fs::create_directories(directory_);
        const std::string digest = digest_of(kernel);
        const std::size_t bytes = kernel.size() * sizeof(std::uint32_t);
        AtomicFile file(path);
        file.write(kernel.data(), bytes, 0);
        file.write(digest.data(), digest.size(), static_cast<std::int64_t>(bytes));
        file.put_in_place();
        trim();
    } catch (const std::system_error&) {
        // Said in the header.
    }
}

void KernelStore::trim() const {
    struct Kept {
        fs::path path;
        fs::file_time_type used;
        std::uintmax_t bytes;
    };
    std::vector<Kept> files;
    std::uintmax_t total = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(directory_)) {
        std::error_code gone; // other processes trim as well
        const Kept kept{entry.path(), entry.last_write_time(gone), entry.file_size(gone)};
        if (gone || entry.path().extension() != ".spv")
            continue;
        total += kept.bytes;
        files.push_back(kept);
    }
    if (total <= most_bytes_)
        return;
    std::sort(files.begin(), files.end(), [](const Kept& a, const Kept& b) { return a.used < b.used; });
    for (auto oldest = files.begin(); oldest != files.end() && total > most_bytes_ / 2; ++oldest) {
        std::error_code gone;
        fs::remove(oldest->path, gone);
        total -= oldest->bytes;
    }
}

} // namespace vkvol
