#include "kith/belief/team_belief.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kith/belief/consistency.hpp"
#include "kith/core/error.hpp"
#include "script.hpp"

namespace kith {
namespace {

using kith::testing::lower_hemisphere;
using kith::testing::random_list;
using Lists = std::vector<std::vector<HalfSpace>>;

std::vector<RandomStream> persons(std::size_t n, std::uint64_t seed = 1) {
  std::vector<RandomStream> streams;
  for (std::size_t i = 0; i < n; ++i) streams.push_back(RandomStream{seed}.split("person").split(i));
  return streams;
}

TeamBelief::Options weigh_only() {
  TeamBelief::Options options;
  options.filter = {.particles = 500, .process_noise = 0.0, .resample_below = 0.0};
  options.response_noise = 0.0;
  return options;
}

// The factor by which the belief's particle i was weighed, relative to that of particle `one`.
double factor(const ParticleBelief& belief, std::size_t i, std::size_t one) {
  return belief.weights()[i] / belief.weights()[one];
}

std::optional<std::size_t> particle_in(const ParticleBelief& belief, const std::vector<HalfSpace>& list) {
  for (std::size_t i = 0; i < belief.size(); ++i) {
    if (std::all_of(list.begin(), list.end(), [&](const HalfSpace& h) { return h.contains(belief.point(i)); })) {
      return i;
    }
  }
  return std::nullopt;
}

// A particle that fits a member has the relative likelihood 1 for that member and jointly, so
// ratios of weights to its weight are likelihoods.
TEST(TeamBelief, JointlyIsNowhereLessLikelyThanForAnyMember) {
  RandomStream random{1};
  int compared = 0;
  for (int round = 0; round < 60; ++round) {
    TeamBelief team{lower_hemisphere(), weigh_only(), persons(3), RandomStream{2}};
    const Lists responses{random_list(2, random), random_list(1, random), random_list(3, random)};
    (void)team.observe_responses(responses, 1);
    for (std::size_t m = 0; m < 3; ++m) {
      const auto one = particle_in(team.member(m), responses[m]);
      if (!one) continue;
      ++compared;
      for (std::size_t i = 0; i < 500; ++i) {
        ASSERT_GE(factor(team.joint(), i, *one), factor(team.member(m), i, *one) * (1.0 - 1e-12));
      }
    }
  }
  EXPECT_GT(compared, 100);
}

TEST(TeamBelief, IsNowhereMoreLikelyInCommonThanForAnyMemberWhoAgrees) {
  RandomStream random{2};
  int compared = 0;
  for (int round = 0; round < 100; ++round) {
    TeamBelief team{lower_hemisphere(), weigh_only(), persons(3), RandomStream{2}};
    const Lists responses{random_list(1, random), random_list(1, random), random_list(2, random)};
    if (!team.observe_responses(responses, 1).empty()) continue;
    std::vector<HalfSpace> all;
    for (const auto& list : responses) all.insert(all.end(), list.begin(), list.end());
    const auto one = particle_in(team.common(), all);
    if (!one) continue;
    ++compared;
    for (std::size_t m = 0; m < 3; ++m) {
      for (std::size_t i = 0; i < 500; ++i) {
        ASSERT_LE(factor(team.common(), i, *one), factor(team.member(m), i, *one) * (1.0 + 1e-12));
      }
    }
  }
  EXPECT_GT(compared, 20);
}

// A course of teaching with answers that often conflict, also within a member.
struct Course {
  std::vector<std::vector<HalfSpace>> demonstrations;
  std::vector<Lists> responses;  // by period, then person
};

Course random_course(std::size_t members, std::uint64_t seed) {
  RandomStream random{seed};
  Course course;
  for (int period = 0; period < 6; ++period) {
    course.demonstrations.push_back(random_list(2, random, 3));
    Lists lists;
    for (std::size_t i = 0; i < members; ++i) lists.push_back(random_list(uniform_index(4, random), random, 2));
    course.responses.push_back(lists);
  }
  return course;
}

// Teaches with person order[k] in seat k; returns the persons left out per period, sorted.
std::vector<std::vector<std::size_t>> teach(TeamBelief& team, const Course& course,
                                            const std::vector<std::size_t>& order) {
  std::vector<std::vector<std::size_t>> excluded;
  for (std::size_t period = 0; period < course.responses.size(); ++period) {
    team.observe_demonstrations(course.demonstrations[period], period);
    Lists seated;
    for (const std::size_t person : order) seated.push_back(course.responses[period][person]);
    excluded.emplace_back();
    for (const std::size_t seat : team.observe_responses(seated, period)) excluded.back().push_back(order[seat]);
    std::sort(excluded.back().begin(), excluded.back().end());
    team.observe_feedback(course.demonstrations[period], period);
  }
  return excluded;
}

TEST(TeamBelief, GivesTheSameResultsBitForBitInOtherSeats) {
  const auto streams = persons(4);
  std::size_t num_excluded = 0;
  for (const bool reduce : {false, true}) {
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
      const Course course = random_course(4, seed);
      TeamBelief::Options options;
      options.filter.particles = 200;
      options.reduce_before_update = reduce;
      TeamBelief straight{lower_hemisphere(), options, streams, RandomStream{7}};
      const auto excluded = teach(straight, course, {0, 1, 2, 3});
      for (const auto& list : excluded) num_excluded += list.size();
      for (const std::vector<std::size_t>& order :
           {std::vector<std::size_t>{3, 2, 1, 0}, std::vector<std::size_t>{1, 3, 0, 2}}) {
        std::vector<RandomStream> seated;
        for (const std::size_t person : order) seated.push_back(streams[person]);
        TeamBelief permuted{lower_hemisphere(), options, seated, RandomStream{7}};
        EXPECT_EQ(teach(permuted, course, order), excluded);
        for (std::size_t seat = 0; seat < 4; ++seat) EXPECT_EQ(permuted.member(seat), straight.member(order[seat]));
        EXPECT_EQ(permuted.common(), straight.common());
        EXPECT_EQ(permuted.joint(), straight.joint());
      }
    }
  }
  EXPECT_GT(num_excluded, 20u);
}

TEST(TeamBelief, OfOneMemberHasOneBeliefEvenIfTheMemberContradictsItself) {
  for (const bool reduce : {false, true}) {
    TeamBelief::Options options;
    options.reduce_before_update = reduce;
    TeamBelief team{lower_hemisphere(), options, persons(1), RandomStream{7}};
    const HalfSpace east{{1, 0, 0}};
    for (std::uint64_t period = 0; period < 4; ++period) {
      team.observe_demonstrations(std::vector{east, east}, period);
      EXPECT_TRUE(team.observe_responses(Lists{{east, east.opposite()}}, period).empty());
      team.observe_feedback(std::vector{east}, period);
      EXPECT_EQ(team.member(0), team.common());
      EXPECT_EQ(team.member(0), team.joint());
    }
  }
}

// The belief about a member does not depend on who else is there: a person is taught alike in any team.
TEST(TeamBelief, KeepsMembersApart) {
  const Course course = random_course(3, 9);
  TeamBelief team{lower_hemisphere(), {}, persons(3), RandomStream{7}};
  TeamBelief alone{lower_hemisphere(), {}, {persons(3)[1]}, RandomStream{8}};
  (void)teach(team, course, {0, 1, 2});
  for (std::size_t period = 0; period < course.responses.size(); ++period) {
    alone.observe_demonstrations(course.demonstrations[period], period);
    (void)alone.observe_responses(Lists{course.responses[period][1]}, period);
    alone.observe_feedback(course.demonstrations[period], period);
  }
  EXPECT_EQ(team.member(1), alone.member(0));
}

TEST(TeamBelief, DoesNotChangeAPartByLeavingOutOthers) {
  const Course course = random_course(3, 10);
  TeamBelief full{lower_hemisphere(), {}, persons(3), RandomStream{7}};
  (void)teach(full, course, {0, 1, 2});
  TeamBelief::Options options;
  options.members = false;
  options.rules = {*find_aggregation_rule("common")};
  TeamBelief common{lower_hemisphere(), options, persons(3), RandomStream{7}};
  (void)teach(common, course, {0, 1, 2});
  EXPECT_EQ(common.common(), full.common());
  EXPECT_THROW((void)common.joint(), std::logic_error);
  EXPECT_THROW((void)common.member(0), std::logic_error);
  options.rules = {*find_aggregation_rule("joint")};
  TeamBelief joint{lower_hemisphere(), options, persons(3), RandomStream{7}};
  EXPECT_TRUE(teach(joint, course, {0, 1, 2})[0].empty());
  EXPECT_EQ(joint.joint(), full.joint());
  EXPECT_THROW((void)joint.common(), std::logic_error);
}

TEST(TeamBelief, LeavesOutTheMemberWhoContradictsTheOthers) {
  const HalfSpace east{{1, 0, 0}};
  TeamBelief team{lower_hemisphere(), weigh_only(), persons(3), RandomStream{7}};
  EXPECT_EQ(team.observe_responses(Lists{{east}, {east.opposite()}, {east}}, 0), (std::vector<std::size_t>{1}));
  const ParticleBelief start{lower_hemisphere(), weigh_only().filter};
  ParticleBelief expected = start;
  expected.observe(std::vector{east, east}, weigh_only().likelihood, RandomStream{0});
  EXPECT_EQ(team.common(), expected);
  EXPECT_EQ(team.joint(), start);  // every point fits somebody
}

TEST(TeamBelief, BreaksTiesByTheEvidenceOfTheCommonBelief) {
  const HalfSpace east{{1, 0, 0}};
  for (const bool taught_east : {true, false}) {
    TeamBelief team{lower_hemisphere(), weigh_only(), persons(2), RandomStream{7}};
    team.observe_demonstrations(std::vector{taught_east ? east : east.opposite()}, 0);
    EXPECT_EQ(team.observe_responses(Lists{{east}, {east.opposite()}}, 0),
              (std::vector<std::size_t>{taught_east ? 1u : 0u}));
  }
}

// Exactly equal evidence: a cover of one point on neither side's advantage leaves the tie to the
// addresses, which choose either person over many pairs. 200 fair coins: 5 sigma is 100 +- 35.
TEST(TeamBelief, BreaksRemainingTiesFairly) {
  TeamBelief::Options options = weigh_only();
  options.likelihood = HalfSpaceLikelihood{0.5};
  const HalfSpace east{{1, 0, 0}};
  std::size_t first = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    TeamBelief team{PriorCover{lower_hemisphere(), 500}, options, persons(2, seed), RandomStream{7}};
    first += team.observe_responses(Lists{{east}, {east.opposite()}}, 0).front() == 0 ? 1u : 0u;
  }
  EXPECT_GT(first, 65u);
  EXPECT_LT(first, 135u);
}

TEST(TeamBelief, AppliesTheMinimalSetIfAsked) {
  TeamBelief::Options options = weigh_only();
  options.reduce_before_update = true;
  const HalfSpace a{{1, 0, 0}};
  const HalfSpace b{{0, 1, 0}};
  const HalfSpace implied{{1, 1, 0}};
  TeamBelief team{lower_hemisphere(), options, persons(2), RandomStream{7}};
  EXPECT_TRUE(team.observe_responses(Lists{{a, implied}, {a, b}}, 0).empty());
  ParticleBelief expected{lower_hemisphere(), options.filter};
  expected.observe(std::vector{a, b}, options.likelihood, RandomStream{0});
  EXPECT_EQ(team.common(), expected);
}

TEST(TeamBelief, OfThirtyMembersWithAHundredHalfSpacesEachStaysFinite) {
  RandomStream random{11};
  const Lists responses(30, random_list(100, random, 9));
  TeamBelief::Options options;
  options.filter.particles = 200;
  options.likelihood = HalfSpaceLikelihood{0.95};
  TeamBelief team{lower_hemisphere(), options, persons(30), RandomStream{7}};
  (void)team.observe_responses(responses, 0);
  for (const ParticleBelief* belief : {&team.common(), &team.joint(), &team.member(29)}) {
    double sum = 0.0;
    for (const double w : belief->weights()) sum += w;
    EXPECT_NEAR(sum, 1.0, 1e-12);
  }
}

TEST(TeamBelief, IsUnchangedByAHardUpdateThatFails) {
  TeamBelief::Options options = weigh_only();
  options.likelihood = HalfSpaceLikelihood{1.0};
  TeamBelief team{lower_hemisphere(), options, persons(2), RandomStream{7}};
  team.observe_demonstrations(std::vector{HalfSpace{{1, 0, 0}}}, 0);
  const ParticleBelief member = team.member(0);
  const ParticleBelief common = team.common();
  EXPECT_THROW((void)team.observe_responses(Lists{{HalfSpace{{0, 1, 0}}}, {HalfSpace{{-1, 0, 0}}}}, 1), Error);
  EXPECT_THROW(team.observe_feedback(std::vector{HalfSpace{{-1, 0, 0}}}, 1), Error);
  EXPECT_EQ(team.member(0), member);
  EXPECT_EQ(team.common(), common);
}

TEST(TeamBelief, RefusesNobodyAndWrongNumbersOfLists) {
  EXPECT_THROW((TeamBelief{lower_hemisphere(), {}, {}, RandomStream{1}}), std::invalid_argument);
  TeamBelief::Options options;
  options.response_noise = -0.1;
  EXPECT_THROW((TeamBelief{lower_hemisphere(), options, persons(2), RandomStream{1}}), std::invalid_argument);
  TeamBelief team{lower_hemisphere(), {}, persons(2), RandomStream{1}};
  EXPECT_THROW((void)team.observe_responses(Lists(3), 0), std::invalid_argument);
}

}  // namespace
}  // namespace kith
