// What holds for every rule of aggregation in the registry.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <string>

#include "kith/belief/aggregation.hpp"
#include "kith/belief/team_belief.hpp"
#include "kith/core/distributions.hpp"
#include "script.hpp"

namespace kith {
namespace {

using kith::testing::lower_hemisphere;
using kith::testing::random_list;

std::vector<RandomStream> streams(std::size_t n) {
  std::vector<RandomStream> result;
  for (std::size_t i = 0; i < n; ++i) result.push_back(RandomStream{5}.split("person").split(i));
  return result;
}

// Up to three half-spaces; members may contradict each other and themselves.
std::vector<HalfSpace> short_list(RandomStream random) {
  const auto n = uniform_index(4, random);
  return random_list(n, random, 3);
}

class EveryRule : public ::testing::TestWithParam<std::size_t> {
 protected:
  [[nodiscard]] static const AggregationRule& rule() { return aggregation_rules()[GetParam()]; }

  static TeamBelief team(const std::vector<RandomStream>& persons) {
    TeamBelief::Options options;
    options.filter.particles = 400;
    options.rules = {rule()};
    return {lower_hemisphere(), options, persons, RandomStream{7}};
  }

  // Three periods of demonstrations, responses and feedback; who sits in seat i is seats[i].
  static void teach(TeamBelief& team, const std::vector<std::size_t>& seats) {
    for (std::uint64_t period = 1; period <= 3; ++period) {
      const auto course = RandomStream{11}.split(period);
      std::vector<std::vector<HalfSpace>> lists;
      for (const auto person : seats) lists.push_back(short_list(course.split(person)));
      team.observe_demonstrations(short_list(course.split("shown")), period);
      (void)team.observe_responses(lists, period);
      team.observe_feedback(short_list(course.split("feedback")), period);
    }
  }
};

TEST_P(EveryRule, HasANameOfItsOwnAndADescription) {
  EXPECT_FALSE(rule().name.empty());
  EXPECT_FALSE(rule().description.empty());
  EXPECT_NE(rule().observe, nullptr);
  EXPECT_EQ(find_aggregation_rule(rule().name)->name, rule().name);
  EXPECT_EQ(std::count_if(aggregation_rules().begin(), aggregation_rules().end(),
                          [](const auto& other) { return other.name == rule().name; }),
            1);
}

TEST_P(EveryRule, GivesEqualBeliefsForEqualEvents) {
  auto a = team(streams(3));
  auto b = team(streams(3));
  teach(a, {0, 1, 2});
  teach(b, {0, 1, 2});
  EXPECT_EQ(a.aggregate(rule().name), b.aggregate(rule().name));
  EXPECT_NE(a.aggregate(rule().name), team(streams(3)).aggregate(rule().name)) << "nothing was learned";
}

TEST_P(EveryRule, DoesNotDependOnTheSeats) {
  auto straight = team(streams(3));
  teach(straight, {0, 1, 2});
  std::vector<std::size_t> seats{0, 1, 2};
  while (std::next_permutation(seats.begin(), seats.end())) {
    std::vector<RandomStream> seated;
    for (const auto person : seats) seated.push_back(streams(3)[person]);
    auto permuted = team(seated);
    teach(permuted, seats);
    EXPECT_EQ(permuted.aggregate(rule().name), straight.aggregate(rule().name));
  }
}

TEST_P(EveryRule, SeesOnlyThosePresent) {
  auto some = team(streams(3));
  some.set_present({true, false, true});
  auto pair = team({streams(3)[0], streams(3)[2]});
  const std::vector<HalfSpace> east{HalfSpace{{1, 0, 0}}};
  const std::vector<HalfSpace> west{HalfSpace{{-1, 0, 0}}};
  const std::vector<HalfSpace> north{HalfSpace{{0, 1, 0}}};
  const auto untouched = some.member(1);
  (void)some.observe_responses(std::array{east, west, north}, 1);
  (void)pair.observe_responses(std::array{east, north}, 1);
  EXPECT_EQ(some.aggregate(rule().name), pair.aggregate(rule().name));
  EXPECT_EQ(some.member(1), untouched);
  EXPECT_EQ(some.member(2), pair.member(1));
}

TEST_P(EveryRule, TakesASingleListAsTheMembersOwnBeliefDoes) {
  RandomStream random{3};
  const auto list = random_list(2, random, 3);
  const std::array lists{list};
  const std::array addresses{std::uint64_t{9}};
  const Cone prior = lower_hemisphere();
  const HalfSpaceLikelihood likelihood{0.8};
  ParticleBelief own{prior, {.particles = 400}};
  auto aggregate = own;
  const std::array<const ParticleBelief*, 1> members{&own};
  own.observe(list, likelihood, RandomStream{4});
  EXPECT_TRUE(
      rule()
          .observe(
              aggregate,
              {.lists = lists, .addresses = addresses, .members = members, .prior = prior, .likelihood = likelihood},
              RandomStream{4})
          .empty());
  for (std::size_t i = 0; i < own.size(); ++i) EXPECT_NEAR(aggregate.weights()[i], own.weights()[i], 1e-12);
}

TEST_P(EveryRule, KeepsTheWeightsNormalised) {
  auto one = team(streams(5));
  teach(one, {0, 1, 2, 3, 4});
  double sum = 0.0;
  for (const double weight : one.aggregate(rule().name).weights()) {
    EXPECT_GE(weight, 0.0);
    sum += weight;
  }
  EXPECT_NEAR(sum, 1.0, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Registry, EveryRule, ::testing::Range(std::size_t{0}, aggregation_rules().size()),
                         [](const auto& c) { return std::string{aggregation_rules()[c.param].name}; });

TEST(AggregationRules, FindNothingUnderAnotherName) { EXPECT_EQ(find_aggregation_rule("average"), nullptr); }

TEST(AggregationRules, MustDifferInName) {
  TeamBelief::Options options;
  options.rules = {*find_aggregation_rule("common"), *find_aggregation_rule("common")};
  EXPECT_THROW((TeamBelief{lower_hemisphere(), options, streams(2), RandomStream{1}}), std::invalid_argument);
}

TEST(AggregationRules, KeepRulesOfOnesOwn) {
  // The belief of whoever sits last by address: three lines, no line of the library.
  const AggregationRule last{"last", "what one member knows",
                             [](ParticleBelief& belief, const TeamResponses& responses, RandomStream random) {
                               const auto at = std::max_element(responses.addresses.begin(), responses.addresses.end());
                               const auto i = static_cast<std::size_t>(at - responses.addresses.begin());
                               belief.observe(responses.lists[i], responses.likelihood, random);
                               return std::vector<std::size_t>{};
                             }};
  TeamBelief::Options options;
  options.rules.push_back(last);
  TeamBelief team{lower_hemisphere(), options, streams(2), RandomStream{1}};
  const auto before = team.aggregate("last");
  const std::vector<HalfSpace> east{HalfSpace{{1, 0, 0}}};
  (void)team.observe_responses(std::array{east, east}, 1);
  EXPECT_NE(team.aggregate("last"), before);
}

}  // namespace
}  // namespace kith
