// What is kept of compiled kernels between runs, in ${XDG_CACHE_HOME:-~/.cache}/vkvol: a VkPipelineCache, one file per
// device and driver, and the kernels that were specialised.
#pragma once

#include <filesystem>
#include <string>

#include "device.h"
#include "kernel_store.h"

namespace vkvol {

class PipelineCache {
public:
    // An unreadable or foreign file counts as empty.
    PipelineCache(const Device& device, bool use_disk);
    ~PipelineCache();
    PipelineCache(const PipelineCache&) = delete;
    PipelineCache& operator=(const PipelineCache&) = delete;

    VkPipelineCache handle() const { return cache_; }
    const KernelStore& kernels() const { return kernels_; }
    // Writes the file if it has changed; failure to write is no error, only a slower next start.
    void save() const;

private:
    const Device& device_;
    KernelStore kernels_;
    std::filesystem::path path_;  // empty: memory only
    mutable std::string on_disk_; // digest of what the file has
    VkPipelineCache cache_ = VK_NULL_HANDLE;
};

// Mesa keeps a cache of its own, beside ours, and maps its index from a sparse file: where the disk is full that ends
// the process with SIGBUS. To be called before a driver is loaded, and before there are threads: Mesa is told by its
// environment.
void forgo_driver_cache_on_full_disk();

} // namespace vkvol
