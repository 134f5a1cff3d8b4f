#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "item_delivery.hpp"
#include "kith/learners/bayesian_learner.hpp"
#include "kith/learners/run_period.hpp"
#include "kith/study/study.hpp"
#include "kith/study/summary.hpp"

namespace kith {
namespace {

using testing::item_delivery;

LearnerType learner_type_of(char letter, double ability, double sd, double confirm, double correct) {
  LearnerType type{.letter = letter, .label = {}};
  type.parameters.set("ability.mean", ability);
  type.parameters.set("ability.sd", sd);
  type.parameters.set("confirm_gain", Spread{.half_normal = confirm, .value = {}});
  type.parameters.set("correct_gain", Spread{.half_normal = correct, .value = {}});
  return type;
}

// The paper's design with the default parameters.
StudySpec paper(std::size_t replicates, double ability_scale = 1.0) {
  StudySpec spec;
  spec.id = "paper";
  spec.seed = 20240424;
  spec.replicates = replicates;
  for (const auto* name : {"baseline", "individual-low", "individual-high", "common", "joint"}) {
    spec.strategies.push_back(strategy_named(name));
  }
  spec.compositions = {"NNN", "NNP", "NPP", "PPP"};
  spec.learner_types = {learner_type_of('N', 0.703, 0.034, 0.033, 0.056),
                        learner_type_of('P', 0.809, 0.025, 0.022, 0.052)};
  for (auto& type : spec.learner_types) type.parameters.set("ability_scale", ability_scale);
  return spec;
}

void expect_equal(const TeamRecord& a, const TeamRecord& b) {
  EXPECT_EQ(a.address.team, b.address.team);
  EXPECT_EQ(a.periods, b.periods);
  EXPECT_EQ(a.knowledge, b.knowledge);  // to the last bit
  EXPECT_EQ(a.area_sr, b.area_sr);
  EXPECT_EQ(a.demonstrations, b.demonstrations);
  ASSERT_EQ(a.period_records.size(), b.period_records.size());
  for (std::size_t i = 0; i < a.period_records.size(); ++i) {
    EXPECT_EQ(a.period_records[i].p_bec, b.period_records[i].p_bec);
  }
  ASSERT_EQ(a.responses.size(), b.responses.size());
  for (std::size_t i = 0; i < a.responses.size(); ++i) EXPECT_EQ(a.responses[i].answer, b.responses[i].answer);
}

TEST(RunTeams, GivesTheSameRecordsOnAnyNumberOfThreadsAndInAnyOrder) {
  const Study study{{paper(2)}};
  const auto addresses = team_addresses(study);
  const auto one = run_teams(item_delivery(), study, addresses, {.threads = 1, .on_progress = {}});
  const auto two = run_teams(item_delivery(), study, addresses, {.threads = 2, .on_progress = {}});
  const auto seven = run_teams(item_delivery(), study, addresses, {.threads = 7, .on_progress = {}});
  auto backwards = addresses;
  std::reverse(backwards.begin(), backwards.end());
  const auto reversed = run_teams(item_delivery(), study, backwards, {.threads = 2, .on_progress = {}});
  ASSERT_EQ(one.teams.size(), addresses.size());
  for (std::size_t i = 0; i < addresses.size(); ++i) {
    expect_equal(one.teams[i], two.teams[i]);
    expect_equal(one.teams[i], seven.teams[i]);
    expect_equal(one.teams[i], reversed.teams[addresses.size() - 1 - i]);
  }
}

TEST(RunTeams, AnotherSeedGivesOtherTeams) {
  auto spec = paper(2);
  const Study study{{spec}};
  spec.seed += 1;
  const Study other{{spec}};
  const auto a = run_teams(item_delivery(), study, team_addresses(study));
  const auto b = run_teams(item_delivery(), other, team_addresses(other));
  std::size_t different = 0;
  for (std::size_t i = 0; i < a.teams.size(); ++i) different += a.teams[i].knowledge != b.teams[i].knowledge ? 1u : 0u;
  EXPECT_EQ(different, a.teams.size());
}

TEST(RunTeams, PairingTeachesTheSamePeopleInEveryStrategy) {
  auto spec = paper(1);
  spec.compositions = {"NNP"};
  const Study paired{{spec}};
  const auto teams = run_teams(item_delivery(), paired, team_addresses(paired)).teams;
  for (const auto& team : teams) {
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(team.learners[i].traits, teams[0].learners[i].traits);
  }
  spec.pairing = Pairing::kNone;
  const Study unpaired{{spec}};
  const auto strangers = run_teams(item_delivery(), unpaired, team_addresses(unpaired)).teams;
  EXPECT_NE(strangers[0].learners[0].traits, strangers[1].learners[0].traits);
}

TEST(RunTeams, TheBaselineSumsPeriodsOverItsMembers) {
  auto spec = paper(3);
  spec.strategies = {strategy_named("baseline")};
  const Study study{{spec}};
  for (const auto& team : run_teams(item_delivery(), study, team_addresses(study)).teams) {
    std::size_t periods = 0;
    for (const auto& learner : team.learners) periods += learner.periods;
    EXPECT_EQ(team.periods, periods);
    EXPECT_EQ(team.period_records.size(), periods);
    EXPECT_LE(team.components_learned + team.components_skipped, 9u);
  }
}

TEST(RunTeams, RecordsEveryBeliefAtTheEndOfEveryPeriodWhenAskedTo) {
  auto spec = paper(1);
  spec.strategies = {strategy_named("common")};
  spec.compositions = {"NP"};
  const Study plain{{spec}};
  const auto without = run_teams(item_delivery(), plain, team_addresses(plain)).teams.front();
  EXPECT_TRUE(without.beliefs.empty());
  spec.record = RecordLevel::kParticles;
  const Study study{{spec}};
  const auto team = run_teams(item_delivery(), study, team_addresses(study)).teams.front();
  expect_equal(team, without);                       // looking changes nothing
  ASSERT_EQ(team.beliefs.size(), team.periods * 6);  // own and teacher's of two members, common, joint
  const auto& bec = item_delivery().policy_bec_half_spaces();
  for (const auto& belief : team.beliefs) {
    ASSERT_EQ(belief.weights.size(), 1000u);
    double in_bec = 0.0;
    for (std::size_t i = 0; i < belief.weights.size(); ++i) {
      const Eigen::Vector3d w{belief.points[i], belief.points[1000 + i], belief.points[2000 + i]};
      if (std::all_of(bec.begin(), bec.end(), [&](const HalfSpace& h) { return h.contains(w); }))
        in_bec += belief.weights[i];
    }
    if (belief.belief == "common") {
      EXPECT_NEAR(in_bec, team.period_records[belief.period - 1].p_bec[0], 1e-12);
    }
  }
}

TEST(RunTeams, StopsWhenAskedTo) {
  const Study study{{paper(2)}};
  const auto result = run_teams(item_delivery(), study, team_addresses(study),
                                {.threads = 1, .on_progress = [](std::size_t done, std::size_t) { return done < 5; }});
  EXPECT_TRUE(result.stopped);
  EXPECT_EQ(result.teams.size(), 5u);
}

// Seats do not matter: members who swap seats, and take their streams along,
// swap their results, and the team's lessons stay the same, bit for bit.
TEST(Teams, PermutingTheMembersPermutesTheirResults) {
  const auto& atlas = item_delivery();
  const auto teach = [&](std::string_view strategy, const std::vector<std::uint64_t>& seats) {
    TeachingCache cache{atlas};
    std::vector<RandomStream> streams;
    Learners learners;
    for (const auto person : seats) {
      const auto stream = RandomStream{11}.split(person);
      const BayesianPerson parameters{.ability = 0.65 + 0.05 * static_cast<double>(person),
                                      .confirm_gain = 0.02,
                                      .correct_gain = 0.05,
                                      .ability_max = 0.95,
                                      .ability_scale = 1.0};
      streams.push_back(stream.split("teacher belief"));
      learners.push_back(std::make_unique<BayesianLearner>(ParticleBelief{atlas.prior_cone(), {}}, parameters,
                                                           LikelihoodForm::kDiscontinuous, stream.split("learner")));
    }
    Session session{
        cache, {.keep_members = true, .keep_rules = true}, strategy_named(strategy), streams, RandomStream{12}};
    for (int period = 0; period < 8 && session.propose(cache); ++period) run_period(session, cache, learners);
    return std::pair{std::move(session), std::move(learners)};
  };
  for (const auto& kind : strategy_kinds()) {
    if (kind.name == kBaseline) continue;
    const std::vector<std::uint64_t> order{0, 1, 2, 3};
    const std::vector<std::uint64_t> permuted{2, 0, 3, 1};
    const auto [session, learners] = teach(kind.name, order);
    const auto [other, others] = teach(kind.name, permuted);
    EXPECT_EQ(session.periods(), other.periods());
    EXPECT_EQ(session.belief().common(), other.belief().common());
    EXPECT_EQ(session.belief().joint(), other.belief().joint());
    for (std::size_t seat = 0; seat < order.size(); ++seat) {
      EXPECT_EQ(*learners[permuted[seat]]->belief(), *others[seat]->belief());
      EXPECT_EQ(session.belief().member(permuted[seat]), other.belief().member(seat));
    }
  }
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double standard_error(const std::vector<double>& values) {
  const double m = mean(values);
  double squares = 0.0;
  for (const double v : values) squares += (v - m) * (v - m);
  const auto n = static_cast<double>(values.size());
  return std::sqrt(squares / (n - 1.0) / n);
}

// Abler learners need fewer periods: the same 100 teams, except that everybody's
// initial ability is 0.66 or 0.86. The mean paired difference lies above zero by
// more than 5 of its standard errors.
TEST(Teams, AblerTeamsNeedFewerPeriods) {
  auto spec = paper(100);
  spec.strategies = {strategy_named("common")};
  spec.compositions = {"NNN"};
  spec.learner_types[0] = learner_type_of('N', 0.66, 0.001, 0.02, 0.05);
  auto abler = spec;
  abler.learner_types[0] = learner_type_of('N', 0.86, 0.001, 0.02, 0.05);
  const Study slow{{spec}};
  const Study fast{{abler}};
  const auto a = run_teams(item_delivery(), slow, team_addresses(slow)).teams;
  const auto b = run_teams(item_delivery(), fast, team_addresses(fast)).teams;
  std::vector<double> saved;
  for (std::size_t i = 0; i < a.size(); ++i)
    saved.push_back(static_cast<double>(a[i].periods) - static_cast<double>(b[i].periods));
  EXPECT_GT(mean(saved), 5.0 * standard_error(saved));
  EXPECT_GT(mean(saved), 1.0);
}

// Where an independent prototype of the same model lies, at 500 teams per cell.
// The bounds are its figures with the spread that is allowed between programs.
struct Expected {
  double ability_scale;
  double group_periods;
  double baseline_periods;
  double group_knowledge;
  double baseline_knowledge;
};

class PublishedStudySlow : public ::testing::TestWithParam<Expected> {};

TEST_P(PublishedStudySlow, LiesWhereAnIndependentPrototypeLies) {
  const auto expected = GetParam();
  auto spec = paper(500, expected.ability_scale);
  spec.record = RecordLevel::kTeam;
  const Study study{{spec}};
  const auto summary = summarize(run_teams(item_delivery(), study, team_addresses(study)).teams);
  ASSERT_TRUE(summary.group && summary.baseline);
  EXPECT_NEAR(summary.group->periods->mean, expected.group_periods, 0.25);
  EXPECT_NEAR(summary.baseline->periods->mean, expected.baseline_periods, 0.4);
  EXPECT_NEAR(summary.group->knowledge->mean, expected.group_knowledge, 0.04);
  EXPECT_NEAR(summary.baseline->knowledge->mean, expected.baseline_knowledge, 0.04);
  EXPECT_GE(summary.group->completed, summary.group->teams * 99 / 100);
  EXPECT_GE(summary.baseline->completed, summary.baseline->teams * 99 / 100);
}

INSTANTIATE_TEST_SUITE_P(AbilityScale, PublishedStudySlow,
                         ::testing::Values(Expected{1.0, 7.33, 15.55, 0.74, 0.55},
                                           Expected{0.9, 7.67, 16.2, 0.71, 0.52}),
                         [](const auto& c) { return c.param.ability_scale == 1.0 ? "One" : "NineTenths"; });

}  // namespace
}  // namespace kith
