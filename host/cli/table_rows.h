// A table of texts as it is read and written.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vkvol {

using TableRows = std::vector<std::vector<std::string>>; // the first is the heading

// Of a text that has commas between its values, none of them quoted.
TableRows rows_of(const std::string& table);

// Values that need it are quoted.
std::string as_csv(const TableRows& rows);

// As the file's ending wants it: .json, a list of an object for each row, with numbers, null for what is empty, and
// else texts; or commas.
std::string as_file(const std::filesystem::path& file, const TableRows& rows);

// In columns, for reading.
std::string as_text(const TableRows& rows);

} // namespace vkvol
