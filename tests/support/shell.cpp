#include "shell.h"

#include <catch2/catch.hpp>
#include <cstdio>
#include <sys/wait.h>

namespace vkvol {

Run run(const std::string& command) {
    Run result;
    FILE* pipe = popen(("{ " + command + "\n} 2>&1").c_str(), "r");
    REQUIRE(pipe);
    char part[4096];
    while (const std::size_t size = fread(part, 1, sizeof part, pipe))
        result.text.append(part, size);
    const int status = pclose(pipe);
    result.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return result;
}

} // namespace vkvol
