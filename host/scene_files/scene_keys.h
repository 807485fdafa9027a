// $key, ${key}, ${key:-default} and ${= arithmetic} in the values of a scene.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace vkvol {

class SceneKeys {
public:
    // Nobody has to ask for what is in `may_be_unused`. `later`: frames, by which F is more in arithmetic of values
    // that are numbers, where it is a time; elsewhere it numbers files.
    explicit SceneKeys(std::map<std::string, std::string> values, std::set<std::string> may_be_unused = {},
                       double later = 0.0)
        : values_(std::move(values)), may_be_unused_(std::move(may_be_unused)), later_(later) {}

    // `raw` with all of it filled in. Throws InputError without a place.
    std::string fill_in(const std::string& raw);

    // Throws InputError, without a place, for a value that no key asks for.
    void check_all_used() const;

    // Whether F was computed with.
    bool moves() const { return moves_; }
    double later() const { return later_; }

private:
    std::string fill_in_at(double later, const std::string& raw);
    std::string text_up_to(char end, bool live); // '\0': the end of the text
    std::string reference(bool live);
    std::string braced(bool live);
    std::string key_here();
    std::string value_of(const std::string& key, bool live);
    std::optional<std::string> find(const std::string& key);
    double key_number(bool live);
    bool is_time_here();
    void count(const std::string& key, std::size_t bytes);

    const std::map<std::string, std::string> values_;
    const std::set<std::string> may_be_unused_;
    const double later_;
    double time_ = 0.0; // `later`, or 0
    bool moves_ = false;
    std::set<std::string> named_; // every key the scene names
    std::size_t filled_in_ = 0;   // bytes, of the values of all keys

    // What is being filled in, and how far that has come.
    std::string raw_;
    std::size_t at_ = 0;
    int depth_ = 0;
};

} // namespace vkvol
