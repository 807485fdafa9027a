#include "pipelines.h"

#include <algorithm>

#include "pipeline_cache.h"
#include "pipeline_layout.h"
#include "vulkan_error.h"

namespace vkvol {

namespace {
SharedPipeline compile(VkDevice device, const std::vector<std::uint32_t>& code, VkPipelineLayout layout,
                       VkPipelineCache cache) {
    VkShaderModuleCreateInfo module_info{};
    module_info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    module_info.codeSize = code.size() * sizeof(std::uint32_t);
    module_info.pCode = code.data();
    VkShaderModule module = VK_NULL_HANDLE;
    VK_CHECK(vkCreateShaderModule(device, &module_info, nullptr, &module));

    VkComputePipelineCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    create.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    create.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    create.stage.module = module;
    create.stage.pName = "main";
    create.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    const VkResult result = vkCreateComputePipelines(device, cache, 1, &create, nullptr, &pipeline);
    vkDestroyShaderModule(device, module, nullptr);
    check_vulkan(result, "vkCreateComputePipelines", __FILE__, __LINE__);
    return std::make_shared<const Pipeline>(device, pipeline);
}
} // namespace

SharedPipeline Pipelines::get(std::span<const std::uint32_t> spirv, const Specialization& specialization,
                              const PipelineCache* cache) {
    const Key key{spirv.data(), declared_of(spirv, specialization)};
    std::promise<SharedPipeline> promise;
    std::shared_future<SharedPipeline> pipeline;
    if (enter(key, promise, pipeline))
        try {
            const std::vector<std::uint32_t> code =
                cache ? cache->kernels().get(spirv, specialization) : specialized(spirv, specialization);
            promise.set_value(compile(device_, keep_loops_ ? loops_kept(code) : code, layout_.handle(),
                                      cache ? cache->handle() : VK_NULL_HANDLE));
        } catch (...) {
            forget(key); // who waits for it hears of this failure, who comes later tries again
            promise.set_exception(std::current_exception());
        }
    return pipeline.get();
}

bool Pipelines::enter(const Key& key, std::promise<SharedPipeline>& promise,
                      std::shared_future<SharedPipeline>& pipeline) {
    const std::lock_guard lock(mutex_);
    const auto [entry, is_new] = entries_.try_emplace(key);
    if (is_new)
        entry->second.pipeline = promise.get_future().share();
    entry->second.last_use = ++uses_;
    pipeline = entry->second.pipeline;
    if (entries_.size() > most_kept_)
        drop_oldest();
    return is_new;
}

void Pipelines::forget(const Key& key) {
    const std::lock_guard lock(mutex_);
    entries_.erase(key);
}

// Passes that still use it keep it.
void Pipelines::drop_oldest() {
    entries_.erase(std::min_element(entries_.begin(), entries_.end(), [](const auto& a, const auto& b) {
        return a.second.last_use < b.second.last_use;
    }));
}

} // namespace vkvol
