// $keys in scenes: defaults, arithmetic, and what is said where they are wrong.
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>

#include "error.h"
#include "scene_keys.h"
#include "support/scene_text.h"

using namespace vkvol;

namespace {

std::string filled(const std::string& text, const std::map<std::string, std::string>& values = {}) {
    return SceneKeys(values).fill_in(text);
}

std::string complaint(const std::string& text, const std::map<std::string, std::string>& values = {}) {
    try {
        return "filled in with " + filled(text, values);
    } catch (const InputError& error) {
        return error.what();
    }
}

double computed(const std::string& expression, const std::map<std::string, std::string>& values = {}) {
    return std::stod(filled(fmt::format("${{={}}}", expression), values));
}

} // namespace

TEST_CASE("a key may have a default", "[cpu][xml]") {
    CHECK(filled("${g:-0.8}") == "0.8");
    CHECK(filled("${g:-0.8}", {{"g", "0.3"}}) == "0.3");
    CHECK(filled("a${g:-}b") == "ab");
    CHECK(filled("${g:-0.8}", {{"g", ""}}) == "0.8"); // as in a shell
    CHECK(filled("${a:-${b:-${c:-3}}}") == "3");
    CHECK(filled("${a:-${b:-${c:-3}}}!", {{"b", "2"}}) == "2!");
    CHECK(filled("${a:-$b x}", {{"b", "1"}}) == "1 x");
    CHECK(filled("${a:-$$5}") == "$5");
    // Nothing of a default that is not used needs a value; but the scene names it.
    CHECK(filled("${a:-$b}", {{"a", "1"}}) == "1");
    CHECK(filled("${a:-${= 1/b}}", {{"a", "1"}, {"b", "0"}}) == "1");
    CHECK(parse(R"(<camera x="${a:-$b}"/>)", {{"a", "1"}, {"b", "2"}}).camera.position.x == 1.0);
    CHECK(parse(R"(<camera x="${a:-2}" y="${a:-3}"/>)").camera.position.y == 3.0);
    CHECK(complaint("${a:-1") == "${a:-1: the closing } is missing");
    CHECK_THAT(complaint("${:-1}"), Catch::Contains("names no key"));
    CHECK_THAT(error_of("<sigma_s>${s:-1}</sigma_s>", {{"t", "2"}}), Catch::Contains("-D t=2 is used nowhere"));
}

TEST_CASE("scene values are computed", "[cpu][xml]") {
    CHECK(computed("1 + 2*3") == 7.0);
    CHECK(computed("(1 + 2) * 3") == 9.0);
    CHECK(computed("7 - 2 - 1") == 4.0);
    CHECK(computed("8/2/2") == 2.0);
    CHECK(computed("-2^2") == -4.0);
    CHECK(computed("2^3^2") == 512.0);
    CHECK(computed("2^-1") == 0.5);
    CHECK(computed("--1 - +1") == 0.0);
    CHECK(computed("370 % 360") == 10.0);
    CHECK(computed("-10 % 360") == 350.0);
    CHECK(computed(".5e1") == 5.0);
    CHECK(computed("10*sin(2*pi*F/8)", {{"F", "2"}}) == 10.0);
    CHECK(computed("cos(pi)") == -1.0);
    CHECK(computed("4*atan(1)") == Approx(3.141592653589793).epsilon(1e-15));
    CHECK(computed("tan(asin(0.6)) * acos(1) + atan2(0, 1)") == 0.0);
    CHECK(computed("sqrt(2)^2") == Approx(2.0).epsilon(1e-15));
    CHECK(computed("log(exp(3)) + pow(2, 10)") == Approx(1027.0).epsilon(1e-15));
    CHECK(computed("abs(-1) + floor(-0.5) + ceil(0.5) + round(2.5)") == 4.0);
    CHECK(computed("min(3, 1, 2) + max(3, 5, 4, 1)") == 6.0);
    CHECK(computed("linear(F, 1,10, 3,20, 7,0)", {{"F", "2"}}) == 15.0);
    CHECK(computed("linear(6, 1,10, 3,20, 7,0) + linear(0, 1,10, 3,20) + linear(9, 1,10, 3,20)") == 35.0);
    CHECK(computed("linear(5, 5,2)") == 2.0);
    // Keys are met, lines and parabolas kept where their keys are as far apart: here t^2 at 2.5 and 3.25, between four.
    CHECK(computed("spline(3, 1,10, 3,20, 7,0)") == 20.0);
    CHECK(computed("spline(2.75, 1,1, 2,2, 4,4, 9,9)") == Approx(2.75).epsilon(1e-14));
    CHECK(computed("spline(2.5, 1,1, 2,4, 3,9, 4,16)") == Approx(6.25).epsilon(1e-14));
    CHECK(computed("spline(2.25, 1,1, 2,4, 3,9, 4,16)") == Approx(5.0625).epsilon(1e-14));
    CHECK(computed("spline(0, 1,10, 3,20) + spline(9, 1,10, 3,20)") == 30.0);
    CHECK(computed("spline(1.5, 1,10, 2,20)") == 15.0);
    CHECK(computed("360*${F:-1}/8") == 45.0);
    CHECK(computed("$a - ${b}", {{"a", "-1"}, {"b", "+2"}}) == -3.0);
    CHECK(computed("a^2", {{"a", "-3"}}) == 9.0); // a value is a number, not a piece of text
    // Whole numbers are written as such, others so that nothing is lost.
    CHECK(filled("${= 200*500}") == "100000");
    CHECK(filled("${= -0.5*0}") == "0");
    CHECK(filled("${= 2*1e-400}") == "0"); // as outside of arithmetic
    CHECK(std::stod(filled("${= 1/3}")) == 1.0 / 3.0);
    CHECK(filled("${=1}$$${=2}") == "1$2");
    CHECK(parse("<width>${= 2*w}</width>", {{"w", "160"}}).picture.width == 320);
}

TEST_CASE("arithmetic that cannot be done is an error with its place, the expression and a remedy", "[cpu][xml]") {
    CHECK(error_of(R"(<camera x="${= 1/(F-1)}"/>)", {{"F", "1"}}) ==
          "s.xml:2:9: ${= 1/(F-1)}: division by zero; change the divisor");
    CHECK(error_of("<sigma_s>\n ${= 2*density}</sigma_s>") ==
          "s.xml:3:2: $density has no value; give it with -D density=VALUE, or here with a default: "
          "${density:-VALUE}");
    const std::pair<const char*, const char*> wrong[] = {
        {"1 % 0", "division by zero"},
        {"min(1, 1/0)", "division by zero"},
        {"sqrt(-1)", "sqrt(-1) gives no finite number; expected a number >= 0"},
        {"log(0)", "log(0) gives no finite number; expected a number > 0"},
        {"asin(2)", "from -1 to 1"},
        {"(-8)^(1/3)", "^ gives no finite number"},
        {"10^309", "^ gives no finite number"},
        {"1e308*10", "* gives no finite number"},
        {"1e309", "no number that can be held"},
        {"sinn(1)", "there is no function 'sinn'; did you mean sin?"},
        {"sin(1, 2)", "a ) is missing"},
        {"atan2(1)", "too few arguments"},
        {"linear(1, 2)", "too few arguments; it takes where, and then"},
        {"linear(1, 2,3, 2,4)", "gives no finite number; expected where, and then 1 to 256 keys"},
        {"spline(1, 2,3, 4)", "gives no finite number"},
        {"spline(1, 3,3, 2,4)", "places ascending"},
        {"(1", "a ) is missing"},
        {"1 +", "missing before the }"},
        {"", "missing before the }"},
        {"1 2", "unexpected '2}'"},
        {"2 & 3", "unexpected '& 3"},
        {"*2", "unexpected '*2"},
        {"word", "word is 'text', no number"},
        {"${word}*2", "${word} is 'text', no number"},
        {"F", "$F has no value: it is the number of a frame; give it with -f 1..8 or -D F=1"}};
    for (const auto& [expression, message] : wrong)
        CHECK_THAT(complaint(fmt::format("${{={}}}", expression), {{"word", "text"}}), Catch::Contains(message));
    CHECK_THAT(complaint("${= 1+1"), Catch::Contains("the closing } is missing"));
    CHECK_THAT(complaint("${= 1+"), Catch::Contains("it ends too early"));
}

TEST_CASE("nesting is bounded, and long arithmetic takes no time", "[cpu][xml]") {
    const auto repeated = [](const std::string& text, int times) {
        std::string all;
        for (int i = 0; i < times; ++i)
            all += text;
        return all;
    };
    for (const char* opening : {"(", "-", "2^", "sin("})
        CHECK_THAT(complaint(std::string("${= ").append(repeated(opening, 1000000))), Catch::Contains("deep"));
    CHECK_THAT(complaint(repeated("${a:-", 1000000)), Catch::Contains("deep"));
    CHECK_THAT(complaint(repeated("${= ", 1000000)), Catch::Contains("deep"));
    CHECK(computed(repeated("1 + ", 999999).append("1")) == 1e6);
    CHECK(filled(repeated("${= 1}", 300000)) == repeated("1", 300000));
}

TEST_CASE("$F4 is the frame's number with four digits", "[cpu][xml]") {
    CHECK(filled("smoke.$F4.vdb", {{"F", "7"}}) == "smoke.0007.vdb");
    CHECK(filled("$F2 $F", {{"F", "123"}}) == "123 123");
    CHECK(filled("${F4:-none}") == "none");
    CHECK(filled("$F4", {{"F4", "other"}}) == "other");
    CHECK_THAT(complaint("$F4"), Catch::Contains("-f 1..8"));
    CHECK_THAT(complaint("$F4", {{"F", "1.5"}}), Catch::Contains("-f 1..8"));
    // F counts as used.
    CHECK(parse("<densityField>a.$F3.vdb</densityField>", {{"F", "5"}}).volumes.size() == 1);
}

TEST_CASE("F is a time as the default of another key, too", "[cpu][xml]") {
    const auto at_later = [](const std::string& text, Defines values) {
        SceneKeys keys(std::move(values), {}, 0.25);
        const std::string filled = keys.fill_in(text);
        return std::pair(filled, keys.moves());
    };
    for (const char* text : {"${= 4*F}", "${= 4*${t:-$F}}", "${= 4*${t:-${F}}}", "${= 4*${t:-${u:-$F}}}"})
        CHECK(at_later(text, {{"F", "3"}}) == std::pair(std::string("13"), true));
    CHECK(at_later("${= 4*${t:-$F}}", {{"F", "3"}, {"t", "5"}}) == std::pair(std::string("20"), false));
    CHECK(at_later("${= 4*${t:-$Q}}", {{"F", "3"}, {"Q", "5"}}) == std::pair(std::string("20"), false));
    CHECK(at_later("${t:-$F}", {{"F", "3"}}) == std::pair(std::string("3"), false)); // a number of files
}
