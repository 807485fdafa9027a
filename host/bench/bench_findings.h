// What a bench's figures say, in sentences; tools/report_page/findings.py has more of them. Nothing is claimed that an
// interval does not bear out.
#pragma once

#include "bench_figures.h"
#include "bench_text.h"

namespace vkvol {

// What there is to know about the rows, which are ranked; the last one says which integrator to use.
std::vector<std::string> findings_of(const BenchRequest& request, const BenchResult& result,
                                     const std::vector<Row>& rows);

} // namespace vkvol
