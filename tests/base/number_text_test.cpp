#include <catch2/catch.hpp>
#include <cmath>

#include "number_text.h"

using namespace vkvol;

TEST_CASE("numbers are read as they are written anywhere", "[cpu][xml]") {
    const auto value_of = [](std::string_view text) {
        const NumberText read = read_number_text(text);
        return read.is_number && !read.is_too_large ? read.value : std::nan("");
    };
    CHECK(value_of("+0.5") == 0.5);
    CHECK(value_of("-3e2") == -300.0);
    CHECK(value_of(".25") == 0.25);
    for (const char* none : {"", "+", "-", "+-3", "++3", "1,5", " 1", "1 ", "0x10", "1e", "1e400", "-2e999"}) {
        CAPTURE(none);
        CHECK(std::isnan(value_of(none)));
    }
    // What is too small to be held is nothing, however it is written.
    const std::string zeros(400, '0'), nines(400, '9');
    for (const std::string& small : {std::string("1e-400"), std::string("-3.5E-999"), "0." + zeros + "1",
                                     "." + zeros + "1e5", std::string("1e-99999999999999999999")}) {
        CAPTURE(small);
        CHECK(value_of(small) == 0.0);
    }
    for (const std::string& large :
         {nines, nines + "e-5", nines + ".5", std::string("0.1e+400"), std::string("1e99999999999999999999")}) {
        CAPTURE(large);
        CHECK(read_number_text(large).is_too_large);
    }
    CHECK_FALSE(read_number_text("1e400x").is_number);
}

TEST_CASE("numbers amid other text are no less than 0 for being small", "[cpu][xml]") {
    double value = 1.0;
    const std::string text = "1e-400 2";
    const auto [end, error] = read_number_at(text.data(), text.data() + text.size(), value);
    CHECK(error == std::errc());
    CHECK(value == 0.0);
    CHECK(end == text.data() + 6);
    const std::string large = "1e400";
    CHECK(read_number_at(large.data(), large.data() + large.size(), value).ec == std::errc::result_out_of_range);
}
