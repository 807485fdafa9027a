#include "pipeline_cache.h"

#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <unistd.h>

#include "vulkan_error.h"

namespace vkvol {

namespace {

std::filesystem::path cache_directory() {
    if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg && *xdg)
        return std::filesystem::path(xdg) / "vkvol";
    if (const char* home = std::getenv("HOME"); home && *home)
        return std::filesystem::path(home) / ".cache" / "vkvol";
    return {};
}

// The file name holds all that makes a cache valid; the header inside is checked too, since files get copied.
std::string file_name(const VkPhysicalDeviceProperties& p) {
    std::string uuid;
    for (std::uint8_t byte : p.pipelineCacheUUID)
        uuid += fmt::format("{:02x}", byte);
    return fmt::format("{:x}-{:x}-{:x}-{}.bin", p.vendorID, p.deviceID, p.driverVersion, uuid);
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

} // namespace

PipelineCache::PipelineCache(const Device& device, bool use_disk) : device_(device) {
    std::vector<char> data;
    if (const std::filesystem::path directory = cache_directory(); use_disk && !directory.empty()) {
        path_ = directory / file_name(device.properties());
        std::ifstream file(path_, std::ios::binary);
        data.assign(std::istreambuf_iterator<char>(file), {});
        if (!header_fits(data, device.properties()))
            data.clear();
    }
    loaded_bytes_ = data.size();
    VkPipelineCacheCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO;
    create.initialDataSize = data.size();
    create.pInitialData = data.data();
    VK_CHECK(vkCreatePipelineCache(device.handle(), &create, nullptr, &cache_));
}

PipelineCache::~PipelineCache() {
    vkDestroyPipelineCache(device_.handle(), cache_, nullptr);
}

void PipelineCache::save() const {
    std::size_t size = 0;
    if (path_.empty() || vkGetPipelineCacheData(device_.handle(), cache_, &size, nullptr) != VK_SUCCESS ||
        size == loaded_bytes_)
        return;
    std::vector<char> data(size);
    if (vkGetPipelineCacheData(device_.handle(), cache_, &size, data.data()) != VK_SUCCESS)
        return;
    std::error_code error;
    std::filesystem::create_directories(path_.parent_path(), error);
    const std::filesystem::path temporary = fmt::format("{}.{}", path_.string(), getpid());
    std::ofstream(temporary, std::ios::binary).write(data.data(), static_cast<std::streamsize>(size));
    std::filesystem::rename(temporary, path_, error);
    if (error)
        std::filesystem::remove(temporary, error);
}

} // namespace vkvol
