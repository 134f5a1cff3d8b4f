#include "kith/core/parameter.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <stdexcept>

#include "kith/core/error.hpp"

namespace kith {
namespace {

constexpr std::array<std::string_view, 2> kPaces{"slow", "fast"};

std::span<const Parameter> declared() {
  static const std::array parameters{
      Parameter{
          .name = "ability.mean", .default_value = 0.7, .description = "mean of the ability", .min_is_open = true},
      Parameter{.name = "depth",
                .default_value = std::int64_t{2},
                .description = "periods to look ahead",
                .min = 1,
                .max = std::numeric_limits<double>::infinity()},
      Parameter{.name = "ordered", .default_value = true, .description = "whether gains are ordered"},
      Parameter{.name = "pace", .default_value = std::string{"slow"}, .description = "how fast", .words = kPaces},
      Parameter{.name = "gain", .default_value = Spread{.half_normal = 0.05, .value = {}}, .description = "a gain"}};
  return parameters;
}

std::string refusal(std::string_view name, ParameterValue value) {
  ParameterValues values{declared()};
  try {
    values.set(name, std::move(value));
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInvalidInput);
    EXPECT_EQ(values, ParameterValues{declared()}) << "a refused value changed something";
    return error.what();
  }
  return "accepted";
}

TEST(ParameterValues, StartWithTheDefaults) {
  const ParameterValues values{declared()};
  EXPECT_EQ(values.real("ability.mean"), 0.7);
  EXPECT_EQ(values.count("depth"), 2);
  EXPECT_TRUE(values.boolean("ordered"));
  EXPECT_EQ(values.word("pace"), "slow");
  EXPECT_EQ(values.spread("gain").half_normal, 0.05);
  EXPECT_EQ(values.declared().size(), values.values().size());
}

TEST(ParameterValues, TakeWhatIsInRange) {
  ParameterValues values{declared()};
  values.set("ability.mean", std::int64_t{1});  // a whole number is a number
  values.set("depth", std::int64_t{40});
  values.set("pace", std::string{"fast"});
  values.set("gain", Spread{.half_normal = {}, .value = 1.0});
  EXPECT_EQ(values.real("ability.mean"), 1.0);
  EXPECT_EQ(values.count("depth"), 40);
  EXPECT_EQ(values.word("pace"), "fast");
  EXPECT_EQ(values.spread("gain").value, 1.0);
}

TEST(ParameterValues, RefuseWhatIsOutOfRangeWithNameAndRange) {
  EXPECT_EQ(refusal("ability.mean", 0.0), "parameter 'ability.mean' cannot be 0: it is a number in (0, 1]");
  EXPECT_EQ(refusal("ability.mean", std::numeric_limits<double>::quiet_NaN()),
            "parameter 'ability.mean' cannot be nan: it is a number in (0, 1]");
  EXPECT_EQ(refusal("depth", std::int64_t{0}), "parameter 'depth' cannot be 0: it is a whole number in [1, inf]");
  EXPECT_EQ(refusal("depth", 1.5), "parameter 'depth' cannot be 1.5: it is a whole number in [1, inf]");
  EXPECT_EQ(refusal("ordered", 1.0), "parameter 'ordered' cannot be 1: it is true or false");
  EXPECT_EQ(refusal("pace", std::string{"idle"}), "parameter 'pace' cannot be idle: it is one of slow, fast");
  EXPECT_EQ(refusal("gain", Spread{.half_normal = 0.1, .value = 0.1}),
            "parameter 'gain' cannot be { half_normal = 0.1, value = 0.1 }: it is { half_normal = ... } or { value = "
            "... } in [0, 1]");
  EXPECT_EQ(refusal("gain", Spread{.half_normal = {}, .value = 2.0}),
            "parameter 'gain' cannot be { value = 2 }: it is { half_normal = ... } or { value = ... } in [0, 1]");
}

TEST(ParameterValues, KnowTheirNames) {
  ParameterValues values{declared()};
  EXPECT_THROW(values.set("speed", 1.0), std::invalid_argument);
  EXPECT_THROW((void)values.real("depth"), std::invalid_argument);
  EXPECT_THROW((void)values.word("speed"), std::invalid_argument);
}

}  // namespace
}  // namespace kith
