#include "number_table.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <sstream>

#include "error.h"
#include "input_file.h"
#include "number_text.h"
#include "one_line.h"

namespace vkvol {

namespace {

constexpr std::size_t longest_line = 4096;
constexpr std::size_t longest_file = 256 << 20;
constexpr double largest_value = 1e30;

std::vector<std::string> words_of(std::string line) {
    line.erase(std::find(line.begin(), line.end(), '#'), line.end());
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c == ',' || c == ';' || c == '\t' || c == '\r'; }, ' ');
    std::istringstream stream(line);
    std::vector<std::string> words;
    for (std::string word; stream >> word;)
        words.push_back(word);
    return words;
}

std::optional<double> number_of(const std::string& word) {
    const NumberText read = read_number_text(word);
    const bool good = read.is_number && !read.is_too_large && std::abs(read.value) <= largest_value;
    return good ? std::optional(read.value) : std::nullopt;
}

void read_row(const std::filesystem::path& file, const NumberTableForm& form, int line,
              const std::vector<std::string>& words, NumberTable& table) {
    for (const std::string& word : words) {
        const std::optional<double> value = number_of(word);
        if (!value)
            fail_line(file, line, fmt::format("'{}' is no number; {}", one_line(word.substr(0, 40)), form.expected));
        table.numbers.push_back(*value);
    }
    table.width = table.width == 0 ? words.size() : table.width;
    if (words.size() != table.width || words.size() < form.narrowest || words.size() > form.widest)
        fail_line(file, line, fmt::format("has {} numbers; {}", words.size(), form.expected));
    table.lines.push_back(line);
    if (table.rows() > form.most_rows)
        fail_line(file, line, fmt::format("more than {} lines; thin it out", form.most_rows));
}

// No number, nor what a program writes where it has none.
bool is_heading(const std::vector<std::string>& words) {
    return std::none_of(words.begin(), words.end(), [](std::string word) {
        std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return std::tolower(c); });
        word.erase(0, word.find_first_not_of("+-"));
        return number_of(word).has_value() || word == "nan" || word == "inf" || word == "infinity";
    });
}

} // namespace

void fail_line(const std::filesystem::path& file, int line, const std::string& message) {
    throw InputError(fmt::format("{}:{}: {}", file.string(), line, message));
}

NumberTable read_number_table(const std::filesystem::path& file, const NumberTableForm& form) {
    check_input_file(file, form.remedy);
    std::istringstream text(read_input_text(file, longest_file, form.remedy));
    NumberTable table;
    std::string line;
    bool may_be_heading = form.may_have_heading;
    for (int number = 1; std::getline(text, line); ++number) {
        if (line.size() > longest_line)
            fail_line(file, number, "a very long line; is this the text file that was meant?");
        const std::vector<std::string> words = words_of(line);
        if (words.empty())
            continue;
        if (!may_be_heading || !is_heading(words))
            read_row(file, form, number, words, table);
        may_be_heading = false;
    }
    return table;
}

} // namespace vkvol
