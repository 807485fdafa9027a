#include "table_rows.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "file_ending.h"

namespace vkvol {

namespace {

// Not "007", nor "inf": what a number would not be written as, but a key's value may be. ".5" is one.
bool is_plain(const std::string& number) {
    const std::size_t first = number.find_first_not_of('-');
    const std::size_t digit = first != std::string::npos && number[first] == '.' ? first + 1 : first;
    return digit < number.size() && std::isdigit(static_cast<unsigned char>(number[digit])) &&
           !(number[first] == '0' && first + 1 < number.size() &&
             std::isdigit(static_cast<unsigned char>(number[first + 1])));
}

// Not what a key of such a name may have.
bool counts(const std::string& column, const std::string& word) {
    return (column == "column" || column == "row" || column == "samples") && word.size() < 16 &&
           word.find_first_not_of("0123456789") == std::string::npos;
}

// An object for each row: numbers, null for what is not known, and else texts.
std::string as_json(const TableRows& rows) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (std::size_t i = 1; i < rows.size(); ++i) {
        nlohmann::ordered_json object = nlohmann::ordered_json::object();
        for (std::size_t k = 0; k < rows[i].size(); ++k) {
            const std::string& word = rows[i][k];
            double number = 0.0;
            const char* const end = word.data() + word.size();
            const auto [read, error] = std::from_chars(word.data(), end, number);
            if (word.empty())
                object[rows[0][k]] = nullptr;
            else if (error == std::errc() && read == end && is_plain(word))
                object[rows[0][k]] = counts(rows[0][k], word)
                                         ? nlohmann::ordered_json(static_cast<std::int64_t>(number))
                                         : nlohmann::ordered_json(number);
            else
                object[rows[0][k]] = word;
        }
        list.push_back(std::move(object));
    }
    return list.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

} // namespace

TableRows rows_of(const std::string& table) {
    TableRows rows{{""}};
    for (const char c : table) {
        if (c == '\n')
            rows.push_back({""});
        else if (c == ',')
            rows.back().emplace_back();
        else
            rows.back().back() += c;
    }
    rows.pop_back(); // behind the last line's end
    return rows;
}

std::string as_csv(const TableRows& rows) {
    std::string text;
    for (std::vector<std::string> row : rows) {
        for (std::string& word : row)
            if (word.find_first_of("\"\n\r") != std::string::npos) {
                for (std::size_t at = 0; (at = word.find('"', at)) != std::string::npos; at += 2)
                    word.insert(at, 1, '"');
                word = '"' + word + '"';
            }
        text += fmt::format("{}\n", fmt::join(row, ","));
    }
    return text;
}

std::string as_file(const std::filesystem::path& file, const TableRows& rows) {
    return file_ending(file) == ".json" ? as_json(rows) : as_csv(rows);
}

std::string as_text(const TableRows& rows) {
    std::vector<std::size_t> widths(rows.front().size(), 0);
    for (const std::vector<std::string>& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i)
            widths[i] = std::max(widths[i], row[i].size());
    std::string text;
    for (const std::vector<std::string>& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i)
            text += fmt::format("{:>{}}{}", row[i], widths[i], i + 1 < row.size() ? "  " : "\n");
    return text;
}

} // namespace vkvol
