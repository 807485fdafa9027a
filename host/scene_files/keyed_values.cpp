#include "keyed_values.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace vkvol {

namespace {

class Keys {
public:
    explicit Keys(const std::vector<double>& numbers) : numbers_(numbers) {}

    bool are_good() const {
        if (numbers_.size() < 3 || numbers_.size() % 2 == 0)
            return false;
        for (std::size_t i = 1; i < count(); ++i)
            if (!(place(i) > place(i - 1)))
                return false;
        return true;
    }
    double where() const { return numbers_.front(); }
    std::size_t count() const { return numbers_.size() / 2; }
    double place(std::size_t i) const { return numbers_[2 * i + 1]; }
    double value(std::size_t i) const { return numbers_[2 * i + 2]; }

    // The value where there is nothing to interpolate.
    std::optional<double> beyond() const {
        if (where() <= place(0))
            return value(0);
        if (where() >= place(count() - 1))
            return value(count() - 1);
        return std::nullopt;
    }
    // The key before `where`, which is within.
    std::size_t before() const {
        std::size_t i = 0;
        while (place(i + 1) <= where())
            ++i;
        return i;
    }
    double slope(std::size_t i) const {
        const std::size_t a = i == 0 ? 0 : i - 1, b = std::min(i + 1, count() - 1);
        return (value(b) - value(a)) / (place(b) - place(a));
    }

private:
    const std::vector<double>& numbers_;
};

// By `between(keys, i)` where it is between the keys i and i + 1.
template <class Between> double keyed(const std::vector<double>& numbers, const Between& between) {
    const Keys keys(numbers);
    if (!keys.are_good())
        return std::numeric_limits<double>::quiet_NaN();
    if (const std::optional<double> value = keys.beyond())
        return *value;
    return between(keys, keys.before());
}

} // namespace

double linear_keys(const std::vector<double>& numbers) {
    return keyed(numbers, [](const Keys& keys, std::size_t i) {
        const double t = (keys.where() - keys.place(i)) / (keys.place(i + 1) - keys.place(i));
        return (1.0 - t) * keys.value(i) + t * keys.value(i + 1);
    });
}

double spline_keys(const std::vector<double>& numbers) {
    return keyed(numbers, [](const Keys& keys, std::size_t i) {
        const double span = keys.place(i + 1) - keys.place(i), t = (keys.where() - keys.place(i)) / span, s = 1.0 - t;
        // Hermite's form.
        return s * s * ((1.0 + 2.0 * t) * keys.value(i) + t * span * keys.slope(i)) +
               t * t * ((1.0 + 2.0 * s) * keys.value(i + 1) - s * span * keys.slope(i + 1));
    });
}

} // namespace vkvol
