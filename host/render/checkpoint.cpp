#include "checkpoint.h"

#include <bit>
#include <cstddef>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <new>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <vector>

#include "digest.h"
#include "error.h"
#include "image_io.h"
#include "program.h"

namespace vkvol {

static_assert(std::is_trivially_copyable_v<shared::FilmPixel> && std::is_trivially_copyable_v<RenderCounts>);
static_assert(std::endian::native == std::endian::little, "the file holds words as they lie in memory");

namespace {

using Json = nlohmann::json;

// magic, bytes of the header, header (JSON), film, sums, layers, pixels, digest of all before.
constexpr char magic[] = {'v', 'k', 'v', 'o', 'l', 'c', 'h', '6'};

Json header_of(const Checkpoint& c) {
    Json non_finite = Json::array();
    for (const NonFiniteSample& s : c.non_finite)
        non_finite.push_back({s.x, s.y, s.sample});
    Json passes = Json::array();
    for (const PassFigures& p : c.passes)
        passes.push_back({p.name, p.seconds, p.queued});
    const auto counts = std::bit_cast<std::array<std::uint64_t, sizeof(RenderCounts) / 8>>(c.counts);
    return {{"kernel", c.identity.kernel},
            {"program", c.identity.program},
            {"device", c.identity.device},
            {"bandRows", c.identity.band_rows},
            {"done", c.done},
            {"batch", c.batch},
            {"band", c.band},
            {"wholeBand", !c.pixels},
            {"pixels", c.pixels ? c.pixels->size() : 0},
            {"film", c.film.size()},
            {"sums", c.sums.size()},
            {"layers", c.layers.size()},
            {"counts", counts},
            {"nonFinite", non_finite},
            {"seconds", c.seconds},
            {"staged", c.schedule == Schedule::staged},
            {"passes", passes},
            {"rounds", c.rounds}};
}

Checkpoint from_header(const Json& header) {
    Checkpoint c;
    c.identity = {header.at("kernel"), header.at("program"), header.at("device"),
                  header.at("bandRows").get<std::vector<std::uint32_t>>()};
    c.done = header.at("done");
    c.batch = header.at("batch");
    c.band = header.at("band");
    if (!header.at("wholeBand").get<bool>())
        c.pixels.emplace(header.at("pixels").get<std::size_t>());
    c.film.resize(header.at("film").get<std::size_t>());
    c.sums.resize(header.at("sums").get<std::size_t>());
    c.layers.resize(header.at("layers").get<std::size_t>());
    c.counts =
        std::bit_cast<RenderCounts>(header.at("counts").get<std::array<std::uint64_t, sizeof(RenderCounts) / 8>>());
    for (const Json& s : header.at("nonFinite"))
        c.non_finite.push_back({s.at(0), s.at(1), s.at(2)});
    c.seconds = header.at("seconds");
    for (const Json& p : header.at("passes"))
        c.passes.push_back({p.at(0), p.at(1), p.at(2)});
    c.rounds = header.at("rounds");
    c.schedule = header.at("staged").get<bool>() ? Schedule::staged : Schedule::fused;
    return c;
}

std::string read_file(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    if (!stream)
        throw InputError(fmt::format("{}: cannot be read: {}", file.string(), std::strerror(errno)));
    return bytes;
}

std::uint64_t checksum(std::string_view bytes) {
    Digest digest;
    digest.add_all(bytes);
    return digest.value();
}

// What follows the checksum's approval was written by save_checkpoint.
template <class T> void take(std::string_view& bytes, std::span<T> values) {
    if (bytes.size() < values.size_bytes())
        throw std::length_error("it is too short");
    if (!values.empty())
        std::memcpy(values.data(), bytes.data(), values.size_bytes());
    bytes.remove_prefix(values.size_bytes());
}

Checkpoint parse(std::string_view bytes) {
    std::uint64_t sum = 0;
    if (bytes.size() < sizeof magic + sizeof sum)
        throw std::length_error("it is too short");
    if (std::memcmp(bytes.data(), magic, sizeof magic) != 0) // but for its last character
        throw std::invalid_argument("another version of vkvol wrote it");
    std::memcpy(&sum, bytes.data() + bytes.size() - sizeof sum, sizeof sum);
    bytes.remove_suffix(sizeof sum);
    if (sum != checksum(bytes))
        throw std::invalid_argument("its checksum is wrong");
    bytes.remove_prefix(sizeof magic);
    std::uint64_t header_size = 0;
    take(bytes, std::span(&header_size, 1));
    if (header_size > bytes.size())
        throw std::length_error("it is too short");
    Checkpoint checkpoint = from_header(Json::parse(bytes.substr(0, header_size)));
    bytes.remove_prefix(header_size);
    take(bytes, std::span(checkpoint.film));
    take(bytes, std::span(checkpoint.sums));
    take(bytes, std::span(checkpoint.layers));
    if (checkpoint.pixels)
        take(bytes, std::span(*checkpoint.pixels));
    if (!bytes.empty())
        throw std::length_error("it is too long");
    return checkpoint;
}

} // namespace

RenderIdentity identify(const shared::FrameParams& frame, const Specialization& specialization, const Assets& assets,
                        const LightTable& lights, std::span<const shared::MediumParams> media,
                        const SurfaceTable& surfaces, std::span<const glm::vec3> points, std::uint32_t sample_offset,
                        const std::string& device, std::vector<std::uint32_t> band_rows) {
    Digest digest;
    digest.add(std::as_bytes(std::span(&sample_offset, 1)));
    digest.add(std::as_bytes(std::span(&frame, 1)));
    digest.add_all(specialization);
    digest.add_all(lights.rows);
    digest.add_all(media);
    digest.add_all(surfaces.rows);
    digest.add_all(surfaces.primitives);
    digest.add_all(surfaces.texels);
    digest.add_all(points);
    if (assets.sky)
        digest.add_all(assets.sky->texels);
    std::set<const void*> seen; // what media share counts once
    const auto add = [&](const auto& values) {
        const auto bytes = std::as_bytes(std::span(values));
        if (seen.insert(bytes.data()).second)
            digest.add(bytes);
    };
    for (const LoadedMedium& medium : assets.media) {
        for (const DensityField* grid : grids_of(medium))
            add(grid->bytes.span());
        if (medium.majorants)
            add(medium.majorants->bounds);
        digest.add_all(medium.controls);
        add(std::span(medium.blackbody.begin(), medium.blackbody.end()));
        add(std::span(medium.phase_nodes.begin(), medium.phase_nodes.end()));
        digest.add_all(medium.map_knots);
        if (medium.inside)
            digest.add_all(medium.inside->words);
        if (medium.bvh)
            digest.add_all(medium.bvh->triangles);
    }
    return {digest.text(), program_text(), device, std::move(band_rows)};
}

void save_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint) {
    const std::string header = header_of(checkpoint).dump();
    const std::uint64_t header_size = header.size();
    std::string begin(magic, sizeof magic);
    begin.append(reinterpret_cast<const char*>(&header_size), sizeof header_size);
    begin += header;
    std::vector<std::span<const std::byte>> parts{
        std::as_bytes(std::span(begin)), std::as_bytes(std::span(checkpoint.film)),
        std::as_bytes(std::span(checkpoint.sums)), std::as_bytes(std::span(checkpoint.layers))};
    if (checkpoint.pixels)
        parts.push_back(std::as_bytes(std::span(*checkpoint.pixels)));
    Digest digest;
    for (const auto& part : parts)
        digest.add(part);
    const std::uint64_t sum = digest.value();
    parts.push_back(std::as_bytes(std::span(&sum, 1)));
    write_parts(file, parts);
}

bool is_checkpoint(const std::filesystem::path& file) {
    constexpr std::streamsize common = sizeof magic - 1; // the last character is the version
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error))
        return false;
    char begin[common];
    return std::ifstream(file, std::ios::binary).read(begin, common) && std::memcmp(begin, magic, common) == 0;
}

Checkpoint load_checkpoint(const std::filesystem::path& file) {
    if (std::error_code error; std::filesystem::exists(file, error) && !is_checkpoint(file))
        throw InputError(
            fmt::format("{}: not a checkpoint of vkvol; rename it, or name another picture with -o", file.string()));
    try {
        return parse(read_file(file));
    } catch (const InputError&) {
        throw;
    } catch (const std::bad_alloc&) { // nothing is wrong with the file
        throw;
    } catch (const std::exception& error) {
        throw InputError(
            fmt::format("{}: no checkpoint to go on from: {}; remove it to begin anew", file.string(), error.what()));
    }
}

void check_identity(const RenderIdentity& saved, const RenderIdentity& here) {
    const auto refuse = [](const std::string& what) {
        throw InputError(fmt::format("--resume: the checkpoint is of {}; give the same arguments as then, or remove it "
                                     "to begin anew",
                                     what));
    };
    if (saved.program != here.program)
        refuse(fmt::format("vkvol {}, not {}", saved.program, here.program));
    if (saved.kernel != here.kernel)
        refuse("another render: another scene, density field, picture, seed, sample offset or integrator");
    if (saved.device == here.device && saved.band_rows != here.band_rows)
        refuse("a film in other bands of rows, as another --schedule has them");
    if (saved.device != here.device)
        refuse(fmt::format("another device, {}, whose bits differ from those of {}", saved.device, here.device));
}

} // namespace vkvol
