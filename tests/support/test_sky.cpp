#include "test_sky.h"

#include <cmath>

namespace vkvol {

RadianceMap make_map(int width, int height, const std::function<Rgb(int, int)>& radiance) {
    RadianceMap map{width, height, {}, 0};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            map.texels.emplace_back(radiance(x, y));
    return map;
}

RadianceMap sunset_map() {
    return make_map(16, 8, [](int x, int y) {
        const Rgb ground(0.1, 0.08, 0.06), sky(0.3, 0.5, 0.9), glow(9.0, 4.0, 1.0);
        return y >= 5 ? ground : y == 3 && x >= 4 && x <= 5 ? glow : sky + Rgb(0.02 * x, 0.0, 0.01 * y);
    });
}

RadianceMap square_map() {
    return make_map(12, 12, [](int x, int y) {
        const bool below = std::abs(x - 5.5) + std::abs(y - 5.5) > 6.0;
        const Rgb ground(0.1, 0.08, 0.06), sky(0.3, 0.5, 0.9), glow(9.0, 4.0, 1.0);
        const bool glows = (x == 3 && y == 0) || (x == 11 && y == 2);
        return glows ? glow : below ? ground : sky + Rgb(0.02 * x, 0.0, 0.05 * y);
    });
}

} // namespace vkvol
