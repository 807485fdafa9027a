// A viewer's page and pictures over HTTP, for this machine alone: it listens on the loopback address, and answers
// nobody who does not know its key.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "view_board.h"

namespace vkvol {

// Whether a request's header Host names the loopback address and this port. Browsers leave out the port 80.
bool is_own_address(const std::string& host, int port);

class ViewServer {
public:
    // `port`: 0 for any that is free. Throws InputError if it is taken. `integrators`: for the page to choose from.
    ViewServer(ViewBoard& board, int port, const std::vector<std::string>& integrators);
    ~ViewServer(); // answers nobody any more

    // With the key.
    std::string address() const;

private:
    struct Serving;
    std::unique_ptr<Serving> serving_;
};

} // namespace vkvol
