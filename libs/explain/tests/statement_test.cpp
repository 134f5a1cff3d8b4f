#include "kith/explain/statement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <functional>

#include "atlases.hpp"
#include "kith/explain/curriculum.hpp"
#include "kith/explain/words.hpp"
#include "lake.hpp"

namespace kith {
namespace {

using testing::atlas_of;
using Constraints = std::vector<HalfSpace>;

// Domains whose counts are expectations.
std::vector<std::string> uncertain_domains() {
  const std::string source = KITH_SOURCE_DIR;
  return {source + "/domains/icy_crossing.toml", source + "/docs/examples/cliff.toml",
          testing::slippery_lake("steps", "{ step = -1 }", "1.0"),
          testing::slippery_lake("signs", "{ step = -1 }, { hole = -1 }, { goal = 1 }", "0.99")};
}

// Every number has at most two significant digits.
void expect_short_numbers(const std::string& text, std::int64_t largest) {
  for (std::size_t i = 0; i < text.size();) {
    if (std::isdigit(static_cast<unsigned char>(text[i])) == 0) {
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < text.size() && std::isdigit(static_cast<unsigned char>(text[end])) != 0) ++end;
    const auto digits = text.substr(i, end - i);
    EXPECT_LE(digits.find_last_not_of('0'), 1u) << text;
    EXPECT_LE(std::stoll(digits), largest) << text;
    EXPECT_TRUE(end == text.size() || text[end] != '.' || end + 1 == text.size()) << "a fraction: " << text;
    i = end;
  }
}

Constraints joined(Constraints a, const Constraints& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// What is said follows from the constraint, what is conveyed with it, the prior and its own condition, and does not
// follow without them. Returns whether something is said.
bool expect_true_and_short(const Domain& domain, const HalfSpace& constraint, const Constraints& together) {
  SCOPED_TRACE(described(domain, constraint));
  const auto statement = short_statement(domain, constraint, together);
  const auto text = in_words(domain, constraint, together);
  EXPECT_EQ(statement.has_value(), !text.empty());
  if (!statement) return false;
  expect_short_numbers(text, 1000);
  auto before = Constraints{domain.prior().begin(), domain.prior().end()};
  if (statement->condition) before.push_back(*statement->condition);
  const auto known = Cone::intersection(joined(joined(before, {constraint}), together));
  EXPECT_TRUE(known.has_value());
  if (known) {
    EXPECT_TRUE(known->implies(statement->said)) << text;
  }
  if (statement->said != constraint && !before.empty()) {
    const auto untaught = Cone::intersection(before);
    EXPECT_TRUE(untaught.has_value());
    if (untaught) {
      EXPECT_FALSE(untaught->implies(statement->said)) << text;
    }
  }
  EXPECT_GE(sign_of_dot(statement->said.normal(), domain.weights().integer), 0);
  return true;
}

Constraints as_vector(std::span<const HalfSpace> all) { return {all.begin(), all.end()}; }

// Whether something speaks against what the robot does.
bool is_trade(const Domain& domain, const HalfSpace& constraint) {
  for (std::size_t k = 0; k < domain.num_features(); ++k) {
    const auto entry = constraint.normal()[k];
    if (entry != 0 && (entry < 0) != (domain.weights().integer[k] < 0)) return true;
  }
  return false;
}

TEST(ShortStatement, FollowsFromItsConstraintInEveryDomainWithChance) {
  for (const auto& name : uncertain_domains()) {
    SCOPED_TRACE(name);
    const auto& atlas = atlas_of(name);
    ASSERT_FALSE(atlas.domain().is_exact());
    std::size_t said = 0, trades = 0;
    for (ConstraintIndex c{0}; c.value() < atlas.constraints().size(); ++c) {
      const bool is_said = expect_true_and_short(atlas.domain(), atlas.constraints()[c], {});
      if (!is_trade(atlas.domain(), atlas.constraints()[c])) continue;
      ++trades;
      if (is_said) ++said;
    }
    EXPECT_GT(2 * said, trades);  // most can be said
    const auto policy = as_vector(atlas.policy_bec_half_spaces());
    for (const auto& constraint : policy) expect_true_and_short(atlas.domain(), constraint, policy);
  }
}

// What a lesson says: sentences, reasons and runs.
TEST(ShortStatement, KeepsLessonsTrueAndShort) {
  for (const auto& name : uncertain_domains()) {
    SCOPED_TRACE(name);
    const auto& atlas = atlas_of(name);
    const auto& domain = atlas.domain();
    for (const auto& component : make_curriculum(atlas).components) {
      for (const auto& constraint : component.constraints)
        expect_true_and_short(domain, constraint, component.constraints);
      for (const auto& shown : component.demonstrations) {
        for (const auto& one : shown.conveys) expect_true_and_short(domain, one, shown.conveys);
        expect_short_numbers(shown.reason, 100'000);
        const auto said = told(domain, shown.main, shown.conveys);
        EXPECT_TRUE(shown.reason.ends_with(said)) << shown.reason;
      }
      for (const auto& test : component.tests) {
        for (const auto& one : test.covers) expect_true_and_short(domain, one, test.covers);
      }
    }
  }
}

// It became "191 steps cost more than crossing mud", which (-3, 10, -0.01) refutes although the constraint admits it.
TEST(ShortStatement, LeavesOutNoTermThatMatters) {
  const auto& domain = atlas_of(testing::slippery_lake("steps", "{ step = -1 }", "1.0")).domain();
  const HalfSpace constraint{{5483, 5109, -1048549}};
  expect_true_and_short(domain, constraint, {});
  const auto statement = short_statement(domain, constraint);
  if (statement) {
    EXPECT_NE(statement->said.normal()[1], 0) << in_words(domain, constraint);
  }
}

// One number may be large.
void expect_light(const IntegerVector& counts) {
  std::vector<std::int64_t> sizes;
  for (const auto entry : counts) {
    if (entry != 0) sizes.push_back(std::abs(entry));
  }
  std::sort(sizes.begin(), sizes.end(), std::greater<>{});
  if (sizes.size() == 2) {
    EXPECT_LE(sizes[1], 10);
  }
  if (sizes.size() > 2) {
    EXPECT_LE(sizes[1], 3);
    EXPECT_EQ(sizes[2], 1);
  }
  for (const auto size : sizes) {
    EXPECT_EQ(size % (size <= 20 ? 1 : size <= 100 ? 5 : 10), 0) << size;
    EXPECT_LE(size, 1000);
  }
}

// It became "150 steps cost less than falling into the water 11 times plus what coming home 3 times is worth".
TEST(ShortStatement, HasNumbersThatPeopleCanKeepInMind) {
  for (const auto& name : uncertain_domains()) {
    const auto& atlas = atlas_of(name);
    for (ConstraintIndex c{0}; c.value() < atlas.constraints().size(); ++c) {
      const auto statement = short_statement(atlas.domain(), atlas.constraints()[c]);
      if (!statement) continue;
      SCOPED_TRACE(in_words(atlas.domain(), atlas.constraints()[c]));
      expect_light(statement->said.normal());
    }
  }
}

// Whether one statement follows from another and the prior.
bool follows(const Domain& domain, const ShortStatement& one, const ShortStatement& other) {
  if (other.condition && other.condition != one.condition) return false;
  auto known = Constraints{domain.prior().begin(), domain.prior().end()};
  if (one.condition) known.push_back(*one.condition);
  known.push_back(other.said);
  const auto region = Cone::intersection(known);
  return region && region->implies(one.said);
}

// With a condition, beside nearly the same without one: "if coming home is worth something, 16 steps cost more than
// falling into the water" beside "19 steps cost more than falling into the water".
bool adds_little(const ShortStatement& one, const ShortStatement& other) {
  if (!one.condition || other.condition) return false;
  std::vector<double> ratios;
  for (std::size_t k = 0; k < one.said.normal().size(); ++k) {
    const auto a = one.said.normal()[k], b = other.said.normal()[k];
    if (a == 0 && b == 0) continue;
    if (a == 0 || b == 0 || (a < 0) != (b < 0)) return false;
    ratios.push_back(static_cast<double>(a) / static_cast<double>(b));
  }
  return *std::max_element(ratios.begin(), ratios.end()) <= 1.25 * *std::min_element(ratios.begin(), ratios.end());
}

TEST(ShortStatements, LeaveOutWhatAnotherSaysAndNothingElse) {
  std::size_t left_out = 0;
  for (const auto& name : uncertain_domains()) {
    SCOPED_TRACE(name);
    const auto& domain = atlas_of(name).domain();
    const auto policy = as_vector(atlas_of(name).policy_bec_half_spaces());
    const auto all = short_statements(domain, policy);
    ASSERT_EQ(all.size(), policy.size());
    for (std::size_t i = 0; i < policy.size(); ++i) {
      const auto own = short_statement(domain, policy[i], policy);
      const auto implies_own = [&](std::size_t j) {
        return j != i && all[j] && own && (follows(domain, *own, *all[j]) || adds_little(*own, *all[j]));
      };
      bool is_implied = false;
      for (std::size_t j = 0; j < policy.size(); ++j) is_implied = is_implied || implies_own(j);
      EXPECT_EQ(all[i].has_value(), own.has_value() && !is_implied) << in_words(domain, policy[i], policy);
      left_out += own && !all[i] ? 1U : 0U;
    }
  }
  EXPECT_GT(left_out, 0u);
}

TEST(ShortStatement, SaysShortConstraintsAsTheyAre) {
  const auto& domain = atlas_of("item-delivery").domain();
  const HalfSpace whole{{-1, 0, 137}};
  ASSERT_TRUE(short_statement(domain, whole).has_value());
  EXPECT_EQ(short_statement(domain, whole)->said, whole);
}

}  // namespace
}  // namespace kith
