#include "apart.h"

#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>
#include <sstream>

namespace vkvol {

namespace {

#if CATCH_VERSION_MAJOR >= 3
constexpr const char* list = " --list-tests --verbosity quiet";
#else
constexpr const char* list = " --list-test-names-only";
#endif

// As one word of a shell.
std::string word(const std::string& text) {
    std::string quoted = "'";
    for (const char c : text)
        quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

// A test's name as a specification of it alone.
std::string specification(const std::string& name) {
    std::string escaped;
    for (const char c : name)
        escaped += std::string("[],\\\"*").find(c) == std::string::npos ? std::string(1, c) : std::string("\\") + c;
    return escaped;
}

std::string output_of(const std::string& command) {
    std::string text;
    FILE* pipe = popen(command.c_str(), "r");
    for (int c = pipe ? std::fgetc(pipe) : EOF; c != EOF; c = std::fgetc(pipe))
        text += static_cast<char>(c);
    if (pipe)
        pclose(pipe);
    return text;
}

} // namespace

int run_apart(const std::string& program, const std::vector<std::string>& arguments) {
    std::string all = word(program);
    for (const std::string& argument : arguments)
        all += " " + word(argument);
    std::istringstream names(output_of(all + list));
    int failed = 0, tests = 0;
    for (std::string name; std::getline(names, name); ++tests)
        failed += std::system((word(program) + " " + word(specification(name)) + " --durations yes").c_str()) != 0;
    std::printf("%d of %d tests passed, each by itself\n", tests - failed, tests);
    return tests > 0 ? failed : 1;
}

} // namespace vkvol
