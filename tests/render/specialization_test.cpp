// A kernel for a scene without a feature contains none of its code. The track kernel is specialised as it is for a
// render; the instructions left are counted, and the buffers it still touches are listed.
#include <catch2/catch.hpp>
#include <map>
#include <set>
#include <span>

#include "fused.spv.h"
#include "fused_chromatic.spv.h"
#include "fused_full.spv.h"
#include "kernel_constants.h"
#include "shared/items.h"
#include "specialization.h"

using namespace vkvol;

namespace {

using Words = std::vector<std::uint32_t>;

// SPIR-V 1.5, sections 2.3 and 3: five words of header, then instructions with their length in the upper half of the
// first word.
constexpr std::uint32_t op_type_int = 21, op_type_float = 22, op_type_vector = 23, op_type_runtime_array = 29,
                        op_type_struct = 30, op_type_pointer = 32, op_function = 54, op_function_end = 56,
                        op_variable = 59, op_load = 61, op_store = 62, op_access_chain = 65, op_array_length = 68,
                        op_decorate = 71, op_label = 248, op_branch = 249;
constexpr std::uint32_t decoration_binding = 33;

struct Kernel {
    int instructions = 0; // within functions, but for labels and plain branches: blocks that only lead on cost nothing
    std::set<int> bindings; // that a function refers to
    std::map<int, int>
        elements; // of the runtime array behind a binding: components of an element, 0: no float or vector
};

Kernel read_kernel(const Words& words) {
    std::map<std::uint32_t, int> binding_of;
    std::map<std::uint32_t, std::vector<std::uint32_t>> types; // operands after the result, opcode first
    std::map<std::uint32_t, std::uint32_t> variables;          // to their types
    Kernel kernel;
    bool inside = false;
    for (std::size_t at = 5; at < words.size(); at += words[at] >> 16) {
        const std::uint32_t op = words[at] & 0xffffu, length = words[at] >> 16;
        REQUIRE(length > 0);
        const auto operands = std::span(words).subspan(at + 1, length - 1);
        if (op == op_decorate && operands[1] == decoration_binding)
            binding_of[operands[0]] = int(operands[2]);
        if (op >= op_type_int && op <= op_type_pointer) {
            types[operands[0]] = {op};
            types[operands[0]].insert(types[operands[0]].end(), operands.begin() + 1, operands.end());
        }
        if (op == op_variable)
            variables[operands[1]] = operands[0];
        if (op == op_function)
            inside = true;
        if (!inside)
            continue;
        kernel.instructions += op != op_label && op != op_branch ? 1 : 0;
        const bool reads = op == op_load || op == op_access_chain || op == op_array_length;
        if (reads || op == op_store)
            if (const auto found = binding_of.find(operands[reads ? 2 : 0]); found != binding_of.end())
                kernel.bindings.insert(found->second);
        if (op == op_function_end)
            inside = false;
    }
    for (const auto& [id, binding] : binding_of) {
        const auto block = types[types[variables[id]].at(2)]; // pointer: class, type
        const auto array = types[block.back()];
        if (block.front() != op_type_struct || array.empty() || array.front() != op_type_runtime_array)
            continue;
        const auto element = types[array.back()];
        kernel.elements[binding] = element.front() == op_type_float    ? 1
                                   : element.front() == op_type_vector ? int(element[2])
                                                                       : 0;
    }
    return kernel;
}

// Each once: the tests below have many in common.
const Kernel& specialise(std::span<const std::uint32_t> spirv, const Specialization& constants) {
    static std::map<std::pair<const std::uint32_t*, Specialization>, Kernel> known;
    const auto key = std::make_pair(spirv.data(), constants);
    if (!known.contains(key))
        known[key] = read_kernel(specialized(spirv, constants));
    return known[key];
}

// A grey cloud in a grid with delta tracking, lit by nothing but its background.
Specialization plain() {
    Specialization s{};
    s[SPEC_SHAPE] = SHAPE_BOX;
    s[SPEC_FIELD] = FIELD_GRID;
    s[SPEC_GRID_TYPE] = s[SPEC_TEMPERATURE_TYPE] = GRID_FLOAT;
    s[SPEC_FILTER] = FILTER_STOCHASTIC;
    s[SPEC_SCATTERING] = SCATTERING_MULTIPLE;
    s[SPEC_NEE] = NEE_NONE;
    s[SPEC_EMISSION] = EMISSION_NONE;
    s[SPEC_EMISSION_AT] = EMISSION_AT_COLLISIONS;
    s[SPEC_FREE_FLIGHT] = FREE_FLIGHT_DELTA;
    s[SPEC_TRANSMITTANCE] = TRANSMITTANCE_ANALYTIC;
    s[SPEC_STEPS] = 1;
    return s;
}

Specialization with(std::initializer_list<std::pair<int, int>> changes) {
    Specialization s = plain();
    for (const auto& [id, value] : changes)
        s[id] = value;
    return s;
}

} // namespace

TEST_CASE("a kernel touches the buffers of what its scene has, and no others", "[gpu][specialization][long]") {
    const std::set<int> always = {BINDING_FRAME,       BINDING_PATHS,  BINDING_FILM,
                                  BINDING_QUEUE_ITEMS, BINDING_QUEUES, BINDING_COUNTERS};
    const auto touches = [&](std::initializer_list<std::pair<int, int>> changes, std::set<int> more) {
        more.insert(always.begin(), always.end());
        CHECK(specialise(fused_spv, with(changes)).bindings == more);
        if (changes.size() == 0)
            CHECK(specialise(fused_chromatic_spv, with(changes)).bindings == more);
    };
    const std::set<int> grid = {BINDING_GRID, BINDING_LEAF_TABLE, BINDING_MAJORANTS};
    const auto grid_and = [&](int binding) {
        std::set<int> all = grid;
        all.insert(binding);
        return all;
    };
    touches({}, grid);
    touches({{SPEC_NEE, NEE_COLLISIONS}, {SPEC_TRANSMITTANCE, TRANSMITTANCE_RATIO}}, grid);
    touches({{SPEC_NEE, NEE_CACHED}, {SPEC_TRANSMITTANCE, TRANSMITTANCE_RATIO}}, grid_and(BINDING_LATTICE));
    touches({{SPEC_NEE, NEE_CACHED}, {SPEC_TRANSMITTANCE, TRANSMITTANCE_RATIO}, {SPEC_TEXELS, 1}},
            {BINDING_GRID_TEXELS, BINDING_LEAF_TEXELS, BINDING_MAJORANT_TEXELS, BINDING_LATTICE_TEXELS});
    touches({{SPEC_EMISSION, EMISSION_CONSTANT}}, grid);
    touches({{SPEC_EMISSION, EMISSION_COLOR}}, grid);
    touches({{SPEC_EMISSION, EMISSION_BLACKBODY}}, grid_and(BINDING_BLACKBODY));
    touches({{SPEC_FREE_FLIGHT, FREE_FLIGHT_DECOMPOSITION}}, grid_and(BINDING_CONTROLS));
    touches({{SPEC_NEE, NEE_COLLISIONS}, {SPEC_TRANSMITTANCE, TRANSMITTANCE_RESIDUAL}}, grid_and(BINDING_CONTROLS));
    touches({{SPEC_TRACE, 1}}, grid_and(BINDING_TRACE));
    touches({{SPEC_FREE_FLIGHT, FREE_FLIGHT_MARCH}, {SPEC_FILTER, FILTER_TRILINEAR}},
            {BINDING_GRID, BINDING_LEAF_TABLE});
    touches({{SPEC_SHAPE, SHAPE_SPHERE}, {SPEC_FIELD, FIELD_CONSTANT}, {SPEC_FREE_FLIGHT, FREE_FLIGHT_ANALYTIC}}, {});
    touches({{SPEC_SHAPE, SHAPE_SPHERE}, {SPEC_FIELD, FIELD_NOISE}}, {});
    touches({{SPEC_SHAPE, SHAPE_MESH}, {SPEC_FIELD, FIELD_NOISE}}, {BINDING_TRIANGLES, BINDING_BVH});
    const auto lights_touch = [&](int lights, std::set<int> more) {
        more.insert(always.begin(), always.end());
        more.insert(grid.begin(), grid.end());
        const Specialization s = with({{SPEC_NEE, NEE_COLLISIONS}, {SPEC_LIGHTS, lights}});
        CHECK(specialise(fused_full_spv, s).bindings == more);
    };
    for (const int map : {MAP_DENSITY, MAP_ALBEDO, MAP_GLOW})
        CHECK(
            specialise(fused_full_spv, with({{SPEC_MAP, map}, {SPEC_MAP_HALVINGS, 3}, {SPEC_FILTER, FILTER_TRILINEAR}}))
                .bindings.contains(BINDING_MAPS));
    lights_touch(LIGHTS_LONE, {});
    lights_touch(LIGHTS_TABLE, {BINDING_LIGHTS});
    lights_touch(LIGHTS_TABLE | LIGHTS_TREE, {BINDING_LIGHTS, BINDING_LIGHT_TREE});
    lights_touch(LIGHTS_TABLE | LIGHTS_TREE | LIGHTS_AIMED, {BINDING_LIGHTS, BINDING_LIGHT_TREE});
    const int map = LIGHTS_TABLE | LIGHTS_SKY | LIGHTS_MAP;
    lights_touch(LIGHTS_TABLE | LIGHTS_SKY, {BINDING_LIGHTS}); // suns alone
    lights_touch(map, {BINDING_LIGHTS, BINDING_SKY, BINDING_SKY_ALIAS});
    lights_touch(map | LIGHTS_EQUAL_AREA, {BINDING_LIGHTS, BINDING_SKY, BINDING_SKY_ALIAS});
    std::set<int> texels = {BINDING_LIGHT_TEXELS, BINDING_SKY_TEXELS, BINDING_SKY_ALIAS_TEXELS};
    texels.insert(always.begin(), always.end());
    texels.insert(grid.begin(), grid.end());
    const Specialization sky = with({{SPEC_NEE, NEE_COLLISIONS}, {SPEC_LIGHTS, map}, {SPEC_TABLE_TEXELS, 1}});
    CHECK(specialise(fused_full_spv, sky).bindings == texels);
}

TEST_CASE("every feature costs instructions only where a scene has it", "[gpu][specialization][long]") {
    const auto count = [](std::initializer_list<std::pair<int, int>> changes) {
        return specialise(fused_spv, with(changes)).instructions;
    };
    const int none = count({});
    REQUIRE(none > 300); // a path tracer's, no empty shell
    const std::pair<int, int> nee{SPEC_NEE, NEE_COLLISIONS}, ratio{SPEC_TRANSMITTANCE, TRANSMITTANCE_RATIO};
    const int lit = count({nee, ratio});
    CHECK(none < lit);
    CHECK(lit < count({{SPEC_NEE, NEE_TENTATIVE}, ratio}));
    const int constant = count({{SPEC_EMISSION, EMISSION_CONSTANT}}), color = count({{SPEC_EMISSION, EMISSION_COLOR}});
    CHECK(none < constant);
    CHECK(constant < color); // a second grid
    CHECK(color < count({{SPEC_EMISSION, EMISSION_BLACKBODY}}));
    CHECK(constant < count({{SPEC_EMISSION, EMISSION_CONSTANT}, {SPEC_EMISSION_AT, EMISSION_AT_STEPS}}));
    CHECK(none < specialise(fused_chromatic_spv, plain()).instructions);
    CHECK(none == specialise(fused_full_spv, plain()).instructions);
    CHECK(none == specialise(fused_full_spv, with({{SPEC_MAP_HALVINGS, 3}})).instructions);
    CHECK(none < count({{SPEC_FILTER, FILTER_TRILINEAR}}));
    CHECK(none < count({{SPEC_LEAPS, 1}}));
    // What is switched off leaves nothing behind, whatever the constants that describe it say.
    CHECK(none == count({ratio}));
    CHECK(none == count({{SPEC_TRANSMITTANCE, TRANSMITTANCE_TELESCOPING}}));
    CHECK(none == count({{SPEC_EMISSION_AT, EMISSION_AT_STEPS}}));
    CHECK(none == count({{SPEC_TEMPERATURE_TYPE, GRID_FPN}}));
    // Estimators do not carry one another: the simple flight is the shortest of those by null collisions. In noise,
    // where none of them looks ahead.
    const std::pair<int, int> noise{SPEC_FIELD, FIELD_NOISE};
    const int delta = count({noise});
    CHECK(delta < count({noise, {SPEC_FREE_FLIGHT, FREE_FLIGHT_WEIGHTED}}));
    CHECK(delta < count({noise, {SPEC_FREE_FLIGHT, FREE_FLIGHT_DECOMPOSITION}}));
    CHECK(delta < count({noise, {SPEC_FREE_FLIGHT, FREE_FLIGHT_SPECTRAL}}));
    CHECK(count({nee, ratio, noise}) < count({nee, noise, {SPEC_TRANSMITTANCE, TRANSMITTANCE_RESIDUAL}}));
}

TEST_CASE("what few scenes have is compiled in a form of its own", "[cpu][specialization]") {
    const Kernel plain = read_kernel(Words(std::begin(fused_spv), std::end(fused_spv)));
    const Kernel full = read_kernel(Words(std::begin(fused_full_spv), std::end(fused_full_spv)));
    for (const int binding :
         {BINDING_LIGHTS, BINDING_LIGHT_TREE, BINDING_SKY, BINDING_SKY_ALIAS, BINDING_PHASE, BINDING_MAPS}) {
        CAPTURE(binding);
        CHECK(!plain.bindings.contains(binding)); // declared they may be, by newer compilers
        CHECK(full.bindings.contains(binding));
    }
}

// What nobody asks a FULL kernel for would silently be what kernels without FULL have built in.
TEST_CASE("each constant that kernels have only with FULL asks for FULL", "[cpu][specialization]") {
    Specialization plain{};
    plain[SPEC_ALBEDO_TYPE] = GRID_FLOAT;
    CHECK(!needs_full(plain));
    Specialization all;
    all.fill(1);
    const Specialization without = declared_of(fused_spv, all), with = declared_of(fused_full_spv, all);
    int only_with = 0;
    for (std::size_t id = 0; id < all.size(); ++id) {
        CAPTURE(id);
        Specialization changed = plain;
        changed[id] += 1;
        CHECK(without[id] <= with[id]);
        // These two are for what asks for FULL itself: lights of a table, and tables.
        if (without[id] != with[id] && id != SPEC_MIS && id != SPEC_TABLE_TEXELS)
            CHECK(needs_full(changed));
        only_with += without[id] != with[id];
    }
    CHECK(only_with >= 13);
}
