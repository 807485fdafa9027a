#include "pipeline_cache.h"

#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <mutex>
#include <system_error>

#include "atomic_file.h"
#include "cache_directory.h"
#include "digest.h"
#include "vulkan_error.h"

namespace vkvol {

namespace {

std::vector<char> read_if_possible(const std::filesystem::path& path) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
        return {};
    // Its size is asked of the open file: another process may put a longer one in its place meanwhile.
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    std::vector<char> data(file ? static_cast<std::size_t>(file.tellg()) : 0);
    file.seekg(0);
    return file.read(data.data(), static_cast<std::streamsize>(data.size())) ? data : std::vector<char>{};
}

// The file name holds all that makes a cache valid; the header inside is checked too, since files get copied.
std::string pipeline_file_name(const VkPhysicalDeviceProperties& p) {
    std::string uuid;
    for (std::uint8_t byte : p.pipelineCacheUUID)
        uuid += fmt::format("{:02x}", byte);
    return fmt::format("{:x}-{:x}-{:x}-{}.bin", p.vendorID, p.deviceID, p.driverVersion, uuid);
}

// Behind the data stands their digest. Drivers take data for what they once gave, and need not survive others.
constexpr std::size_t digest_bytes = 16;

bool take_digest(std::vector<char>& data) {
    if (data.size() < digest_bytes)
        return false;
    const std::string digest(data.end() - digest_bytes, data.end());
    data.resize(data.size() - digest_bytes);
    return digest == digest_text({data.data(), data.size()});
}

bool header_fits(const std::vector<char>& data, const VkPhysicalDeviceProperties& p) {
    VkPipelineCacheHeaderVersionOne header;
    if (data.size() < sizeof(header))
        return false;
    std::memcpy(&header, data.data(), sizeof(header));
    return header.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE && header.vendorID == p.vendorID &&
           header.deviceID == p.deviceID &&
           std::memcmp(header.pipelineCacheUUID, p.pipelineCacheUUID, VK_UUID_SIZE) == 0;
}

std::filesystem::path kernel_directory(bool use_disk) {
    const std::filesystem::path directory = cache_directory();
    return use_disk && !directory.empty() ? directory / "kernels" : std::filesystem::path();
}

} // namespace

PipelineCache::PipelineCache(const Device& device, bool use_disk)
    : device_(device), kernels_(kernel_directory(use_disk)) {
    std::vector<char> data;
    if (const std::filesystem::path directory = cache_directory(); use_disk && !directory.empty()) {
        path_ = directory / pipeline_file_name(device.properties());
        data = read_if_possible(path_);
        if (!take_digest(data) || !header_fits(data, device.properties()))
            data.clear();
    }
    on_disk_ = digest_text({data.data(), data.size()});
    VkPipelineCacheCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO;
    create.initialDataSize = data.size();
    create.pInitialData = data.data();
    // A header that fits may stand before data that a driver refuses.
    if (vkCreatePipelineCache(device.handle(), &create, nullptr, &cache_) != VK_SUCCESS) {
        create.initialDataSize = 0;
        VK_CHECK(vkCreatePipelineCache(device.handle(), &create, nullptr, &cache_));
    }
}

void forgo_driver_cache_on_full_disk() {
    constexpr std::uintmax_t enough = 16u << 20; // the index takes 1.3 MB, kernels some kB each
    const char* own = std::getenv("MESA_SHADER_CACHE_DIR");
    std::filesystem::path directory = own ? own : "";
    if (directory.empty())
        directory = cache_home();
    std::error_code error;
    while (directory.has_relative_path() && !std::filesystem::exists(directory, error))
        directory = directory.parent_path();
    const std::filesystem::space_info space = std::filesystem::space(directory, error);
    if (!error && space.available < enough)
        setenv("MESA_SHADER_CACHE_DISABLE", "true", 0);
}

PipelineCache::~PipelineCache() {
    vkDestroyPipelineCache(device_.handle(), cache_, nullptr);
}

void PipelineCache::save() const {
    std::size_t size = 0;
    if (path_.empty() || vkGetPipelineCacheData(device_.handle(), cache_, &size, nullptr) != VK_SUCCESS)
        return;
    std::vector<char> data(size);
    if (vkGetPipelineCacheData(device_.handle(), cache_, &size, data.data()) != VK_SUCCESS)
        return;
    static std::mutex mutex; // of devices of one kind, whose file is the same
    const std::scoped_lock lock(mutex);
    const std::string digest = digest_text({data.data(), size});
    if (digest == on_disk_)
        return;
    try {
        std::filesystem::create_directories(path_.parent_path());
        AtomicFile file(path_);
        file.write(data.data(), size, 0);
        file.write(digest.data(), digest.size(), static_cast<std::int64_t>(size));
        file.put_in_place();
        on_disk_ = digest;
    } catch (const std::system_error&) {
        // Said in the header.
    }
}

} // namespace vkvol
