// VkPipelineCache kept in ${XDG_CACHE_HOME:-~/.cache}/vkvol between runs, one file per device and driver.
#pragma once

#include <filesystem>

#include "device.h"

namespace vkvol {

class PipelineCache {
public:
    // An unreadable or foreign file counts as empty.
    PipelineCache(const Device& device, bool use_disk);
    ~PipelineCache();
    PipelineCache(const PipelineCache&) = delete;
    PipelineCache& operator=(const PipelineCache&) = delete;

    VkPipelineCache handle() const { return cache_; }
    // Writes the file if it has changed; failure to write is no error, only a slower next start.
    void save() const;

private:
    const Device& device_;
    std::filesystem::path path_; // empty: memory only
    std::size_t loaded_bytes_ = 0;
    VkPipelineCache cache_ = VK_NULL_HANDLE;
};

} // namespace vkvol
