// The ring queues, with the renderer's own prepare pass between pushing and popping: nothing is lost, doubled or
// written where it does not belong.
#include <algorithm>
#include <catch2/catch.hpp>
#include <deque>
#include <random>

#include "prepare.spv.h"
#include "queue_pop.spv.h"
#include "queue_push.spv.h"
#include "support/kernel_runner.h"
#include "support/test_device.h"

using namespace vkvol;

namespace {

constexpr std::uint32_t guard = 0xabcdef01u;
constexpr std::uint32_t queue = QUEUE_RESUME; // has another queue on either side

class Ring {
public:
    explicit Ring(std::uint32_t capacity, std::uint32_t start = 0)
        : capacity_(capacity), commands_(test_device()),
          frame_(test_device(), "frame", sizeof(shared::FrameParams), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
                 BufferPlace::device),
          headers_(buffer(QUEUE_COUNT * sizeof(shared::QueueHeader))), items_(buffer(QUEUE_COUNT * capacity * 4)),
          counters_(buffer(sizeof(shared::Counters))), input_(buffer(most_lanes * 4)), output_(buffer(most_lanes * 4)),
          bindings_(test_device(), bound()), prepare_(test_device(), bindings_, prepare_spv, {}, VK_NULL_HANDLE),
          push_(test_device(), bindings_, queue_push_spv, {}, VK_NULL_HANDLE),
          pop_(test_device(), bindings_, queue_pop_spv, {}, VK_NULL_HANDLE) {
        shared::FrameParams frame{};
        frame.queue_capacity = capacity;
        commands_.upload(frame_, std::as_bytes(std::span(&frame, 1)));
        commands_.fill(counters_, 0);
        commands_.fill(items_, guard);
        const std::vector<shared::QueueHeader> headers(QUEUE_COUNT, {start, start, start, start, 0, 1, 1});
        commands_.upload(headers_, std::as_bytes(std::span(headers)));
    }

    void push(const std::vector<std::uint32_t>& items) {
        commands_.upload(input_, std::as_bytes(std::span(items)));
        run(push_, make_push(static_cast<std::uint32_t>(items.size())), items.size());
    }

    // Fixes what the next pop sees, as before every pass.
    void prepare(std::uint32_t lanes) { run(prepare_, make_push(lanes), 1); }

    // Every invocation of the prepared dispatch takes up to `each` items; returns what they found, sorted.
    std::vector<std::uint32_t> pop(std::uint32_t each = 1, bool put_back = false) {
        commands_.fill(output_, NO_PIXEL);
        shared::PassPush push = make_push(most_lanes);
        push.places = put_back;
        push.budget = each;
        commands_.run([&](VkCommandBuffer c) {
            pop_.record_indirect(c, push, headers_,
                                 queue * sizeof(shared::QueueHeader) + offsetof(shared::QueueHeader, groups_x));
            record_barrier(c);
        });
        std::vector<std::uint32_t> found(most_lanes);
        commands_.download(output_, std::as_writable_bytes(std::span(found)));
        std::erase(found, NO_PIXEL);
        std::sort(found.begin(), found.end());
        return found;
    }

    shared::QueueHeader header() {
        std::array<shared::QueueHeader, QUEUE_COUNT> headers;
        commands_.download(headers_, std::as_writable_bytes(std::span(headers)));
        return headers[queue];
    }
    std::vector<std::uint32_t> items() {
        std::vector<std::uint32_t> items(QUEUE_COUNT * capacity_);
        commands_.download(items_, std::as_writable_bytes(std::span(items)));
        return items;
    }
    std::uint32_t overflows() {
        shared::Counters counters;
        commands_.download(counters_, std::as_writable_bytes(std::span(&counters, 1)));
        return counters.queue_overflows;
    }
    // Neither of the queues before and after has been written.
    bool guards_stand() {
        const auto words = items();
        return std::all_of(words.begin(), words.begin() + queue * capacity_, [](auto w) { return w == guard; }) &&
               std::all_of(words.begin() + (queue + 1) * capacity_, words.end(), [](auto w) { return w == guard; });
    }

private:
    static constexpr std::uint32_t most_lanes = 4096;

    static shared::PassPush make_push(std::uint32_t lanes) {
        shared::PassPush push{};
        push.queue = queue;
        push.lanes = lanes;
        return push;
    }
    static Buffer buffer(VkDeviceSize bytes) {
        return {test_device(), "queue test", bytes,
                VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT, BufferPlace::device};
    }
    BoundBuffers bound() const {
        BoundBuffers buffers{};
        buffers[BINDING_FRAME] = &frame_;
        buffers[BINDING_QUEUES] = &headers_;
        buffers[BINDING_QUEUE_ITEMS] = &items_;
        buffers[BINDING_COUNTERS] = &counters_;
        buffers[BINDING_TEST_INPUT] = &input_;
        buffers[BINDING_TEST_OUTPUT] = &output_;
        return buffers;
    }
    void run(const ComputePass& pass, const shared::PassPush& push, std::size_t threads) {
        commands_.run([&](VkCommandBuffer c) {
            pass.record(c, push, static_cast<std::uint32_t>(threads));
            record_barrier(c);
        });
    }

    std::uint32_t capacity_;
    Commands commands_;
    Buffer frame_, headers_, items_, counters_, input_, output_;
    Bindings bindings_;
    ComputePass prepare_, push_, pop_;
};

std::vector<std::uint32_t> numbers(std::uint32_t first, std::uint32_t count) {
    std::vector<std::uint32_t> list(count);
    for (std::uint32_t i = 0; i < count; ++i)
        list[i] = first + i;
    return list;
}

} // namespace

TEST_CASE("an empty queue dispatches nothing and gives nothing", "[gpu][queue]") {
    Ring ring(256);
    for (int round = 0; round < 3; ++round) {
        ring.prepare(1000);
        CHECK(ring.header().groups_x == 0u);
        CHECK(ring.pop().empty());
    }
    CHECK(ring.overflows() == 0u);
}

TEST_CASE("one item, whole groups and one more come back once each", "[gpu][queue]") {
    const std::uint32_t count =
        GENERATE(1u, 2u, WORKGROUP_SIZE - 1u, WORKGROUP_SIZE + 0u, WORKGROUP_SIZE + 1u, 3u * WORKGROUP_SIZE, 256u);
    CAPTURE(count);
    Ring ring(256);
    ring.push(numbers(1000, count));
    ring.prepare(4096);
    CHECK(ring.header().groups_x == (count + WORKGROUP_SIZE - 1) / WORKGROUP_SIZE);
    CHECK(ring.header().groups_y == 1u);
    CHECK(ring.header().groups_z == 1u);
    CHECK(ring.pop() == numbers(1000, count));
    // Lanes beyond the last item ran past the end; what comes next is not harmed.
    for (int again = 0; again < 3; ++again) {
        ring.prepare(4096);
        CHECK(ring.header().groups_x == 0u);
        CHECK(ring.pop().empty());
    }
    ring.push(numbers(7, 5));
    ring.prepare(4096);
    CHECK(ring.pop(3) == numbers(7, 5)); // 64 lanes ask three times each for five items
    ring.push(numbers(20, 2));
    ring.prepare(4096);
    CHECK(ring.pop() == numbers(20, 2));
    CHECK(ring.overflows() == 0u);
}

TEST_CASE("what is pushed after prepare waits for the next round", "[gpu][queue]") {
    Ring ring(256);
    ring.push(numbers(0, 70));
    ring.prepare(4096);
    ring.push(numbers(500, 10));
    CHECK(ring.pop() == numbers(0, 70));
    ring.prepare(4096);
    CHECK(ring.pop() == numbers(500, 10));
    // A consumer that puts items back into its own queue finds each once a round.
    ring.push(numbers(0, 100));
    const std::uint32_t lanes = GENERATE(64u, 4096u);
    for (int round = 0; round < 20; ++round) {
        ring.prepare(lanes);
        CHECK(ring.pop(8, true) == numbers(0, 100));
    }
    CHECK(ring.overflows() == 0u);
    CHECK(ring.guards_stand());
}

TEST_CASE("many rounds with leftovers wrap around the ring and around 2^32", "[gpu][queue]") {
    const std::uint32_t start = GENERATE(0u, 0xfffffc00u, 0x7ffffd00u); // positions reach 2^32 or 2^31 on the way
    const std::uint32_t each = GENERATE(1u, 3u);
    Ring ring(256, start);
    std::mt19937 engine(3);
    std::deque<std::uint32_t> expected;
    std::uint32_t next = 1;
    for (int round = 0; round < 120; ++round) {
        // As in a render: half as many slots as places, each in the queue at most once.
        const std::uint32_t count = std::min<std::uint32_t>(engine() % 129, 128 - expected.size());
        if (count > 0)
            ring.push(numbers(next, count));
        for (std::uint32_t i = 0; i < count; ++i)
            expected.push_back(next++);
        const std::uint32_t lanes = 1 + engine() % 128;
        ring.prepare(lanes);
        const std::uint32_t groups =
            (std::min<std::uint32_t>(lanes, expected.size()) + WORKGROUP_SIZE - 1) / WORKGROUP_SIZE;
        REQUIRE(ring.header().groups_x == groups);
        // The oldest come first; pushes of one dispatch are in no order among themselves, so compare across rounds by
        // what must still be there.
        const auto found = ring.pop(each);
        const std::size_t most = std::size_t{groups} * WORKGROUP_SIZE * each;
        REQUIRE(found.size() == std::min<std::size_t>(expected.size(), most));
        for (const std::uint32_t item : found) {
            const auto place = std::find(expected.begin(), expected.end(), item);
            REQUIRE(place != expected.end());
            expected.erase(place);
        }
    }
    CHECK(next > 1024u); // wrapped many times
    CHECK(ring.overflows() == 0u);
    CHECK(ring.guards_stand());
}

TEST_CASE("items that find no place are counted and written nowhere", "[gpu][queue]") {
    Ring ring(128, GENERATE(0u, 100u, 0xffffffc0u));
    ring.push(numbers(1, 128));
    CHECK(ring.overflows() == 0u);
    const auto full = ring.items();
    ring.push(numbers(1000, 37));
    CHECK(ring.overflows() == 37u);
    CHECK(ring.items() == full); // the items in the ring stand, and so do its neighbours
    CHECK(ring.guards_stand());

    // Items that are being consumed keep their places until the next prepare: half full when the pass begins, the ring
    // takes another half and no more.
    Ring half(128);
    half.push(numbers(1, 64));
    half.prepare(4096);
    half.push(numbers(200, 64));
    CHECK(half.overflows() == 0u);
    half.push(numbers(400, 1));
    CHECK(half.overflows() == 1u);
    CHECK(half.pop() == numbers(1, 64));
    CHECK(half.guards_stand());
}
