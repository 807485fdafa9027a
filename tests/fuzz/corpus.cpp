#include "corpus.h"

#include <algorithm>
#include <blosc.h>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <nanovdb/util/IO.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <sstream>
#include <zlib.h>

#include "image_io.h"
#include "support/test_grids.h"
#include "support/test_meshes.h"
#include "target.h"

namespace vkvol::fuzz {

namespace {

using nanovdb::io::Codec;

GridRecipe recipe_of(int kind, Storage storage, const std::string& name) {
    GridRecipe recipe = rough_recipe();
    recipe.storage = storage;
    recipe.name = name;
    switch (kind) {
    case 1: // blocks of one value
        recipe.first = {-12, -12, -12};
        recipe.last = {19, 19, 3};
        recipe.value = [](glm::ivec3 i) { return (i.x >> 3) % 2 == 0 ? 0.75f : float(voxel_noise(i, 4)); };
        break;
    case 2: // one voxel, in a skewed transform
        recipe.first = recipe.last = {-9, 7, 0};
        recipe.value = [](glm::ivec3) { return 3.0f; };
        recipe.linear = skewed;
        recipe.translation = {1, -2, 3};
        break;
    case 3: // values that are no density; quantised grids cannot hold all of them
        recipe.value = [storage](glm::ivec3 i) {
            return storage == Storage::float32 && i.x == 0 ? NAN : i.y == 5 ? -1.0f : float(voxel_noise(i, 9));
        };
        break;
    case 4: // across the borders of root tiles
        recipe.first = {4093, -2, 0};
        recipe.last = {4098, 3, 1};
        recipe.background = 0.25f;
        break;
    default:
        break;
    }
    return recipe;
}

template <class T> void append(std::string& bytes, const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string packed(const GridBytes& grid, Codec codec) {
    const auto* data = reinterpret_cast<const char*>(grid.data());
    if (codec == Codec::NONE)
        return {data, grid.size()};
    std::string out;
    uLongf size = compressBound(grid.size()) + BLOSC_MAX_OVERHEAD;
    std::string body(size, '\0');
    if (codec == Codec::ZIP)
        compress2(reinterpret_cast<Bytef*>(body.data()), &size, reinterpret_cast<const Bytef*>(data), grid.size(), 1);
    else
        size = static_cast<uLongf>(std::max(
            0, blosc_compress_ctx(5, BLOSC_SHUFFLE, 4, grid.size(), data, body.data(), body.size(), "lz4", 0, 1)));
    append(out, static_cast<std::uint64_t>(size));
    return out + body.substr(0, size);
}

} // namespace

std::vector<GridBytes> make_grids(const std::string& name) {
    std::vector<GridBytes> grids;
    for (int kind = 0; kind < 5; ++kind)
        for (const Storage storage : all_storages)
            if (kind != 4 || storage == Storage::float32) // large
                grids.push_back(make_grid_bytes(recipe_of(kind, storage, name)));
    // Half grids of NanoVDB 32.x differ from float ones by their type alone.
    GridBytes half = grids.front();
    reinterpret_cast<nanovdb::GridData*>(half.edit())->mGridType = nanovdb::GridType::Half;
    grids.push_back(half);
    GridBytes empty = grids.front();
    auto* tree = reinterpret_cast<nanovdb::TreeData<3>*>(empty.edit() + sizeof(nanovdb::GridData));
    tree->mVoxelCount = 0;
    grids.push_back(empty);
    grids.push_back(with_root_tile(make_grid_bytes(recipe_of(4, Storage::float32, name)), {4096, 0, 0}, 0.5f));
    return grids;
}

std::vector<GridBytes> make_color_grids(const std::string& name) {
    std::vector<GridBytes> grids;
    for (int kind = 0; kind < 5; ++kind) {
        GridRecipe recipe = recipe_of(kind, Storage::float32, name);
        recipe.color = [value = recipe.value](glm::ivec3 i) { return glm::vec3(value(i), 0.5f, 0.1f * value(i)); };
        grids.push_back(make_grid_bytes(recipe));
    }
    return grids;
}

std::size_t nvdb_header_size(const std::vector<StoredGrid>& grids) {
    std::size_t size = sizeof(nanovdb::io::Header);
    for (const StoredGrid& grid : grids)
        size += sizeof(nanovdb::io::MetaData) + grid.name.size() + 1;
    return size;
}

std::string make_nvdb(const std::vector<StoredGrid>& grids, std::uint16_t codec) {
    nanovdb::io::Header header;
    header.magic = NANOVDB_MAGIC_NUMBER;
    header.version = nanovdb::Version();
    header.gridCount = static_cast<std::uint16_t>(grids.size());
    header.codec = static_cast<Codec>(codec);
    std::string file, data;
    append(file, header);
    for (const StoredGrid& grid : grids) {
        const std::string body = packed(grid.bytes, header.codec);
        nanovdb::GridData stated;
        std::memcpy(static_cast<void*>(&stated), grid.bytes.data(), sizeof stated);
        nanovdb::io::MetaData meta;
        std::memset(static_cast<void*>(&meta), 0, sizeof meta);
        meta.gridSize = grid.bytes.size();
        meta.fileSize = body.size();
        meta.gridType = stated.mGridType;
        meta.gridClass = stated.mGridClass;
        meta.nameSize = static_cast<std::uint32_t>(grid.name.size() + 1);
        meta.codec = header.codec;
        meta.version = nanovdb::Version();
        append(file, meta);
        file.append(grid.name.c_str(), grid.name.size() + 1);
        data += body;
    }
    return file + data;
}

const char* const ball_mtl = "# a library\nnewmtl red\nKa 0 0 0\nKd 0.75 0.25 0.125\nKs 0.5 0.5 0.5\nNs 10\nillum 2\n"
                             "newmtl blue\nKd 0 0 1\nmap_Kd blue.png\nd 0.5\nTr 0.5\n";

std::vector<std::string> make_objs() {
    std::vector<std::string> objs = {
        "mtllib ball.mtl\no cube\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nvt 0 0\nvn 0 "
        "0 1\n"
        "g a\nusemtl red\nf 4/1/1 3/1/1 2/1/1 1/1/1\ns off\nusemtl blue\nf 5//1 6//1 7//1 8//1\nf 1 2 6 5\nf 2 3 7 6\n"
        "f 3 4 8 7\nf -8 -5 -1 -4\n",
        "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nv 0 0 1\r\nf 1 3 2\r\nf 1 2 4\r\nf 2 3 4\r\nf 3 1 4\r\n",
        "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nv 0 0 1\nv 2 0 1\nv 2 1 1\nv 1 1 1\nv 1 2 1\nv 0 2 1\n"
        "f 6 5 4 3 2 1\nf 9 10 11 12 7 8\nf 1 2 8 7\nf 2 3 9 8\nf 3 4 10 9\nf 4 5 11 10\nf 5 6 12 11\nf 6 1 7 12\n"};
    const Mesh ball = make_icosphere(1);
    std::string text = "mtllib ball.mtl\nusemtl red\n";
    for (const glm::dvec3& v : ball.vertices)
        text += fmt::format("v {} {} {}\n", v.x, v.y, v.z);
    for (const glm::uvec3& t : ball.triangles)
        text += fmt::format("f {} {} {}\n", t.x + 1, t.y + 1, t.z + 1);
    objs.push_back(text);
    return objs;
}

std::vector<std::string> make_plys() {
    std::vector<std::string> plys;
    for (const PlyFormat format : {PlyFormat::ascii, PlyFormat::little_endian, PlyFormat::big_endian})
        plys.push_back(as_ply(make_icosphere(0), format));
    plys.push_back("ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                   "element face 2\nproperty list uchar int vertex_index\nproperty uchar red\nend_header\n"
                   "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1 9\n4 0 1 3 2 9\n");
    return plys;
}

void write_scene_files(const std::filesystem::path& directory) {
    const auto density = make_grid_bytes(recipe_of(0, Storage::fpn, "density"));
    const auto heat = make_grid_bytes(recipe_of(1, Storage::float32, "temperature"));
    const auto color = make_color_grids("colour").front();
    write_file(directory / "cloud.nvdb", make_nvdb({{density, "density"}}, std::uint16_t(Codec::NONE)));
    write_file(directory / "fire.nvdb",
               make_nvdb({{density, "density"}, {heat, "temperature"}, {color, "colour"}}, std::uint16_t(Codec::ZIP)));
    write_file(directory / "cloud.vdb", make_vdbs(directory).front());
    write_file(directory / "phase.txt", "0 10\n90 1\n180 2\n");
    write_file(directory / "ball.obj", make_objs().back());
    write_file(directory / "ball.mtl", ball_mtl);
    Film sky;
    sky.picture_width = sky.crop.x1 = 4;
    sky.picture_height = sky.crop.y1 = 2;
    sky.mean.resize(8, glm::vec3(1.0f, 2.0f, 3.0f));
    sky.variance.resize(8);
    sky.samples.resize(8);
    write_exr(directory / "sky.exr", sky, {});
}

std::vector<std::string> make_vdbs(const std::filesystem::path& scratch) {
    openvdb::initialize();
    std::vector<std::string> files;
    const std::filesystem::path path = scratch / "corpus.vdb";
    constexpr std::size_t uuid_at = 21, uuid_size = 36; // random: an input is to be always the same
    constexpr const char* no_uuid = "00000000-0000-4000-8000-000000000000";
    const auto write = [&](const openvdb::GridPtrVec& grids, std::uint32_t compression) {
        openvdb::io::File file(path.string());
        file.setCompression(compression);
        file.write(grids);
        file.close();
        files.push_back(read_file(path));
        files.back().replace(uuid_at, uuid_size, no_uuid);
    };
    const auto grid = openvdb::FloatGrid::create(0.0f);
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    for (int i = 0; i < 200; ++i)
        grid->tree().setValue({i % 7 - 3, i % 11, i / 20}, float(voxel_noise({i, 0, 0}, 1)));
    for (const std::uint32_t compression : {0, 1, 2, 3, 4, 6})
        write({grid}, compression);
    const auto half = grid->deepCopy();
    half->setSaveFloatAsHalf(true);
    half->tree().addTile(1, {64, 0, 0}, 0.5f, true);
    half->tree().addTile(2, {4096, 0, 0}, 0.25f, true);
    const auto vectors = openvdb::Vec3SGrid::create();
    vectors->setName("colour");
    vectors->tree().setValue({1, 2, 3}, openvdb::Vec3s(1, 2, 3));
    const auto heat = openvdb::FloatGrid::create(0.0f);
    heat->setName("temperature");
    heat->setTransform(openvdb::math::Transform::createLinearTransform(0.25));
    heat->tree().setValue({1, 2, 3}, 5.0f);
    write({half, vectors, heat}, 6);
    write({half, heat}, 0);
    const auto half_vectors = vectors->deepCopy();
    half_vectors->setSaveFloatAsHalf(true);
    half_vectors->tree().addTile(1, {64, 0, 0}, openvdb::Vec3s(0.5f), true);
    write({half, half_vectors}, 5);
    const auto empty = openvdb::FloatGrid::create(0.5f);
    empty->setName("temperature");
    const auto instance = openvdb::FloatGrid::create(*grid); // shares the tree
    instance->setName("temperature");
    write({grid, empty}, 6);
    write({grid, instance}, 2);
    write({grid, grid, vectors}, 0); // two of one name
    std::filesystem::remove(path);
    std::ostringstream stream;
    openvdb::io::Stream(stream).write(openvdb::GridCPtrVec{half, heat});
    files.push_back(stream.str());
    files.back().replace(uuid_at, uuid_size, no_uuid);
    return files;
}

} // namespace vkvol::fuzz
