// What passes hand on in memory: a path that is laid aside is the same when it is taken up.
#include <algorithm>
#include <catch2/catch.hpp>

#include "laid_aside_forms.h"
#include "plan.h"
#include "specialization.h"
#include "support/test_device.h"
#include "support/thorough.h"

#include "bindings.h"
#include "commands.h"
#include "compute_pass.h"
#include "shared/estimators.h"
#include "shared/frame.h"

using namespace vkvol;

namespace {

constexpr std::uint32_t lanes = 96, most_words = 256; // more than a path has, also with those that walks leave out
static_assert(MOST_PATH_WORDS < most_words);

struct LaidAside {
    std::vector<std::uint32_t> compared; // pairs: was, is; all bits set: nothing
    std::vector<std::uint32_t> memory;
};

// Lanes do what is to be done in turn.
LaidAside lay_aside(std::span<const std::uint32_t> kernel, const Specialization& constants,
                    std::span<const std::uint32_t> todo, bool amid) {
    const auto storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    const auto buffer = [&](std::size_t words) {
        return Buffer(test_device(), "laid aside test", words * 4, storage, BufferPlace::device);
    };
    Commands commands(test_device());
    const Buffer input = buffer(lanes + 1), output = buffer(2 * lanes * most_words),
                 paths = buffer(lanes * MOST_PATH_WORDS);
    const Buffer frame(test_device(), "frame", sizeof(shared::FrameParams), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
                       BufferPlace::device);
    const shared::FrameParams nothing{};
    commands.upload(frame, std::as_bytes(std::span(&nothing, 1)));
    std::vector<std::uint32_t> asked;
    for (std::uint32_t lane = 0; lane < lanes; ++lane)
        asked.push_back(todo[lane % todo.size()]);
    asked.push_back(amid);
    commands.upload(input, std::as_bytes(std::span(asked)));
    commands.fill(output, 0xffffffffu);
    commands.fill(paths, 0xffffffffu);
    BoundBuffers bound{};
    bound[BINDING_FRAME] = &frame;
    bound[BINDING_PATHS] = &paths;
    bound[BINDING_TEST_INPUT] = &input;
    bound[BINDING_TEST_OUTPUT] = &output;
    const Bindings bindings(test_device(), bound);
    const ComputePass pass(test_device(), bindings, kernel, constants, nullptr);
    shared::PassPush push{};
    push.lanes = lanes;
    push.budget = most_words;
    commands.run([&](VkCommandBuffer c) {
        pass.record(c, push, lanes);
        record_barrier(c);
    });
    LaidAside result{std::vector<std::uint32_t>(2 * lanes * most_words),
                     std::vector<std::uint32_t>(lanes * MOST_PATH_WORDS)};
    commands.download(output, std::as_writable_bytes(std::span(result.compared)));
    commands.download(paths, std::as_writable_bytes(std::span(result.memory)));
    return result;
}

Specialization all_of(bool media, bool surfaces) {
    Specialization s{};
    s[SPEC_STEPS] = 1;
    s[SPEC_SHAPE] = media ? SHAPE_BOX : SHAPE_MESH;
    s[SPEC_FIELD] = media ? FIELD_SUPERPOSITION : FIELD_GRID;
    s[SPEC_CELL_BITS] = media ? 2 : 0;
    s[SPEC_NEE] = media ? NEE_COLLISIONS : NEE_CACHED;
    s[SPEC_FREE_FLIGHT] = media ? FREE_FLIGHT_DELTA : FREE_FLIGHT_DECOMPOSITION;
    s[SPEC_TRANSMITTANCE] = media ? TRANSMITTANCE_RATIO : TRANSMITTANCE_TELESCOPING;
    s[SPEC_LIGHTS] = LIGHTS_TABLE | LIGHTS_SKY;
    s[SPEC_FIRST_FLIGHT] = media ? FIRST_FLIGHT_SPLIT : FIRST_FLIGHT_DRAWN;
    s[SPEC_DISTANCE] = surfaces ? DISTANCE_FLIGHTS : DISTANCE_MIXED;
    s[SPEC_LAYERS] = LAYERS_KINDS;
    s[SPEC_PATHS] = media ? PATHS_BOTH : PATHS_CAMERA;
    s[SPEC_PERIODIC] = media ? 1 : 0;
    s[SPEC_MATERIALS] = 1 << MATERIAL_DIFFUSE;
    return s;
}

constexpr std::uint32_t amid_segments[] = {TODO_FLY, TODO_SEE, TODO_SEEK, TODO_CHECK};
constexpr std::uint32_t at_vertices[] = {TODO_DEPART, TODO_LOOK, TODO_SET_OUT, TODO_GO, TODO_END};

} // namespace

TEST_CASE("a path that is laid aside is the same when it is taken up", "[gpu][layout]") {
    std::size_t turn = 0;
    const auto check = [&](unsigned form, Specialization constants) {
        // Word by word where no driver would do it takes long to compile.
        for (const int copies :
             test_device().writes_out_lanes() ? std::vector{1} : in_turn(std::vector{0, 1}, turn++, 2)) {
            constants[SPEC_COPIES] = copies;
            // The words of a path that have been compared, for each that may be done next.
            const auto kept = [&](std::span<const std::uint32_t> todo, bool amid) {
                const LaidAside result = lay_aside(laid_aside_forms[form], constants, todo, amid);
                CAPTURE(form, copies, amid);
                std::vector<int> compared(lanes);
                std::size_t lost = 0;
                for (std::size_t i = 0; i < result.compared.size(); i += 2) {
                    compared[i / (2 * most_words)] += result.compared[i] != 0xffffffffu;
                    lost += result.compared[i] != result.compared[i + 1];
                }
                CHECK(lost == 0);
                return compared;
            };
            const std::vector<int> at_vertex = kept(at_vertices, false), amid = kept(amid_segments, true);
            CHECK(*std::ranges::min_element(at_vertex) >= 17); // a vertex and its throughput
            CHECK(*std::ranges::min_element(amid) >= 17);
            CHECK(amid[0] > at_vertex[0] + 12); // a walk's
        }
    };
    check(0, Specialization{});
    Specialization sky{};
    sky[SPEC_LIGHTS] = LIGHTS_TABLE | LIGHTS_SKY; // whose light flights meet, and nothing looks for
    check(form_full, sky);
    Specialization rests = all_of(false, false); // flights, while shadow rays are sent amid them
    rests[SPEC_NEE] = NEE_TENTATIVE;
    check(form_full, rests);
    check(form_full, all_of(false, false));
    check(form_full | form_surfaces, all_of(false, true));
    check(form_full | form_several, all_of(true, false));
    check(form_full | form_several | form_surfaces, all_of(true, true));
}

// `generate` knows nothing of several media, and hands its paths to passes that do.
TEST_CASE("what paths from the camera need lies alike, whether passes know of several media or not", "[gpu][layout]") {
    const auto memory_of = [](unsigned form) {
        return lay_aside(laid_aside_forms[form], all_of(true, true), at_vertices, false).memory;
    };
    CHECK(memory_of(form_full | form_surfaces) == memory_of(form_full | form_several | form_surfaces));
}

// Passes without lanes find these by number. (The kernel fills fields with numbers one after another.)
TEST_CASE("the first words of a path are what they are called", "[gpu][layout]") {
    const auto memory = lay_aside(laid_aside_forms[0], Specialization{}, at_vertices, false).memory;
    const std::uint32_t path = 5, first = 0x40000000u + path * 4096;
    const std::uint32_t* words = &memory[path * MOST_PATH_WORDS];
    CHECK(words[PATH_TODO] == at_vertices[path % std::size(at_vertices)]);
    CHECK(words[PATH_PIXEL] == first + 2);
    CHECK(words[PATH_PLACE] == first + 3);
    CHECK(words[PATH_SAMPLE] == first + 4);
}
