// Text files of numbers: a row a line, separated by spaces, tabs, commas or semicolons. `#` begins a comment.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vkvol {

// Rows that have numbers, all of as many.
struct NumberTable {
    std::vector<double> numbers; // row by row, at most 1e30 in magnitude
    std::vector<int> lines;      // where each row was in the file, from 1
    std::size_t width = 0;

    std::size_t rows() const { return lines.size(); }
};

// What a table is to be, for its reader and for its messages.
struct NumberTableForm {
    std::string remedy;   // of a file that cannot be read, after a semicolon
    std::string expected; // what lines are
    std::size_t narrowest = 1, widest = 1;
    std::size_t most_rows = 65536;
    bool may_have_heading = false; // a first line without any number, as tables of other programs have
};

// Throws InputError, "file:line: what is wrong; what would be right".
NumberTable read_number_table(const std::filesystem::path& file, const NumberTableForm& form);

// Throws InputError that names the line.
[[noreturn]] void fail_line(const std::filesystem::path& file, int line, const std::string& message);

} // namespace vkvol
