#include "file_uses.h"

#include <algorithm>
#include <fmt/format.h>

#include "atomic_file.h"
#include "error.h"
#include "input_file.h"
#include "one_line.h"

namespace vkvol {

namespace {

using std::filesystem::path;

[[noreturn]] void fail(const std::string& message) {
    throw InputError("command line: " + one_line(message));
}

// "cloud.vdb is", or both names where they differ.
std::string both_names(const path& output, const path& other) {
    return output == other ? fmt::format("{} is", output.string())
                           : fmt::format("{} is the same file as {},", output.string(), other.string());
}

} // namespace

path real_name(const path& file) {
    std::error_code error;
    const path absolute = std::filesystem::absolute(behind_links(file), error);
    if (error)
        return file.lexically_normal();
    const path real = std::filesystem::weakly_canonical(absolute, error);
    return error ? absolute.lexically_normal() : real;
}

bool is_same_file(const path& a, const path& b) {
    if (is_special(a) || is_special(b))
        return false;
    std::error_code error;
    if (std::filesystem::equivalent(a, b, error) && !error)
        return true;
    return real_name(a) == real_name(b);
}

void FileUses::reads(const std::string& what, const path& file) {
    const auto is_this = [&](const InputFile& input) { return input.what == what && input.file == file; };
    if (std::none_of(inputs_.begin(), inputs_.end(), is_this)) // volumes may have it in common
        inputs_.push_back({what, file});
}

bool FileUses::is_newer_than_inputs(const path& file) const {
    std::error_code error;
    const auto written = std::filesystem::last_write_time(file, error);
    return !error && std::all_of(inputs_.begin(), inputs_.end(), [&](const InputFile& input) {
        return std::filesystem::last_write_time(input.file, error) < written && !error;
    });
}

void FileUses::reads_files_of(const Scene& scene) {
    for (const InputFile& input : input_files(scene, true))
        reads(input.what, input.file);
}

void FileUses::writes(const std::string& what, const path& file, const std::string& option) {
    outputs_.push_back({what, file, option});
}

void FileUses::check_inputs() const {
    for (const InputFile& input : inputs_)
        check_input_file(input.file, fmt::format("it is {}", input.what));
}

void FileUses::check() const {
    for (std::size_t i = 0; i < outputs_.size(); ++i) {
        const Output& output = outputs_[i];
        for (const InputFile& input : inputs_)
            if (is_same_file(output.file, input.file))
                fail(fmt::format("{} {}, and would be lost to {}; give that another name with {}",
                                 both_names(output.file, input.file), input.what, output.what, output.option));
        for (std::size_t j = 0; j < i; ++j)
            if (const Output& other = outputs_[j]; is_same_file(output.file, other.file)) {
                const std::string names = both_names(output.file, other.file);
                if (output.what == other.what)
                    fail(fmt::format("{} named twice, as {}; once is enough", names, output.what));
                fail(fmt::format("{} to be both {} and {}, and one would be lost; give {} another name "
                                 "with {}",
                                 names, other.what, output.what, output.what, output.option));
            }
    }
}

} // namespace vkvol
