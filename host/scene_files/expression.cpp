#include "expression.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <numbers>
#include <vector>

#include "error.h"
#include "keyed_values.h"
#include "nearest_name.h"
#include "number_text.h"
#include "planck_band.h"

namespace vkvol {

namespace {

constexpr int deepest = 64; // parentheses, signs and powers within each other
using std::numbers::pi;

using Arguments = std::vector<double>;

struct Function {
    const char* name;
    std::size_t fewest, most;
    double (*compute)(const Arguments&);
    const char* takes; // completes "it takes ..."
};

constexpr std::size_t any_number_of = 16;
constexpr std::size_t most_keys = 256;

constexpr const char* keys_text = "where, and then 1 to 256 keys: a place and its value, places ascending";

const std::array functions = {
    Function{"sin", 1, 1, [](const Arguments& a) { return std::sin(a[0]); }, "radians"},
    Function{"cos", 1, 1, [](const Arguments& a) { return std::cos(a[0]); }, "radians"},
    Function{"tan", 1, 1, [](const Arguments& a) { return std::tan(a[0]); }, "radians"},
    Function{"asin", 1, 1, [](const Arguments& a) { return std::asin(a[0]); }, "a number from -1 to 1"},
    Function{"acos", 1, 1, [](const Arguments& a) { return std::acos(a[0]); }, "a number from -1 to 1"},
    Function{"atan", 1, 1, [](const Arguments& a) { return std::atan(a[0]); }, "a number"},
    Function{"atan2", 2, 2, [](const Arguments& a) { return std::atan2(a[0], a[1]); }, "y, x"},
    Function{"sqrt", 1, 1, [](const Arguments& a) { return std::sqrt(a[0]); }, "a number >= 0"},
    Function{"exp", 1, 1, [](const Arguments& a) { return std::exp(a[0]); }, "a number below 709"},
    Function{"log", 1, 1, [](const Arguments& a) { return std::log(a[0]); }, "a number > 0"},
    Function{"pow", 2, 2, [](const Arguments& a) { return std::pow(a[0], a[1]); },
             "base, exponent: of a negative base a whole exponent, of 0 one >= 0"},
    Function{"abs", 1, 1, [](const Arguments& a) { return std::abs(a[0]); }, "a number"},
    Function{"floor", 1, 1, [](const Arguments& a) { return std::floor(a[0]); }, "a number"},
    Function{"ceil", 1, 1, [](const Arguments& a) { return std::ceil(a[0]); }, "a number"},
    Function{"round", 1, 1, [](const Arguments& a) { return std::round(a[0]); }, "a number"},
    Function{"min", 2, any_number_of, [](const Arguments& a) { return *std::min_element(a.begin(), a.end()); },
             "2 to 16 numbers"},
    Function{"max", 2, any_number_of, [](const Arguments& a) { return *std::max_element(a.begin(), a.end()); },
             "2 to 16 numbers"},
    Function{"planck", 3, 3, planck_band, "kelvin > 0, and the wavelengths of a band in micrometres, 0 <= from < to"},
    Function{"linear", 3, 1 + 2 * most_keys, linear_keys, keys_text},
    Function{"spline", 3, 1 + 2 * most_keys, spline_keys, keys_text}};

bool begins_name(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

bool in_name(char c) {
    return begins_name(c) || (c >= '0' && c <= '9');
}

} // namespace

double Expression::evaluate() {
    const double value = sum();
    if (at_ == text_.size())
        fail("the closing } is missing");
    if (text_[at_] != '}')
        fail(fmt::format("unexpected '{}'; expected + - * / % ^ or the closing }}", text_.substr(at_, 10)));
    return value;
}

double Expression::sum() {
    double value = product();
    while (true) {
        if (accept('+'))
            value = finite(value + product(), "+", "smaller numbers");
        else if (accept('-'))
            value = finite(value - product(), "-", "smaller numbers");
        else
            return value;
    }
}

double Expression::product() {
    double value = signed_power();
    while (true) {
        const bool multiplies = accept('*');
        const bool divides = !multiplies && accept('/');
        if (!multiplies && !divides && !accept('%'))
            return value;
        const double factor = signed_power();
        if (!live_)
            continue;
        if (!multiplies && factor == 0.0)
            fail(divides ? "division by zero; change the divisor"
                         : "remainder of a division by zero; change the divisor");
        value = multiplies ? finite(value * factor, "*", "smaller numbers")
                : divides  ? finite(value / factor, "/", "a larger divisor")
                           : finite(value - factor * std::floor(value / factor), "%", "a larger divisor");
    }
}

double Expression::signed_power() {
    if (++depth_ > deepest)
        fail(fmt::format("nested more than {} deep; write it flatter", deepest));
    double value = 0.0;
    if (accept('-')) {
        value = -signed_power();
    } else if (accept('+')) {
        value = signed_power();
    } else {
        value = primary();
        if (accept('^')) {
            const double exponent = signed_power();
            value = finite(std::pow(value, exponent), "^", "a whole exponent for a negative base, smaller numbers");
        }
    }
    --depth_;
    return value;
}

double Expression::primary() {
    skip_spaces();
    if (at_ == text_.size() || text_[at_] == '}')
        fail(at_ == text_.size() ? "it ends too early; expected a number, a key or a function, and a }"
                                 : "a number, a key or a function is missing before the }");
    if (accept('(')) {
        const double value = sum();
        if (!accept(')'))
            fail("a ) is missing");
        return value;
    }
    const char c = text_[at_];
    if ((c >= '0' && c <= '9') || c == '.')
        return number();
    if (begins_name(c)) {
        const std::string name = name_here();
        std::size_t behind = at_ + name.size();
        while (behind < text_.size() && std::isspace(static_cast<unsigned char>(text_[behind])))
            ++behind;
        if (behind < text_.size() && text_[behind] == '(') {
            at_ = behind + 1;
            return call(name);
        }
        if (name == "pi") {
            at_ += name.size();
            return pi;
        }
    }
    if (begins_name(c) || c == '$')
        return value_();
    fail(fmt::format("unexpected '{}'; expected a number, a key or a function", text_.substr(at_, 10)));
}

double Expression::number() {
    double value = 0.0;
    const auto [end, error] = read_number_at(text_.data() + at_, text_.data() + text_.size(), value);
    if (error != std::errc())
        fail(fmt::format("'{}' is no number that can be held", text_.substr(at_, 10)));
    at_ = static_cast<std::size_t>(end - text_.data());
    return value;
}

// Behind its (.
double Expression::call(const std::string& name) {
    const auto function =
        std::find_if(functions.begin(), functions.end(), [&](const Function& known) { return name == known.name; });
    if (function == functions.end()) {
        std::vector<std::string> names;
        for (const Function& known : functions)
            names.push_back(known.name);
        fail(fmt::format("there is no function '{}'{}", name, name_hint(name, names)));
    }
    Arguments arguments;
    do {
        arguments.push_back(sum());
    } while (arguments.size() < function->most && accept(','));
    if (arguments.size() < function->fewest || !accept(')'))
        fail(fmt::format("{}: {}; it takes {}", name,
                         arguments.size() < function->fewest ? "too few arguments" : "a ) is missing",
                         function->takes));
    if (!live_)
        return 1.0;
    return finite(function->compute(arguments), fmt::format("{}({})", name, fmt::join(arguments, ", ")),
                  function->takes);
}

std::string Expression::name_here() const {
    std::size_t end = at_;
    while (end < text_.size() && in_name(text_[end]))
        ++end;
    return text_.substr(at_, end - at_);
}

bool Expression::accept(char c) {
    skip_spaces();
    if (at_ == text_.size() || text_[at_] != c)
        return false;
    ++at_;
    return true;
}

void Expression::skip_spaces() {
    while (at_ < text_.size() && std::strchr(" \t\r\n", text_[at_]))
        ++at_;
}

double Expression::finite(double value, const std::string& what, const char* remedy) const {
    if (live_ && !std::isfinite(value))
        fail(fmt::format("{} gives no finite number; expected {}", what, remedy));
    return live_ ? value : 1.0;
}

void Expression::fail(const std::string& message) const {
    std::string shown = text_.substr(start_, text_.find('}', at_) - start_);
    if (shown.size() > 60)
        shown = shown.substr(0, 57) + "...";
    throw InputError(fmt::format("${{={}}}: {}", shown, message));
}

} // namespace vkvol
