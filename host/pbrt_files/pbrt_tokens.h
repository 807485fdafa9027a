// Words of pbrt scene files, as pbrt-v4 tells them apart.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace vkvol {

struct PbrtPlace {
    std::shared_ptr<const std::string> file;
    int line = 1, column = 1;

    std::string text() const; // "file:line:column"
};

[[noreturn]] void fail_at(const PbrtPlace& place, const std::string& message); // InputError

struct PbrtToken {
    enum class Kind { end, word, quoted, open, close };
    Kind kind = Kind::end;
    std::string value; // without quotes
    PbrtPlace place;

    bool is(Kind wanted) const { return kind == wanted; }
};

class PbrtTokens {
public:
    // Throws InputError for files that cannot be read.
    explicit PbrtTokens(const std::filesystem::path& file);
    // The same of a text in memory, called `name` in messages.
    PbrtTokens(std::string text, std::string name);

    // Throws InputError for what is no word. At the end of a file that another one includes, that goes on.
    PbrtToken next();
    PbrtToken next(PbrtToken::Kind kind, const char* expected); // InputError for any other
    void put_back(PbrtToken token) { back_ = std::move(token); }
    double number();

    // Goes on with that file. Throws InputError for files that include one another, or too many.
    void include(const std::filesystem::path& file, const PbrtPlace& by);
    // Files that are open: that of the last token, and those that include it.
    std::size_t depth() const { return sources_.size(); }

private:
    struct Source {
        std::string text;
        std::size_t at = 0;
        PbrtPlace place;
        std::filesystem::path file;
    };

    void open(std::string text, const std::string& name, const std::filesystem::path& file);
    char take();
    void skip_space();
    PbrtToken quoted();

    std::vector<Source> sources_; // the last one is being read
    PbrtPlace end_;               // of the last that has been read
    std::optional<PbrtToken> back_;
    int includes_ = 0;
};

// All of `text`, a number. Nothing if it is none, or not finite.
std::optional<double> pbrt_number(const std::string& text);

} // namespace vkvol
