// One kernel with its specialization, ready to be recorded.
#pragma once

#include <memory>
#include <span>

#include "bindings.h"
#include "shared/frame.h"
#include "specialization.h"

namespace vkvol {

class Pipeline;
class PipelineCache;

class ComputePass {
public:
    ComputePass(const Device& device, const Bindings& bindings, std::span<const std::uint32_t> spirv,
                const Specialization& specialization, const PipelineCache* cache);

    // At least `threads` invocations, in whole groups.
    void record(VkCommandBuffer commands, const shared::PassPush& push, std::uint32_t threads) const;
    // Groups read from `arguments` at `offset`.
    void record_indirect(VkCommandBuffer commands, const shared::PassPush& push, const Buffer& arguments,
                         VkDeviceSize offset) const;

private:
    void bind(VkCommandBuffer commands, const shared::PassPush& push) const;

    const Bindings& bindings_;
    VkPipelineLayout layout_;
    std::shared_ptr<const Pipeline> pipeline_;
};

} // namespace vkvol
