// `vkvol view`: a scene on a page of the browser, rendered while it is looked at and changed.
#pragma once

#include "options.h"

namespace vkvol {

// Until Ctrl-C. Throws InputError for a scene that cannot be read at first; later the page says so.
int run_view(const ViewOptions& options);

} // namespace vkvol
