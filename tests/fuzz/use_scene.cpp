#include "use_scene.h"

#include <cmath>
#include <limits>

#include "frame_params.h"
#include "kernel_constants.h"
#include "light_table.h"
#include "method.h"
#include "preset.h"
#include "scene_hash.h"
#include "shared/constants.h"
#include "surface_mesh.h"
#include "surface_table.h"
#include "target.h"

namespace vkvol::fuzz {

namespace {

void expect_finite(float value, const char* what) {
    expect(std::isfinite(value), what);
}

void expect_finite(const glm::vec3& v, const char* what) {
    for (int i = 0; i < 3; ++i)
        expect_finite(v[i], what);
}

void expect_finite(const glm::vec4 (&rows)[3], const char* what) {
    for (const glm::vec4& row : rows)
        for (int i = 0; i < 4; ++i)
            expect_finite(row[i], what);
}

// Radiance is squared and summed over up to 2^31 samples, in pairs of floats.
void expect_radiance(const glm::vec3& v, const char* what) {
    for (int i = 0; i < 3; ++i)
        expect(v[i] >= 0.0f && v[i] * v[i] < std::numeric_limits<float>::max() * 0x1p-31f, what);
}

void check_camera(const shared::SensorParams& camera) {
    expect_finite(camera.position, "the camera's position is not finite");
    expect_finite(camera.corner, "the picture's corner is not finite");
    expect_finite(camera.right, "the width of a pixel is not finite");
    expect_finite(camera.down, "the height of a pixel is not finite");
    expect_finite(camera.lens_u, "the lens is not finite");
    expect_finite(camera.lens_v, "the lens is not finite");
    expect(std::isfinite(camera.lens_lever), "what the lens is sharp at is not finite");
    expect(camera.right != glm::vec3(0.0f) && camera.down != glm::vec3(0.0f),
           "pixels have no extent"); // squares underflow
    const float squared = glm::dot(camera.corner, camera.corner);
    expect(std::isfinite(squared) && squared > 0.0f, "the picture's corner has no direction");
}

void check_volume(const shared::MediumParams& v) {
    expect_finite(v.to_medium, "the map to the medium is not finite");
    expect_finite(v.bounds_min, "the medium's bounds are not finite");
    expect_finite(v.bounds_max, "the medium's bounds are not finite");
    expect_finite(v.extent, "the medium's extent is not finite");
    expect(std::isfinite(v.sigma_t) && v.sigma_t >= 0.0f, "the extinction is not finite");
    expect_finite(v.sigma_ratio, "the ratio of extinctions is not finite");
    expect_finite(v.albedo, "the albedo is not finite");
    expect_finite(v.albedo_grid.to_index, "the map to the grid of albedos is not finite");
    expect(std::abs(v.phase.g) < 1.0f && std::abs(v.phase.g2) < 1.0f, "g is not between -1 and 1 in single precision");
    expect(v.phase.share >= 0.0f && v.phase.share <= 1.0f, "the share of the second phase function is out of range");
    expect(v.phase.alpha >= 0.0f && v.phase.alpha <= 250.0f, "alpha is out of range");
    expect_radiance(v.emission.constant, "constant emission is out of range");
    expect_radiance(v.emission.color, "the temperature's colour is out of range");
    expect_finite(v.emission.to_index, "the map to the temperature grid is not finite");
    expect_finite(v.emission.kelvin_scale, "temperatureScale is not finite");
    expect_finite(v.emission.kelvin_offset, "temperatureOffset is not finite");
    expect_finite(v.emission.kelvin_cutoff, "temperatureCutoff is not finite");
    expect_finite(v.emission.table_high, "the hottest temperature is not finite");
    expect(std::isfinite(v.majorant) && std::isfinite(v.control) && std::isfinite(v.residual),
           "bounds of the density are not finite");
    expect(std::isfinite(v.majorant * v.sigma_t), "the majorant of the extinction is not finite");
    for (std::uint32_t k = 0; k < v.noise.octaves; ++k)
        for (int i = 0; i < 4; ++i)
            expect_finite(v.noise.to_noise[k][i], "an octave of noise is not finite");
}

void check_frame(const shared::FrameParams& frame, int shape) {
    check_camera(frame.sensors[0]);
    if (shape != SHAPE_NONE)
        check_volume(frame.media[0]);
    expect_radiance(frame.lights[FRAME_DIRECTIONAL].radiance, "the light is out of range");
    expect_finite(frame.lights[FRAME_DIRECTIONAL].direction, "the light's direction is not finite");
    expect_radiance(frame.lights[FRAME_BACKGROUND].radiance, "the background is out of range");
    expect(std::isfinite(frame.march.step) && frame.march.step > 0.0f, "the step is not a positive float");
    expect(std::isfinite(frame.march.shadow_step) && frame.march.shadow_step > 0.0f,
           "the step of shadow rays is not a positive float");
    expect(std::isfinite(frame.march.optical_step) && frame.march.optical_step > 0.0f,
           "the optical step is not a positive float");
}

void check_light(const shared::LightRow& row) {
    expect_radiance(row.radiance, "a light is out of range");
    expect_finite(row.position, "a light's place is not finite");
    expect_finite(row.direction, "a light's direction is not finite");
    expect(std::isfinite(row.extent) && row.extent >= 0.0f, "a disc's extent is none");
    expect(std::isfinite(row.area) && row.area >= 0.0f, "a lamp's area is none");
    expect(row.full_within <= row.none_beyond, "a cone's rim is inside out");
}

void check_loaded(const LoadedMedium& loaded) {
    if (loaded.field)
        check_field(*loaded.field);
    if (loaded.temperature)
        check_field(*loaded.temperature);
    if (loaded.albedo)
        check_field(*loaded.albedo);
    if (loaded.majorants)
        for (const float bound : loaded.majorants->bounds)
            expect(std::isfinite(bound) && bound >= 0.0f, "a majorant is not finite");
    for (const shared::ControlCell& cell : loaded.controls)
        expect(std::isfinite(cell.control) && std::isfinite(cell.residual), "a control density is not finite");
    for (const shared::MapKnot& knot : loaded.map_knots) {
        expect(std::isfinite(knot.density) && knot.density >= 0.0f && std::isfinite(knot.density_slope),
               "a mapped density is not finite");
        expect_finite(knot.albedo_slope, "a mapped albedo is not finite");
        expect_radiance(knot.emission, "mapped emission is out of range");
        expect_finite(knot.emission_slope, "mapped emission is not finite");
    }
    for (const glm::vec4& color : loaded.blackbody)
        expect_radiance(color, "a black body is out of range");
    if (loaded.inside) {
        const std::vector<std::uint32_t>& words = loaded.inside->words;
        const std::size_t cubes = loaded.inside->cells.bounds.size(), corners = words[INSIDE_CORNERS];
        for (std::size_t i = 0; i < cubes; ++i)
            if (const std::size_t record = words[INSIDE_HEAD + i]; record > 1) {
                expect(record + 5 + words[record] <= corners, "a cube's list ends beyond all");
                for (std::size_t k = 0; k < words[record]; ++k)
                    expect(corners + 9 * (std::size_t{words[record + 5 + k]} + 1) <= words.size(),
                           "a triangle is not there");
            }
    }
    if (loaded.bvh)
        for (const glm::vec3& corner : loaded.bvh->triangles)
            expect_finite(corner, "a corner of a triangle is not finite");
}

void check_superposition(const Scene& scene, const Superposition& whole) {
    const std::size_t entries = whole.entries();
    expect(entries == 0 || whole.overlaps.size() > entries, "cells over all media have no lists");
    expect(whole.brick_bounds.size() % (std::size_t{1} << (3 * whole.bits)) == 0, "a brick is cut off");
    for (const std::uint32_t brick : whole.bricks)
        expect(std::size_t{brick} << (3 * whole.bits) <= whole.brick_bounds.size(), "a brick is not there");
    for (std::size_t i = 0; i < entries; ++i) {
        const std::uint32_t begin = whole.overlaps[i], end = whole.overlaps[i + 1];
        expect(std::isfinite(whole.bound(i)), "a majorant of several media is not finite");
        expect(begin <= end && end <= whole.overlaps.size(), "a list of media reaches beyond the table");
        const bool is_brick = i < whole.bricks.size() && whole.bricks[i] > 0; // whose cells have lists
        expect(is_brick || (begin < end) == (whole.bound(i) > 0.0f), "a cell's bound and its list differ");
    }
    for (std::size_t i = entries + 1; i < whole.overlaps.size(); ++i)
        expect(whole.overlaps[i] < scene.volumes.size(), "a list of media names one that is not there");
    expect(entries == 0 || walked_bounds(whole).size() == entries, "walks have other cells");
}

} // namespace

void check_field(const DensityField& field) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 3; ++row)
            expect(std::isfinite(field.index_to_world[column][row]), "a grid's transform is not finite");
    if (field.active_voxels == 0)
        return;
    const glm::ivec3 n = field.leaf_dims;
    expect(n.x > 0 && n.y > 0 && n.z > 0 &&
               field.leaf_table.size() == std::size_t(n.x) * std::size_t(n.y) * std::size_t(n.z),
           "the leaf table has another size than its dimensions say");
    expect((field.voxel_min >> 3) == field.leaf_min && (field.voxel_max >> 3) == field.leaf_min + n - 1,
           "the leaf table does not cover the active voxels");
    const bool colors = field.type == GRID_COLOR;
    const std::size_t values_offset = colors ? 128 : 96; // of a leaf's values, as in density.glsl
    const auto log2_bits = [&](std::size_t leaf) {
        return field.type == GRID_FLOAT || colors ? 5u
               : field.type == GRID_FP4           ? 2u
               : field.type == GRID_FP8           ? 3u
               : field.type == GRID_FP16          ? 4u
                                                  : std::to_integer<unsigned>(field.bytes.data()[leaf + 15]) >> 5u;
    };
    std::uint32_t before = 0;
    for (const std::uint32_t entry : field.leaf_table) {
        if (entry == before)
            continue;
        before = entry;
        const std::size_t at = std::size_t{entry >> 1} * 4;
        expect(at < field.bytes.size(), "an entry of the leaf table points outside the grid");
        std::size_t size = colors ? 12 : 4;
        if (entry & 1u) {
            expect(at + values_offset <= field.bytes.size(), "a leaf begins at the end of the grid");
            expect(log2_bits(at) <= 5u, "a leaf has too many bits per value");
            size = values_offset + (colors ? std::size_t{512 * 12} : std::size_t{64} << log2_bits(at));
        }
        expect(at + size <= field.bytes.size(), "an entry of the leaf table reaches beyond the grid");
    }
}

void check_surfaces(const SurfaceTable& table) {
    for (const shared::SurfaceRow& row : table.rows) {
        expect_radiance(row.emission, "a surface's light is out of range");
        expect(row.look_density >= 0.0f && std::isfinite(row.look_density), "looks toward a surface have no density");
        expect_finite(row.eta, "an index of refraction is not finite");
        expect_finite(row.k, "an index of refraction is not finite");
        for (int i = 0; i < 3; ++i)
            expect(row.color[i] >= 0.0f && row.color[i] <= 1.0f, "a surface scatters more than it gets");
    }
    for (std::size_t i = 0; i < table.primitives.size(); ++i) {
        const shared::SurfacePrimitive& piece = table.primitives[i];
        expect_finite(piece.a, "a piece of a surface is not finite");
        expect_finite(piece.b, "a piece of a surface is not finite");
        expect_finite(piece.c, "a piece of a surface is not finite");
        expect(piece.details < table.primitives.size(), "a piece without its details");
        if (i < table.met)
            expect(piece.surface < table.rows.size(), "a piece of no surface");
    }
    for (const shared::BvhNode& node : table.nodes)
        expect(node.skip <= table.nodes.size() && (node.leaf >> 3) + (node.leaf & 7) <= table.primitives.size(),
               "a node of the surfaces' hierarchy leads astray");
}

void use_scene(const Scene& authored) {
    const Scene scene = with_surface_files(with_preset(authored));
    const Method method = choose_method(scene);
    expect(scene_hash(scene).size() == 16, "a scene hash has 16 digits");
    const Assets assets = load_assets(scene, method);
    for (const LoadedMedium& medium : assets.media)
        check_loaded(medium);
    const Superposition* whole = whole_of(assets);
    const Specialization constants = specialize(scene, assets.media, method, whole);
    if (whole) {
        check_superposition(scene, *whole);
        const auto rows = make_media(scene, assets.media, method, render_origin(scene, assets.media, whole));
        for (const shared::MediumParams& row : rows)
            if (row.kinds.shape != SHAPE_NONE)
                check_volume(row);
    }
    is_chromatic(scene);
    const Crop crop{0, scene.picture.width, 0, scene.picture.height};
    const shared::FrameParams frame = make_frame(scene, assets.media, method, crop, 1, whole);
    const glm::dvec3 origin = render_origin(scene, assets.media, whole);
    SurfaceTable surfaces = make_surface_table(scene.surfaces, origin);
    if (constants[SPEC_LIGHTS] != LIGHTS_LONE) {
        const LightTable table =
            make_light_table(scene, assets, surfaces, origin, lit_radius(scene, assets, frame.media[0]));
        tell_look_densities(table, surfaces);
        for (const shared::EmitterRow& piece : table.pieces)
            expect(piece.source < std::max(surfaces.primitives.size(), std::size_t(1)), "no piece that shines");
        for (const shared::LightRow& row : table.rows)
            check_light(row);
        for (std::uint32_t i = 0; i < table.choices; ++i)
            expect(table.rows[i].chance > 0.0f && table.rows[i].chance <= 1.0f, "a light's chance is none");
        for (const shared::LightNode& node : table.tree) {
            expect(std::isfinite(node.power) && node.power > 0.0f, "a light's power is none");
            expect_finite(node.low, "a light's bounds are not finite");
            expect_finite(node.high, "a light's bounds are not finite");
            expect_finite(node.axis, "a light's axis is not finite");
            expect(std::abs(node.spread) <= 1.0f && node.reach >= -1.0f && node.reach < 1.0f, "a light's cone is none");
        }
    }
    check_surfaces(surfaces);
    check_frame(frame, static_cast<int>(constants[SPEC_SHAPE]));
}

} // namespace vkvol::fuzz
