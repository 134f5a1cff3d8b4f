#include "kith/explain/statement.hpp"

#include <gtest/gtest.h>

#include <cctype>

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
      for (const auto& one : component.constraints) expect_true_and_short(domain, one, component.constraints);
      for (const auto& shown : component.demonstrations) {
        for (const auto& one : shown.conveys) expect_true_and_short(domain, one, shown.conveys);
        expect_short_numbers(shown.reason, 100'000);
        const auto said = in_words(domain, shown.main, shown.conveys);
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

TEST(ShortStatement, SaysShortConstraintsAsTheyAre) {
  const auto& domain = atlas_of("item-delivery").domain();
  const HalfSpace whole{{-1, 0, 137}};
  ASSERT_TRUE(short_statement(domain, whole).has_value());
  EXPECT_EQ(short_statement(domain, whole)->said, whole);
}

}  // namespace
}  // namespace kith
