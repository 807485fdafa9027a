// Arithmetic in scene values: "10 * sin(2 * pi * F / 8)".
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace vkvol {

// Numbers, + - * / % ^, parentheses, `pi`, functions (angles in radians), and values that the caller knows. ^ binds
// tightest and to the right, so that -2^2 is -4 and 2^3^2 is 512; a % b has the sign of b, as suits angles.
// Time is linear in the text, and nesting bounded.
class Expression {
public:
    // `value` is called where `at` is at a $ or a letter that begins no function: it moves `at` behind what it reads,
    // and returns what that stands for. `live` false: the text is checked, but nothing computed.
    Expression(const std::string& text, std::size_t& at, bool live, std::function<double()> value)
        : text_(text), at_(at), start_(at), live_(live), value_(std::move(value)) {}

    // Reads from `at` up to the } that ends it, and leaves `at` there. Throws InputError without a place: the
    // expression, what is wrong with it, and what would be right.
    double evaluate();

private:
    double sum();
    double product();
    double signed_power();
    double primary();
    double number();
    double call(const std::string& name);
    std::string name_here() const;
    bool accept(char c);
    void skip_spaces();
    double finite(double value, const std::string& what, const char* remedy) const;
    [[noreturn]] void fail(const std::string& message) const;

    const std::string& text_;
    std::size_t& at_;
    std::size_t start_;
    bool live_;
    int depth_ = 0;
    std::function<double()> value_;
};

} // namespace vkvol
