#include "pbrt_parameters.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace vkvol {

namespace {

constexpr char spaces[] = " \t";

void add_value(PbrtParameter& parameter, const PbrtToken& token) {
    const bool is_truth = token.is(PbrtToken::Kind::word) && (token.value == "true" || token.value == "false");
    const auto mixed = [&] {
        fail_at(token.place, fmt::format("'{}' among the values of \"{} {}\", which are of another kind", token.value,
                                         parameter.type, parameter.name));
    };
    if (token.is(PbrtToken::Kind::quoted) || is_truth) {
        if (!parameter.numbers.empty() || (!parameter.texts.empty() && parameter.is_truth != is_truth))
            mixed();
        parameter.is_truth = is_truth;
        parameter.texts.push_back(token.value);
        return;
    }
    const std::optional<double> value = token.is(PbrtToken::Kind::word) ? pbrt_number(token.value) : std::nullopt;
    if (!value)
        fail_at(token.place,
                fmt::format("'{}': expected a value of \"{} {}\"", token.value, parameter.type, parameter.name));
    if (!parameter.texts.empty())
        mixed();
    parameter.numbers.push_back(*value);
}

PbrtParameter read_parameter(PbrtTokens& tokens, const PbrtToken& declaration) {
    PbrtParameter parameter;
    parameter.place = declaration.place;
    const std::string& text = declaration.value;
    const std::size_t type = text.find_first_not_of(spaces);
    const std::size_t gap = type == text.npos ? text.npos : text.find_first_of(spaces, type);
    const std::size_t name = gap == text.npos ? text.npos : text.find_first_not_of(spaces, gap);
    if (name == text.npos)
        fail_at(declaration.place,
                fmt::format("\"{}\": expected a parameter with its type, such as \"float radius\"", text));
    parameter.type = text.substr(type, gap - type);
    parameter.name = text.substr(name, text.find_first_of(spaces, name) - name);
    PbrtToken token = tokens.next();
    if (token.is(PbrtToken::Kind::end))
        fail_at(declaration.place, fmt::format("\"{}\" lacks its value; is the file whole?", text));
    if (!token.is(PbrtToken::Kind::open)) {
        add_value(parameter, token);
        return parameter;
    }
    for (token = tokens.next(); !token.is(PbrtToken::Kind::close); token = tokens.next()) {
        if (token.is(PbrtToken::Kind::end))
            fail_at(declaration.place, fmt::format("the values of \"{}\" lack their ]", text));
        add_value(parameter, token);
    }
    return parameter;
}

[[noreturn]] void fail(const PbrtParameter& parameter, const std::string& expected) {
    fail_at(parameter.place, fmt::format("\"{} {}\": expected {}", parameter.type, parameter.name, expected));
}

const std::vector<double>& numbers_of(const PbrtParameter& parameter, std::size_t each, const char* expected) {
    if (parameter.numbers.empty() || parameter.numbers.size() % each != 0)
        fail(parameter, expected);
    return parameter.numbers;
}

} // namespace

PbrtParameters::PbrtParameters(PbrtTokens& tokens, const std::string& color_space) {
    for (PbrtToken token = tokens.next();; token = tokens.next()) {
        if (!token.is(PbrtToken::Kind::quoted)) {
            tokens.put_back(std::move(token));
            break;
        }
        PbrtParameter parameter = read_parameter(tokens, token);
        parameter.color_space = color_space;
        parameters_.push_back(std::make_shared<const PbrtParameter>(std::move(parameter)));
    }
    std::reverse(parameters_.begin(), parameters_.end()); // of two of one name the last one counts
    used_.resize(parameters_.size());
}

void PbrtParameters::add_defaults(const std::vector<SharedParameter>& defaults) {
    for (const SharedParameter& parameter : defaults) {
        const auto is_same = [&](const SharedParameter& other) { return other->name == parameter->name; };
        if (std::any_of(parameters_.begin(), parameters_.end(), is_same))
            continue;
        parameters_.push_back(parameter);
        // It may be for others; but not these, which change what they are given to.
        used_.push_back(parameter->name != "invert" && parameter->name != "normalmap" &&
                        parameter->name != "displacement");
    }
}

const PbrtParameter* PbrtParameters::find(const std::string& name) const {
    const PbrtParameter* found = nullptr;
    for (std::size_t i = 0; i < parameters_.size(); ++i)
        if (parameters_[i]->name == name) {
            used_[i] = true; // also what is overridden
            found = found ? found : parameters_[i].get();
        }
    return found;
}

const PbrtParameter* PbrtParameters::of_one(const std::string& name, const char* expected) const {
    const PbrtParameter* parameter = find(name);
    if (parameter && parameter->numbers.size() + parameter->texts.size() != 1)
        fail(*parameter, expected);
    return parameter;
}

double PbrtParameters::number(const std::string& name, double fallback) const {
    const PbrtParameter* parameter = of_one(name, "one number");
    if (!parameter)
        return fallback;
    return numbers_of(*parameter, 1, "one number").front();
}

long long PbrtParameters::integer(const std::string& name, long long fallback) const {
    const PbrtParameter* parameter = find(name);
    const double value = number(name, double(fallback));
    if (parameter && (value != std::floor(value) || std::abs(value) > std::numeric_limits<std::int32_t>::max()))
        fail(*parameter, "one whole number of 32 bits");
    return static_cast<long long>(value);
}

bool PbrtParameters::truth(const std::string& name, bool fallback) const {
    const PbrtParameter* parameter = of_one(name, "true or false");
    if (!parameter)
        return fallback;
    if (parameter->texts.empty() || (parameter->texts[0] != "true" && parameter->texts[0] != "false"))
        fail(*parameter, "true or false");
    return parameter->texts[0] == "true";
}

std::string PbrtParameters::text(const std::string& name, const std::string& fallback) const {
    const PbrtParameter* parameter = of_one(name, "one text in quotes");
    if (!parameter)
        return fallback;
    if (parameter->texts.empty() || parameter->is_truth)
        fail(*parameter, "one text in quotes");
    return parameter->texts[0];
}

std::string PbrtParameters::texture(const std::string& name) const {
    const PbrtParameter* parameter = find(name);
    return parameter && parameter->type == "texture" ? text(name) : "";
}

std::vector<double> PbrtParameters::numbers(const std::string& name) const {
    const PbrtParameter* parameter = find(name);
    return parameter ? numbers_of(*parameter, 1, "numbers") : std::vector<double>();
}

std::vector<glm::dvec3> PbrtParameters::points(const std::string& name) const {
    std::vector<glm::dvec3> points;
    if (const PbrtParameter* parameter = find(name)) {
        const std::vector<double>& n = numbers_of(*parameter, 3, "numbers, three for each point");
        for (std::size_t i = 0; i < n.size(); i += 3)
            points.emplace_back(n[i], n[i + 1], n[i + 2]);
    }
    return points;
}

std::vector<glm::dvec2> PbrtParameters::pairs(const std::string& name) const {
    std::vector<glm::dvec2> pairs;
    if (const PbrtParameter* parameter = find(name)) {
        const std::vector<double>& n = numbers_of(*parameter, 2, "numbers, two for each");
        for (std::size_t i = 0; i < n.size(); i += 2)
            pairs.emplace_back(n[i], n[i + 1]);
    }
    return pairs;
}

std::vector<std::size_t> PbrtParameters::indices(const std::string& name, std::size_t count) const {
    std::vector<std::size_t> indices;
    if (const PbrtParameter* parameter = find(name))
        for (const double value : numbers_of(*parameter, 1, "whole numbers")) {
            if (value != std::floor(value) || value < 0.0 || value >= double(count))
                fail(*parameter, fmt::format("whole numbers from 0 to {}, the last point; {:g} is none",
                                             static_cast<long long>(count) - 1, value));
            indices.push_back(static_cast<std::size_t>(value));
        }
    return indices;
}

glm::dvec3 PbrtParameters::point(const std::string& name, const glm::dvec3& fallback) const {
    const std::vector<glm::dvec3> all = points(name);
    if (all.size() > 1)
        fail(*find(name), "one point, of three numbers");
    return all.empty() ? fallback : all.front();
}

std::vector<const PbrtParameter*> PbrtParameters::unused() const {
    std::vector<const PbrtParameter*> result;
    for (std::size_t i = 0; i < parameters_.size(); ++i)
        if (!used_[i])
            result.push_back(parameters_[i].get());
    return result;
}

} // namespace vkvol
