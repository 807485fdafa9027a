// The device buffers that hold a scene: its frame parameters, grids, tables and meshes.
#pragma once

#include <optional>
#include <vector>

#include "bindings.h"
#include "commands.h"
#include "light_table.h"
#include "loaded_medium.h"
#include "shared/frame.h"
#include "surface_table.h"
#include "upload_layout.h"

namespace vkvol {

class SceneBuffers {
public:
    // Uploads what `media` hold; `whole`: of several, else null. Grids of more than `most_grid_bytes` together are laid
    // into windows; nothing that has more than `most_texel_bytes` is read as texels. Throws InputError if grids are too
    // large for the device, naming the limit and the remedy.
    SceneBuffers(const Device& device, Commands& commands, Media media, const Superposition* whole,
                 std::uint64_t most_grid_bytes, std::uint64_t most_texel_bytes);

    // Several media: a row for each, and what look-ups read of them. Throws InputError if they are too many for the
    // device.
    void upload_media(const Device& device, Commands& commands, const std::vector<shared::MediumParams>& rows,
                      const std::vector<std::uint32_t>& overlaps, std::uint64_t most_texel_bytes);

    // Where flux is read, render space. Throws InputError if they are too many for the device.
    void upload_points(const Device& device, Commands& commands, const std::vector<glm::vec3>& points);

    // `sky`: null without a map. Throws InputError if that is too large for the device.
    void upload_lights(const Device& device, Commands& commands, const LightTable& table, const SkyMap* sky);

    // What particles come from. Throws InputError if it is too much for the device.
    void upload_emitters(const Device& device, Commands& commands, const std::vector<shared::EmitterRow>& rows);

    // In the buffer of the sky's texels, behind these.
    void upload_textures(const Device& device, Commands& commands, const std::vector<glm::vec4>& texels,
                         const SkyMap* sky);

    // `before`: the hierarchy that the surfaces' follows in the same buffer.
    void upload_surfaces(const Device& device, Commands& commands, const SurfaceTable& table,
                         const std::vector<shared::BvhNode>& before);

    // The buffers of `frame` that kernels reach by address are put into it.
    void set_frame(Commands& commands, shared::FrameParams frame);

    // log2 of the words in a window; none: the grids lie in one storage buffer, or there are none.
    std::optional<std::uint32_t> window_bits() const { return window_bits_; }

    // Whether all that kernels read at every step of a walk can be read as texels.
    bool texels() const { return texels_; }
    // Once lights, surfaces and textures are here: whether their tables, the hierarchy and the sky can; then they are
    // bound so, too.
    bool find_table_texels(std::uint64_t most_bytes);

    BoundBuffers bound() const;
    std::uint64_t bytes() const;

private:
    using Parts = UploadLayout::Parts;

    void upload_alone(const Device& device, Commands& commands, const LoadedMedium& medium);
    void find_texels(std::uint64_t most_bytes);
    void make_grids(const Device& device, Commands& commands, const Parts& grids, std::uint64_t most_bytes);
    void make_windows(const Device& device, Commands& commands, const Parts& grids, std::uint64_t bytes,
                      std::uint64_t most_bytes);

    Buffer frame_;
    std::optional<Buffer> grids_, leaf_table_, majorants_, controls_, blackbody_, triangles_, bvh_;
    std::optional<Buffer> lights_, light_tree_, sky_, sky_alias_, phase_, media_, overlaps_, maps_;
    std::optional<Buffer> surfaces_, primitives_, points_, emitters_;
    std::vector<Buffer> windows_;
    bool texels_ = false, table_texels_ = false;
    std::optional<std::uint32_t> window_bits_;
};

} // namespace vkvol
