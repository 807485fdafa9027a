#include "trace.h"

#include <array>
#include <fmt/format.h>

#include "shared/constants.h"

namespace vkvol {

TraceBuffer::TraceBuffer(const Device& device, Commands& commands)
    : buffer_(device, "trace", sizeof(std::uint32_t) + TRACE_RECORDS * sizeof(shared::TraceRecord),
              VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, BufferPlace::device) {
    commands.fill(buffer_, 0);
}

std::vector<shared::TraceRecord> TraceBuffer::records(Commands& commands) const {
    std::uint32_t count = 0;
    commands.download(buffer_, std::as_writable_bytes(std::span(&count, 1)));
    std::vector<shared::TraceRecord> records(std::min<std::uint32_t>(count, TRACE_RECORDS));
    commands.download(buffer_, std::as_writable_bytes(std::span(records)), sizeof count);
    return records;
}

namespace {

std::string triple(const glm::dvec3& v) {
    return fmt::format("{:.6g} {:.6g} {:.6g}", v.x, v.y, v.z);
}

const char* kind_name(const shared::TraceRecord& record) {
    constexpr std::array names = {"scatter", "collision", "light", "escape", "end", "surface", "source"};
    static_assert(names.size() == TRACE_KINDS);
    return record.kind == TRACE_DEPART && record.depth == 0 ? "camera" : names[record.kind];
}

} // namespace

std::string trace_table(const std::vector<shared::TraceRecord>& records, const glm::dvec3& origin,
                        const glm::dvec3& radiance) {
    if (records.empty())
        return fmt::format("the path never meets the medium: radiance {}\n", triple(radiance));
    const char* const row = "{:<10} {:>6} {:>7}  {:<36} {:<33} {:<33} {:<33} {}\n";
    std::string table = fmt::format(fmt::runtime(row), "vertex", "depth", "steps", "position (world)", "direction",
                                    "throughput", "transmittance to the light", "radiance so far");
    for (const shared::TraceRecord& r : records)
        table += fmt::format(fmt::runtime(row), kind_name(r), r.depth, r.steps, triple(origin + glm::dvec3(r.position)),
                             triple(r.direction), triple(r.beta), r.kind == TRACE_LIGHT ? triple(r.T) : "",
                             triple(r.radiance));
    if (records.size() == TRACE_RECORDS)
        table += fmt::format("({} vertices are kept; the rest is left out)\n", TRACE_RECORDS);
    return table;
}

} // namespace vkvol
