// Compiled kernels of a device: who needs the same kernel again, for the next frame or the next picture, finds it.
#pragma once

#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vulkan/vulkan.h>

#include "specialization.h"

namespace vkvol {

class PipelineCache;
class PipelineLayout;

class Pipeline {
public:
    // Takes over `handle`.
    Pipeline(VkDevice device, VkPipeline handle) : device_(device), handle_(handle) {}
    ~Pipeline() { vkDestroyPipeline(device_, handle_, nullptr); }
    Pipeline(const Pipeline&) = delete;
    Pipeline& operator=(const Pipeline&) = delete;

    VkPipeline handle() const { return handle_; }

private:
    VkDevice device_;
    VkPipeline handle_;
};

using SharedPipeline = std::shared_ptr<const Pipeline>;

// Any number of threads may ask. Those asked for last are kept, so that a long row of unlike scenes does not fill the
// memory.
class Pipelines {
public:
    // Kernels take 2 to 5 MB each on llvmpipe. `keep_loops`: see loops_kept().
    Pipelines(VkDevice device, const PipelineLayout& layout, bool keep_loops = false, std::size_t most_kept = 128)
        : device_(device), layout_(layout), keep_loops_(keep_loops), most_kept_(most_kept) {}

    // `spirv`, one of the kernels within this program, with these constants; compiled unless it is here. `cache` may be
    // null, and nothing is kept between runs then. Throws RenderError.
    SharedPipeline get(std::span<const std::uint32_t> spirv, const Specialization& specialization,
                       const PipelineCache* cache);

private:
    // Where the kernel lies, and the constants that it has.
    using Key = std::pair<const std::uint32_t*, Specialization>;
    struct Entry {
        std::shared_future<SharedPipeline> pipeline;
        std::uint64_t last_use;
    };

    // True if it is the caller's to compile.
    bool enter(const Key& key, std::promise<SharedPipeline>& promise, std::shared_future<SharedPipeline>& pipeline);
    void forget(const Key& key);
    void drop_oldest();

    VkDevice device_;
    const PipelineLayout& layout_;
    bool keep_loops_;
    std::size_t most_kept_;
    std::mutex mutex_;
    std::uint64_t uses_ = 0;
    std::map<Key, Entry> entries_;
};

} // namespace vkvol
