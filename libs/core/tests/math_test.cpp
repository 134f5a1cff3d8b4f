#include "kith/core/math.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "kith/core/distributions.hpp"

namespace kith {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kPoints = 20000;

// Calls check(x) for numbers in [low, high) that are the same everywhere.
template <typename Check>
void for_points(double low, double high, Check check) {
  RandomStream random{7};
  for (int i = 0; i < kPoints; ++i) check(low + (high - low) * uniform01(random));
}

// Of the bits of the results.
template <typename Function>
std::uint64_t digest(double low, double high, Function f) {
  std::uint64_t sum = 0;
  for_points(low, high,
             [&](double x) { sum = std::rotl(sum, 5) * 0x9E3779B97F4A7C15u ^ std::bit_cast<std::uint64_t>(f(x)); });
  return sum;
}

// The largest error in units in the last place, beside one that has more digits.
template <typename Function, typename Exact>
double error(double low, double high, Function f, Exact exact) {
  double most = 0.0;
  for_points(low, high, [&](double x) {
    const long double right = exact(static_cast<long double>(x));
    const double away = std::abs(static_cast<double>(static_cast<long double>(f(x)) - right));
    const double size = std::abs(static_cast<double>(right));
    most = std::max(most, away / (std::nextafter(size, kInfinity) - size));
  });
  return most;
}

double on_circle(double angle) { return math::atan2(math::sin(angle), math::cos(angle)); }

// Wherever a function gives other bits, studies and lessons come out differently.
TEST(Math, GivesTheseBitsEverywhere) {
  EXPECT_EQ(digest(-40.0, 5.0, math::exp), 0xAEDC36887C2E6E6Cu);
  EXPECT_EQ(digest(-760.0, 760.0, math::exp), 0xB409747F4BB3A991u);
  EXPECT_EQ(digest(-1.0, 1.0, math::expm1), 0x680ACC39F908CCAEu);
  EXPECT_EQ(digest(0.0, 2.0, math::log), 0x23D155D5F1E92482u);
  EXPECT_EQ(digest(-0.9, 1.0, math::log1p), 0x1AB8BE4CA66872C1u);
  EXPECT_EQ(digest(0.0, 2.0, [](double x) { return math::pow(x, 1.7); }), 0x2FF8DB75F691D57Eu);
  EXPECT_EQ(digest(-8.0, 8.0, math::sin), 0x536B003B1764A6CBu);
  EXPECT_EQ(digest(-8.0, 8.0, math::cos), 0x370479021BE39719u);
  EXPECT_EQ(digest(-4.0, 4.0, on_circle), 0xD7477002681A78A1u);
  EXPECT_EQ(digest(-1.0, 1.0, math::asin), 0xEA1618380202332Fu);
}

TEST(Math, IsAsAccurateAsDocumented) {
  if (std::numeric_limits<long double>::digits < 64) GTEST_SKIP() << "nothing here has more digits to compare with";
  using Long = long double;
  const auto exp = [](Long x) { return std::exp(x); };
  EXPECT_LT(error(-1.0, 1.0, math::exp, exp), 0.7);
  EXPECT_LT(error(-700.0, 700.0, math::exp, exp), 0.7);
  EXPECT_LT(error(-745.0, -708.0, math::exp, exp), 1.001);
  EXPECT_LT(error(-1.0, 1.0, math::expm1, [](Long x) { return std::expm1(x); }), 3.0);
  const auto log = [](Long x) { return std::log(x); };
  EXPECT_LT(error(0.0, 2.0, math::log, log), 0.9);
  EXPECT_LT(error(1.0, 1e300, math::log, log), 0.9);
  EXPECT_LT(error(0.0, 1e-308, math::log, log), 0.9);
  EXPECT_LT(error(-0.9, 1.0, math::log1p, [](Long x) { return std::log1p(x); }), 3.0);
  const auto power = [](double x) { return math::pow(1e3, x); };
  EXPECT_LT(error(-1.0, 1.0, power, [](Long x) { return std::pow(1e3L, x); }), 1.0 + 3.0 * std::log(1e3));
  for (const double most : {1.0, 8.0, 1e5}) {
    EXPECT_LT(error(-most, most, math::sin, [](Long x) { return std::sin(x); }), 0.8);
    EXPECT_LT(error(-most, most, math::cos, [](Long x) { return std::cos(x); }), 0.8);
  }
  for (const double other : {-1.0, 1.0}) {
    const auto of_y = [&](double y) { return math::atan2(y, other); };
    EXPECT_LT(error(-2.0, 2.0, of_y, [&](Long y) { return std::atan2(y, Long{other}); }), 1.5);
    const auto of_x = [&](double x) { return math::atan2(other, x); };
    EXPECT_LT(error(-1e-3, 1e-3, of_x, [&](Long x) { return std::atan2(Long{other}, x); }), 1.5);
  }
  EXPECT_LT(error(-1.0, 1.0, math::asin, [](Long x) { return std::asin(x); }), 3.0);
}

TEST(Math, KnowsTheEnds) {
  EXPECT_EQ(math::exp(0.0), 1.0);
  EXPECT_EQ(math::exp(-kInfinity), 0.0);
  EXPECT_EQ(math::exp(kInfinity), kInfinity);
  EXPECT_EQ(math::expm1(0.0), 0.0);
  EXPECT_EQ(math::log(1.0), 0.0);
  EXPECT_EQ(math::log(0.0), -kInfinity);
  EXPECT_EQ(math::log(kInfinity), kInfinity);
  EXPECT_TRUE(std::isnan(math::log(-1.0)));
  EXPECT_TRUE(std::isnan(math::exp(std::nan(""))));
  EXPECT_TRUE(std::isnan(math::log(std::nan(""))));
  EXPECT_EQ(math::pow(0.0, 2.0), 0.0);
  EXPECT_EQ(math::sin(0.0), 0.0);
  EXPECT_EQ(math::cos(0.0), 1.0);
  EXPECT_EQ(math::sin(std::numbers::pi), 1.2246467991473532e-16);  // what pi lacks as a double
  EXPECT_EQ(math::atan2(0.0, 0.0), 0.0);
  EXPECT_EQ(math::atan2(1.0, 0.0), 0.5 * std::numbers::pi);
  EXPECT_EQ(math::atan2(0.0, -1.0), std::numbers::pi);
  EXPECT_EQ(math::atan2(-1.0, -1.0), -0.75 * std::numbers::pi);
  EXPECT_EQ(math::asin(1.0), 0.5 * std::numbers::pi);
}

}  // namespace
}  // namespace kith
