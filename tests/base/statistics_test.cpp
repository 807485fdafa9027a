// The statistical tests themselves, against tabulated values.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "support/images.h"
#include "support/statistics.h"

using namespace vkvol;

TEST_CASE("tail probabilities equal tabulated values", "[cpu][statistics]") {
    CHECK(normal_p(1.959963985) == Approx(0.05).epsilon(1e-8));
    CHECK(normal_p(-3.890591886) == Approx(1e-4).epsilon(1e-8));
    // Abramowitz & Stegun table 26.8: chi-square exceeded with probability p.
    CHECK(chi_square_p(3.841459, 1) == Approx(0.05).epsilon(1e-6));
    CHECK(chi_square_p(18.30704, 10) == Approx(0.05).epsilon(1e-6));
    CHECK(chi_square_p(29.5883, 10) == Approx(0.001).epsilon(1e-4));
    CHECK(chi_square_p(2.15586, 10) == Approx(0.995).epsilon(1e-5));
    CHECK(chi_square_p(124.342, 100) == Approx(0.05).epsilon(1e-4));
    CHECK(chi_square_p(2.0, 2) == Approx(std::exp(-1.0)).epsilon(1e-12));
    CHECK(sidak(0.01, 1) == Approx(0.01));
    CHECK(1.0 - std::pow(1.0 - sidak(0.01, 1000), 1000) == Approx(0.01));
}

TEST_CASE("Student's t equals tabulated values", "[cpu][statistics]") {
    // n values 0 and 2 alternately: mean 1, variance n / (n - 1), standard error 1 / sqrt(n - 1).
    const auto p = [](int n, double t) {
        RunningMean mean;
        for (int i = 0; i < n; ++i)
            mean.add(i % 2 == 0 ? 0.0 : 2.0);
        return t_test_p(mean, 1.0 + t / std::sqrt(n - 1.0));
    };
    // Abramowitz & Stegun table 26.10.
    CHECK(p(2, 12.70620) == Approx(0.05).epsilon(1e-5));
    CHECK(p(10, 2.262157) == Approx(0.05).epsilon(1e-5));
    CHECK(p(10, 4.780913) == Approx(0.001).epsilon(1e-5));
    CHECK(p(100000, 1.959963985) == Approx(0.05).epsilon(1e-3));
    RunningMean constant;
    constant.add(3.0);
    constant.add(3.0);
    CHECK(t_test_p(constant, 3.0) == 1.0);
    CHECK(t_test_p(constant, 3.0001) == 0.0);
    CHECK(t_test_p(constant, 3.0001, 0.001) == 1.0);
    constant.add(NAN);
    CHECK_FALSE(t_test_p(constant, 3.0) > 0.0);
}

TEST_CASE("Kolmogorov-Smirnov", "[cpu][statistics]") {
    // Points (i + 1/2) / n shifted by s have distance s + 1 / 2n. sqrt(n) D = 1.3581 has probability 0.05, 1.9495 has
    // 0.001, for n to infinity (Smirnov 1948).
    const auto p = [](double root_n_distance) {
        constexpr int n = 1000000;
        std::vector<double> u(n);
        for (int i = 0; i < n; ++i)
            u[i] = (i + 0.5) / n + root_n_distance / std::sqrt(n) - 0.5 / n;
        return kolmogorov_smirnov_p(u);
    };
    CHECK(p(1.3581) == Approx(0.05).epsilon(1e-3));
    CHECK(p(1.9495) == Approx(0.001).epsilon(5e-3));
    CHECK(p(0.001) == Approx(1.0));
}

TEST_CASE("p-values are uniform where nothing is wrong and small where something is", "[cpu][statistics]") {
    std::mt19937 engine(1);
    std::uniform_real_distribution<double> uniform;
    std::vector<double> ks, chi, t;
    for (int trial = 0; trial < 500; ++trial) {
        std::vector<double> sample(500);
        std::vector<double> bins(10, 0.0);
        RunningMean mean;
        for (double& x : sample) {
            x = uniform(engine);
            bins[static_cast<int>(10.0 * x)] += 1.0;
            mean.add(x);
        }
        ks.push_back(kolmogorov_smirnov_p(sample));
        chi.push_back(chi_square_test_p(bins, std::vector<double>(10, 50.0)));
        t.push_back(t_test_p(mean, 0.5));
    }
    // Significance 1e-3 each. The chi-square statistic takes discrete values, which 500 trials cannot tell.
    CHECK(kolmogorov_smirnov_p(ks) > 1e-3);
    CHECK(kolmogorov_smirnov_p(chi) > 1e-3);
    CHECK(kolmogorov_smirnov_p(t) > 1e-3);
    std::vector<double> bent(5000);
    for (double& x : bent)
        x = std::pow(uniform(engine), 1.1);
    CHECK(kolmogorov_smirnov_p(bent) < 1e-6);
}

TEST_CASE("what is no number is worse than all, for good", "[cpu][statistics]") {
    double worst = 0.5;
    for (const double x : {std::nan(""), 2.0, 0.1})
        worsen(worst, x);
    CHECK(std::isinf(worst));
}

TEST_CASE("pictures with pixels that are no numbers agree with none", "[cpu][statistics]") {
    Film film;
    film.picture_width = film.picture_height = 4;
    film.crop = {0, 4, 0, 4};
    film.mean.assign(16, glm::vec3(1.0f));
    film.variance.assign(16, glm::vec3(0.01f));
    film.samples.assign(16, 64);
    const std::vector<Rgb> means(16, Rgb(1.0));
    REQUIRE(agree(film, film, "alike").ok);
    REQUIRE(agree_with_means(film, means, "alike").ok);
    for (const float x : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()})
        for (const std::size_t pixel : {0u, 7u, 15u}) {
            Film other = film;
            other.mean[pixel].y = x;
            CHECK(!agree(film, other, "no number").ok);
            CHECK(!agree(other, other, "no numbers").ok);
            CHECK(!agree_with_means(other, means, "no number").ok);
        }
}
