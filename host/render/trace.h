// The vertices of one path: recorded by the kernel, printed for people.
#pragma once

#include <string>
#include <vector>

#include "commands.h"
#include "shared/items.h"

namespace vkvol {

class TraceBuffer {
public:
    TraceBuffer(const Device& device, Commands& commands);

    const Buffer& buffer() const { return buffer_; }
    // What was recorded, up to TRACE_RECORDS vertices.
    std::vector<shared::TraceRecord> records(Commands& commands) const;

private:
    Buffer buffer_;
};

// A table, one line a vertex. `origin`: world position of the records' space. `radiance`: of the sample, where the path
// never met the medium, of which there is no record.
std::string trace_table(const std::vector<shared::TraceRecord>& records, const glm::dvec3& origin,
                        const glm::dvec3& radiance);

} // namespace vkvol
