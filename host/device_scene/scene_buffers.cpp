#include "scene_buffers.h"

#include <algorithm>
#include <bit>
#include <fmt/format.h>

#include "empty_space.h"
#include "error.h"

namespace vkvol {

namespace {

constexpr double mebibyte = 1048576.0;
constexpr VkBufferUsageFlags storage_and_texels =
    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;

template <class T> std::span<const std::byte> bytes_of(const std::vector<T>& values) {
    return std::as_bytes(std::span(values));
}

template <class Parts> std::uint64_t total(const Parts& parts) {
    std::uint64_t bytes = 0;
    for (const std::span<const std::byte> part : parts)
        bytes += part.size();
    return bytes;
}

// The bytes [begin, end) of `parts` to the beginning of a buffer.
template <class Parts>
void upload_range(Commands& commands, const Buffer& buffer, const Parts& parts, std::uint64_t begin,
                  std::uint64_t end) {
    std::uint64_t part_begin = 0;
    for (const std::span<const std::byte> part : parts) {
        const std::uint64_t from = std::max(begin, part_begin);
        const std::uint64_t to = std::min(end, part_begin + part.size());
        if (from < to)
            commands.upload(buffer, part.subspan(from - part_begin, to - from), from - begin);
        part_begin += part.size();
    }
}

void make_buffer(const Device& device, Commands& commands, std::optional<Buffer>& buffer, const char* name,
                 std::span<const std::byte> bytes) {
    if (bytes.empty())
        return;
    buffer.emplace(device, name, bytes.size(), storage_and_texels, BufferPlace::device);
    commands.upload(*buffer, bytes, 0);
}

// `parts`: one behind the other.
template <class Parts>
void make_parts(const Device& device, Commands& commands, std::optional<Buffer>& buffer, const char* name,
                const Parts& parts) {
    if (total(parts) == 0)
        return;
    buffer.emplace(device, name, total(parts), storage_and_texels, BufferPlace::device);
    upload_range(commands, *buffer, parts, 0, buffer->bytes());
}

void check_size(const Device& device, const char* what, std::uint64_t bytes, const char* remedy) {
    if (const std::uint64_t most = device.limits().maxStorageBufferRange; bytes > most)
        throw InputError(fmt::format("{} take {:.1f} MiB, but \"{}\" holds no more than {:.1f} MiB of them; {}", what,
                                     bytes / mebibyte, device.info().name, most / mebibyte, remedy));
}

} // namespace

SceneBuffers::SceneBuffers(const Device& device, Commands& commands, Media media, const Superposition* whole,
                           std::uint64_t most_grid_bytes, std::uint64_t most_texel_bytes)
    : frame_(device, "frame parameters", sizeof(shared::FrameParams), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
             BufferPlace::host) {
    const UploadLayout layout(media);
    make_parts(device, commands, phase_, "phase functions", layout.phases());
    make_parts(device, commands, maps_, "maps of values", layout.maps());
    make_parts(device, commands, blackbody_, "black-body tables", layout.blackbodies());
    make_parts(device, commands, leaf_table_, "leaf tables", layout.leaf_tables());
    if (!layout.grids().empty())
        make_grids(device, commands, layout.grids(), most_grid_bytes);
    if (whole)
        make_buffer(device, commands, majorants_, "majorant grid", bytes_of(walked_bounds(*whole)));
    else if (!media.empty())
        upload_alone(device, commands, media.front());
    find_texels(most_texel_bytes);
}

void SceneBuffers::find_texels(std::uint64_t most_bytes) {
    texels_ = (grids_ || overlaps_) && windows_.empty();
    for (const auto* buffer : {&grids_, &leaf_table_, &majorants_, &overlaps_})
        texels_ = texels_ && (!*buffer || (*buffer)->bytes() <= most_bytes);
}

bool SceneBuffers::find_table_texels(std::uint64_t most_bytes) {
    table_texels_ = true;
    for (const auto* buffer : {&bvh_, &primitives_, &surfaces_, &lights_, &blackbody_, &sky_, &sky_alias_})
        table_texels_ = table_texels_ && (!*buffer || (*buffer)->bytes() <= most_bytes);
    return table_texels_;
}

// What a medium has only where it is no part of several.
void SceneBuffers::upload_alone(const Device& device, Commands& commands, const LoadedMedium& medium) {
    if (medium.bvh) {
        make_buffer(device, commands, triangles_, "triangles", bytes_of(medium.bvh->triangles));
        make_buffer(device, commands, bvh_, "bounding volume hierarchy", bytes_of(medium.bvh->nodes));
    }
    if (medium.majorants)
        make_buffer(device, commands, majorants_, "majorant grid", bytes_of(walked_cells(*medium.majorants)));
    make_buffer(device, commands, controls_, "control grid", bytes_of(medium.controls));
}

void SceneBuffers::upload_media(const Device& device, Commands& commands, const std::vector<shared::MediumParams>& rows,
                                const std::vector<std::uint32_t>& overlaps, std::uint64_t most_texel_bytes) {
    check_size(device, "the volumes", bytes_of(rows).size(), "leave some out");
    check_size(device, "the lists of which volumes are where, with the faces of their models,",
               bytes_of(overlaps).size(), "leave volumes out, let fewer lie in one another, or decimate models");
    make_buffer(device, commands, media_, "media", bytes_of(rows));
    make_buffer(device, commands, overlaps_, "lists of media", bytes_of(overlaps));
    find_texels(most_texel_bytes);
}

void SceneBuffers::upload_points(const Device& device, Commands& commands, const std::vector<glm::vec3>& points) {
    if (bytes_of(points).size() > device.limits().maxStorageBufferRange)
        throw InputError(fmt::format("{} points take {:.1f} MiB, but \"{}\" holds no more than {:.1f} MiB of them; "
                                     "read some of them at a time",
                                     points.size(), bytes_of(points).size() / mebibyte, device.info().name,
                                     device.limits().maxStorageBufferRange / mebibyte));
    make_buffer(device, commands, points_, "points", bytes_of(points));
}

void SceneBuffers::upload_lights(const Device& device, Commands& commands, const LightTable& table, const SkyMap* sky) {
    check_size(device, "the lights", bytes_of(table.rows).size(), "leave some out");
    make_buffer(device, commands, lights_, "lights", bytes_of(table.rows));
    make_buffer(device, commands, light_tree_, "tree of lights", bytes_of(table.tree));
    if (!sky)
        return;
    check_size(device, "the texels of the <sky>", bytes_of(sky->texels).size(),
               "make the map smaller, 8 million texels at most, say");
    make_buffer(device, commands, sky_, "sky", bytes_of(sky->texels));
    make_buffer(device, commands, sky_alias_, "choice of the sky's texels", bytes_of(sky->alias));
}

void SceneBuffers::upload_emitters(const Device& device, Commands& commands,
                                   const std::vector<shared::EmitterRow>& rows) {
    check_size(device, "pieces of surfaces that shine, and other sources,", bytes_of(rows).size(),
               "let fewer triangles shine");
    make_buffer(device, commands, emitters_, "sources of light", bytes_of(rows));
}

void SceneBuffers::upload_surfaces(const Device& device, Commands& commands, const SurfaceTable& table,
                                   const std::vector<shared::BvhNode>& before) {
    const std::uint64_t bytes = bytes_of(table.primitives).size(), most = device.limits().maxStorageBufferRange;
    if (bytes > most)
        throw InputError(
            fmt::format("the surfaces' triangles take {:.1f} MiB, but \"{}\" holds no more than {:.1f} MiB "
                        "of them; decimate the meshes",
                        bytes / mebibyte, device.info().name, most / mebibyte));
    make_buffer(device, commands, surfaces_, "surfaces", bytes_of(table.rows));
    make_buffer(device, commands, primitives_, "pieces of surfaces", bytes_of(table.primitives));
    bvh_.reset();
    make_parts(device, commands, bvh_, "bounding volume hierarchies", Parts{bytes_of(before), bytes_of(table.nodes)});
}

void SceneBuffers::upload_textures(const Device& device, Commands& commands, const std::vector<glm::vec4>& texels,
                                   const SkyMap* sky) {
    const Parts parts{sky ? bytes_of(sky->texels) : Parts::value_type(), bytes_of(texels)};
    check_size(device, "the texels of textures, and of the <sky>,", total(parts), "make the images smaller");
    sky_.reset();
    make_parts(device, commands, sky_, "sky and textures", parts);
}

void SceneBuffers::make_grids(const Device& device, Commands& commands, const Parts& grids, std::uint64_t most_bytes) {
    const std::uint64_t bytes = total(grids);
    if (bytes > most_bytes)
        return make_windows(device, commands, grids, bytes, most_bytes);
    grids_.emplace(device, "grids", bytes, storage_and_texels, BufferPlace::device);
    upload_range(commands, *grids_, grids, 0, bytes);
}

// As few words to a window as will do: far below what one allocation may hold, which Vulkan lets end at 1 GiB.
void SceneBuffers::make_windows(const Device& device, Commands& commands, const Parts& grids, std::uint64_t bytes,
                                std::uint64_t most_bytes) {
    constexpr std::uint64_t most_words = std::uint64_t{1} << 32; // as the kernels count them
    if (!device.has_addresses() || bytes / 4 > most_words)
        throw InputError(fmt::format(
            "the grids take {:.1f} MiB, but \"{}\" holds no more than {:.1f} MiB of them{}; crop them or write them "
            "quantised (nanovdb_convert --fp8 takes a quarter of the bytes of floats)",
            bytes / mebibyte, device.info().name, (device.has_addresses() ? 4 * most_words : most_bytes) / mebibyte,
            device.has_addresses() ? "" : ", since it lacks the feature bufferDeviceAddress"));
    window_bits_ = static_cast<std::uint32_t>(std::bit_width((bytes / 4 - 1) / GRID_WINDOWS));
    const std::uint64_t window = std::uint64_t{4} << *window_bits_;
    windows_.reserve(GRID_WINDOWS);
    for (std::uint64_t begin = 0; begin < bytes; begin += window) {
        const std::uint64_t end = std::min(begin + window, bytes);
        windows_.emplace_back(device, "window into the grids", end - begin, VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT,
                              BufferPlace::device);
        upload_range(commands, windows_.back(), grids, begin, end);
    }
}

void SceneBuffers::set_frame(Commands& commands, shared::FrameParams frame) {
    for (std::size_t i = 0; i < windows_.size(); ++i) {
        const VkDeviceAddress address = windows_[i].address();
        frame.grid_windows[i] = {static_cast<std::uint32_t>(address), static_cast<std::uint32_t>(address >> 32)};
    }
    commands.upload(frame_, std::as_bytes(std::span(&frame, 1)));
}

BoundBuffers SceneBuffers::bound() const {
    const auto place = [](const std::optional<Buffer>& buffer) { return buffer ? &*buffer : nullptr; };
    BoundBuffers buffers{};
    buffers[BINDING_FRAME] = &frame_;
    buffers[BINDING_GRID] = place(grids_);
    buffers[BINDING_LEAF_TABLE] = place(leaf_table_);
    buffers[BINDING_MAJORANTS] = place(majorants_);
    if (texels_) {
        buffers[BINDING_OVERLAP_TEXELS] = place(overlaps_);
        buffers[BINDING_MEMBER_TEXELS] = place(overlaps_);
        buffers[BINDING_GRID_TEXELS] = place(grids_);
        buffers[BINDING_LEAF_TEXELS] = place(leaf_table_);
        buffers[BINDING_MAJORANT_TEXELS] = place(majorants_);
    }
    if (table_texels_) {
        buffers[BINDING_NODE_TEXELS] = place(bvh_);
        buffers[BINDING_PRIMITIVE_TEXELS] = place(primitives_);
        buffers[BINDING_SURFACE_TEXELS] = place(surfaces_);
        buffers[BINDING_LIGHT_TEXELS] = place(lights_);
        buffers[BINDING_BLACKBODY_TEXELS] = place(blackbody_);
        buffers[BINDING_SKY_TEXELS] = place(sky_);
        buffers[BINDING_SKY_ALIAS_TEXELS] = place(sky_alias_);
    }
    buffers[BINDING_CONTROLS] = place(overlaps_ ? overlaps_ : controls_);
    buffers[BINDING_BLACKBODY] = place(blackbody_);
    buffers[BINDING_TRIANGLES] = place(media_ ? media_ : triangles_);
    buffers[BINDING_BVH] = place(bvh_);
    buffers[BINDING_PHASE] = place(phase_);
    buffers[BINDING_MAPS] = place(maps_);
    buffers[BINDING_SURFACES] = place(surfaces_);
    buffers[BINDING_PRIMITIVES] = place(primitives_);
    buffers[BINDING_POINTS] = place(points_);
    buffers[BINDING_EMITTERS] = place(emitters_);
    buffers[BINDING_LIGHTS] = place(lights_);
    buffers[BINDING_LIGHT_TREE] = place(light_tree_);
    buffers[BINDING_SKY] = place(sky_);
    buffers[BINDING_SKY_ALIAS] = place(sky_alias_);
    return buffers;
}

std::uint64_t SceneBuffers::bytes() const {
    std::uint64_t total = frame_.bytes();
    for (const auto* buffer :
         {&grids_, &leaf_table_, &majorants_, &controls_, &blackbody_, &triangles_, &bvh_, &lights_, &light_tree_,
          &sky_, &sky_alias_, &phase_, &media_, &overlaps_, &maps_, &surfaces_, &primitives_, &points_, &emitters_})
        total += *buffer ? (*buffer)->bytes() : 0;
    for (const Buffer& window : windows_)
        total += window.bytes();
    return total;
}

} // namespace vkvol
