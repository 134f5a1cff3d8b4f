#include "kith/analysis/nested_model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kith/analysis/anova.hpp"
#include "kith/analysis/marginal_means.hpp"

namespace kith {
namespace {

using Values = std::vector<double>;

// Eight people, each under three conditions; four of either kind.
struct Conditions {
  Factor a{"a", {"a1", "a2", "a3"}, {}}, b{"b", {"b1", "b2"}, {}}, person{"person", {}, {}};
  std::vector<std::vector<std::size_t>> terms{{0}, {1}, {0, 1}};

  Conditions() {
    for (std::size_t p = 0; p < 8; ++p) {
      person.levels.push_back(std::to_string(p));
      for (std::size_t c = 0; c < 3; ++c) {
        a.codes.push_back(c);
        b.codes.push_back(p / 4);
        person.codes.push_back(p);
      }
    }
  }
  [[nodiscard]] Estimable<NestedModel> fit(const Values& y) const {
    return fit_nested_model(y, std::vector{a, b}, terms, std::vector{person});
  }
};

const Values kAlike{3, 5, 4, 7, 8, 10, 4, 4, 7, 6, 9, 8, 2, 6, 5, 9, 9, 12, 5, 8, 8, 8, 11, 9};
const Values kUnlike{3, 8, 4, 7, 2, 6, 4, 6, 5, 6, 9, 1, 2, 6, 8, 5, 9, 2, 5, 8, 3, 8, 1, 9};

// R: lmerTest, anova(lmer(y ~ a*b + (1|person)), type = 2), ranova() and emmeans().
TEST(NestedModel, EqualsTheMixedModelOfABalancedDesign) {
  const auto model = Conditions{}.fit(kAlike).value();
  const Values f{10.09677, 0.73537, 0.41935}, df{12, 6, 12}, p{0.0026821, 0.4240722, 0.6667441};
  for (std::size_t t = 0; t < f.size(); ++t) {
    EXPECT_NEAR(model.tests.at(t).test->statistic, f[t], 1e-5) << t;
    EXPECT_NEAR(model.tests.at(t).test->df.at(1), df[t], 1e-9) << t;
    EXPECT_NEAR(model.tests.at(t).test->p, p[t], 1e-6) << t;
  }
  EXPECT_NEAR(model.groups.at(0).variance, 5.027778, 1e-5);
  EXPECT_NEAR(model.residual_variance, 1.291667, 1e-5);
  EXPECT_NEAR(model.groups.at(0).test->statistic, 13.339628, 1e-5);
  const auto means = marginal_means(model.fixed, 0).at(0);
  EXPECT_NEAR(means.means.at(1).estimate, 7.5, 1e-12);
  EXPECT_NEAR(means.means.at(1).inference->standard_error, 0.8887804, 1e-6);
  EXPECT_NEAR(means.means.at(1).inference->df, 7.94, 0.005);
  const auto pair = estimate_pairs(model.fixed, means).at(0);
  EXPECT_NEAR(pair.inference->standard_error, 0.5682576, 1e-6);
  EXPECT_NEAR(pair.inference->df, 12.0, 1e-9);
}

// The same: people are less alike than chance makes them, and the variance between them is 0.
TEST(NestedModel, PoolsStrataWhereGroupsAreNotAlike) {
  const auto model = Conditions{}.fit(kUnlike).value();
  EXPECT_EQ(model.groups.at(0).variance, 0.0);
  EXPECT_EQ(model.groups.at(0).intraclass_interval->low, 0.0);
  EXPECT_NEAR(model.residual_variance, 8.097222, 1e-6);
  EXPECT_NEAR(model.tests.at(0).test->statistic, 0.53002, 1e-5);
  EXPECT_NEAR(model.tests.at(1).test->statistic, 0.12864, 1e-5);
  EXPECT_NEAR(model.tests.at(1).test->df.at(1), 18.0, 1e-9);
}

TEST(NestedModel, TestsWithinGroupsAsTheAnalysisWithinBlocks) {
  const Conditions design;
  const auto model = design.fit(kAlike).value();
  const auto blocked = blocked_anova(kAlike, design.a, design.b, design.person).value();
  EXPECT_NEAR(model.tests.at(0).test->p, blocked.terms.at(0).test->p, 1e-12);
  EXPECT_NEAR(model.tests.at(2).test->p, blocked.terms.at(1).test->p, 1e-12);
}

// Settings within people: two levels of groups, each with its stratum.
TEST(NestedModel, TestsEveryTermInItsStratum) {
  Factor setting{"setting", {"s1", "s2"}, {}}, a{"a", {"a1", "a2"}, {}}, person{"people", {}, {}},
      within{"people within settings", {}, {}};
  Values y;
  for (std::size_t p = 0; p < 6; ++p) {
    person.levels.push_back(std::to_string(p));
    for (std::size_t s = 0; s < 2; ++s) {
      within.levels.push_back(std::to_string(2 * p + s));
      for (std::size_t c = 0; c < 2; ++c) {
        setting.codes.push_back(s);
        a.codes.push_back(c);
        person.codes.push_back(p);
        within.codes.push_back(2 * p + s);
        y.push_back(static_cast<double>(5 * p + (p * p + 3 * s) % 4 + (7 * p + 5 * s + 3 * c) % 5));
      }
    }
  }
  const std::vector<std::vector<std::size_t>> terms{{0}, {1}};
  const auto model = fit_nested_model(y, std::vector{a, setting}, terms, std::vector{person, within}).value();
  EXPECT_NEAR(model.tests.at(0).test->df.at(1), 11.0, 7.0);
  EXPECT_GE(model.groups.at(0).variance, 0.0);
  EXPECT_GE(model.groups.at(1).variance, 0.0);
  EXPECT_NEAR(model.groups.at(1).design_effect, 1.0 + model.groups.at(1).intraclass_correlation, 1e-15);
  EXPECT_FALSE(fit_nested_model(y, std::vector{a, setting}, terms, std::vector{within, person}));
}

TEST(NestedModel, SaysWhyItCannotBeFitted) {
  const Conditions design;
  const auto reason = [&](Conditions of, Values y) {
    y.resize(of.a.codes.size());
    return of.fit(y).reason();
  };
  auto few = design;
  for (auto* const factor : {&few.a, &few.b, &few.person}) factor->codes.pop_back();
  EXPECT_THAT(reason(few, kAlike), ::testing::HasSubstr("unbalanced"));
  auto mixed = design;
  std::swap(mixed.a.codes[0], mixed.a.codes[4]);
  EXPECT_THAT(reason(mixed, kAlike), ::testing::HasSubstr("unbalanced"));
  auto alone = design;
  alone.b = alone.person;
  EXPECT_THAT(reason(alone, kAlike), ::testing::HasSubstr("already tell every person apart"));
  EXPECT_THAT(reason(design, Values(24, 1.0)), ::testing::HasSubstr("no spread"));
  EXPECT_THROW((void)fit_nested_model(kAlike, std::vector{design.a}, design.terms, {}), std::invalid_argument);
}

}  // namespace
}  // namespace kith
