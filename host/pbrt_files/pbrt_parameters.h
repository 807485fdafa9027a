// The parameters of a pbrt directive: "float radius" [ 2 ].
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "pbrt_tokens.h"

namespace vkvol {

struct PbrtParameter {
    std::string type, name;
    PbrtPlace place;
    std::vector<double> numbers;
    std::vector<std::string> texts; // of truth values "true" and "false"
    bool is_truth = false;
    std::string color_space = {}; // of its colours; empty: that of what it belongs to
};

// Shared by all that an Attribute gives them to.
using SharedParameter = std::shared_ptr<const PbrtParameter>;

// Getters throw InputError for values of a wrong type or number.
class PbrtParameters {
public:
    PbrtParameters() = default;
    // All up to the next directive; `color_space`: of their colours.
    explicit PbrtParameters(PbrtTokens& tokens, const std::string& color_space = "");

    // What is not among them: after all others.
    void add_defaults(const std::vector<SharedParameter>& defaults);
    const std::vector<SharedParameter>& all() const { return parameters_; }

    const PbrtParameter* find(const std::string& name) const; // null if there is none
    bool has(const std::string& name) const { return find(name) != nullptr; }

    double number(const std::string& name, double fallback) const;
    long long integer(const std::string& name, long long fallback) const;
    bool truth(const std::string& name, bool fallback) const;
    std::string text(const std::string& name, const std::string& fallback = "") const;
    std::string texture(const std::string& name) const; // the name of one; empty if it is none
    std::vector<double> numbers(const std::string& name) const;
    std::vector<glm::dvec3> points(const std::string& name) const;
    std::vector<glm::dvec2> pairs(const std::string& name) const;
    std::vector<std::size_t> indices(const std::string& name, std::size_t count) const; // all below `count`
    glm::dvec3 point(const std::string& name, const glm::dvec3& fallback) const;

    // Those that nobody has asked for.
    std::vector<const PbrtParameter*> unused() const;

private:
    const PbrtParameter* of_one(const std::string& name, const char* expected) const;

    std::vector<SharedParameter> parameters_;
    mutable std::vector<bool> used_;
};

} // namespace vkvol
