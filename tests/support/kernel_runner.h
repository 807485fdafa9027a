// Runs a test kernel, which includes the renderer's own .glsl, on a list of inputs and returns what it wrote.
#pragma once

#include <optional>
#include <span>

#include "commands.h"
#include "compute_pass.h"
#include "loaded_medium.h"
#include "scene_buffers.h"
#include "shared/frame.h"
#include "shared/items.h"

namespace vkvol {

// What a kernel finds in the buffers besides its inputs.
struct KernelScene {
    shared::FrameParams frame{};
    const LoadedMedium* volume = nullptr; // its grids, mesh and tables; null where the kernel looks up none
    const LightTable* lights = nullptr;
    const SkyMap* sky = nullptr;
    std::uint64_t most_grid_bytes = 0; // in one buffer; 0: as the device allows. More lie in windows
};

class KernelRunner {
public:
    explicit KernelRunner(std::span<const std::uint32_t> spirv, const Specialization& specialization = {},
                          const KernelScene& scene = {});

    // `threads` invocations (0: one per output) with push.lanes = threads, in as many dispatches as `push` asks:
    // the kernel leaves when its number is not below push.lanes.
    template <class Out, class In>
    std::vector<Out> run(std::span<const In> inputs, std::size_t outputs, std::uint32_t threads = 0) {
        std::vector<Out> result(outputs);
        run_bytes(std::as_bytes(inputs), std::as_writable_bytes(std::span(result)),
                  threads != 0 ? threads : static_cast<std::uint32_t>(outputs));
        return result;
    }
    template <class Out, class In> std::vector<Out> run(const std::vector<In>& inputs, std::size_t outputs = 0) {
        return run<Out>(std::span<const In>(inputs), outputs != 0 ? outputs : inputs.size(),
                        static_cast<std::uint32_t>(inputs.size()));
    }

    // Sums over all runs so far.
    shared::Counters counters();

    shared::PassPush push{};

private:
    void run_bytes(std::span<const std::byte> inputs, std::span<std::byte> outputs, std::uint32_t threads);

    Commands commands_;
    std::optional<SceneBuffers> scene_buffers_;
    Buffer counters_;
    std::optional<Bindings> bindings_;
    std::optional<ComputePass> pass_;
};

} // namespace vkvol
