// How simulated members talk about their answers.

#include "kith/learners/discussion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>

#include "item_delivery.hpp"
#include "kith/domains/judgement.hpp"
#include "kith/learners/learner_model.hpp"
#include "kith/learners/run_period.hpp"

namespace kith {
namespace {

using testing::item_delivery;

constexpr std::uint64_t kSeed = 11;

struct Group {
  std::vector<RandomStream> persons;
  Learners learners;
  std::optional<Session> session;
};

// Members with these numbers in seats of this order.
Group group_of(TeachingCache& cache, const std::vector<std::size_t>& numbers) {
  const RandomStream root{kSeed};
  Group group;
  for (const auto number : numbers) {
    const auto person = root.split("person").split(number);
    ParameterValues values{bayesian_model().parameters};
    values.set("particles", std::int64_t{300});
    std::optional<PriorCover> cover;
    const LearnerStart start{.cover = [&](std::size_t points) -> const PriorCover& {
      return cover.emplace(item_delivery().prior_cone(), points);
    }};
    const auto traits = bayesian_model().draw(values, person.split("traits"));
    group.learners.push_back(bayesian_model().make(values, traits, start, person.split("learner")));
    group.persons.push_back(person);
  }
  TeachingOptions options;
  options.filter.particles = 200;
  options.keep_members = options.keep_rules = true;
  std::vector<RandomStream> beliefs;
  for (const auto& person : group.persons) beliefs.push_back(person.split("belief"));
  group.session.emplace(cache, options, strategy_named("common"), beliefs, root.split("teacher"));
  return group;
}

DiscussionChoice choice_of(const DiscussionModel& model) { return {&model, ParameterValues{model.parameters}}; }

const DiscussionModel& model_named(std::string_view name) {
  return *std::find_if(discussion_models().begin(), discussion_models().end(),
                       [&](const DiscussionModel& one) { return one.name == name; });
}

void run(Group& group, TeachingCache& cache, const DiscussionChoice& choice, std::size_t periods) {
  for (std::size_t p = 0; p < periods && group.session->propose(cache); ++p) {
    run_period(*group.session, cache, group.learners, {.discussion = choice, .talk = group.persons});
  }
}

class DiscussionLaws : public ::testing::TestWithParam<DiscussionModel> {};

TEST_P(DiscussionLaws, SeatsDoNotMatter) {
  TeachingCache cache{item_delivery()};
  auto group = group_of(cache, {1, 2, 3}), other = group_of(cache, {3, 1, 2});
  run(group, cache, choice_of(GetParam()), 4);
  run(other, cache, choice_of(GetParam()), 4);
  ASSERT_EQ(group.session->periods(), other.session->periods());
  EXPECT_EQ(group.session->belief().common(), other.session->belief().common());
  const std::vector<std::size_t> moved{1, 2, 0};
  for (std::size_t i = 0; i < moved.size(); ++i) {
    EXPECT_EQ(*group.learners[i]->belief(), *other.learners[moved[i]]->belief());
    EXPECT_EQ(group.session->belief().member(i), other.session->belief().member(moved[i]));
  }
}

TEST_P(DiscussionLaws, FirstAnswersAreThoseOfPeopleWhoDoNotTalk) {
  TeachingCache cache{item_delivery()};
  auto talking = group_of(cache, {1, 2, 3}), silent = group_of(cache, {1, 2, 3});
  run(talking, cache, choice_of(GetParam()), 1);
  run(silent, cache, {}, 1);
  EXPECT_EQ(talking.session->history().back().answers, silent.session->history().back().answers);
  EXPECT_EQ(talking.session->history().back().revised.empty(), !choice_of(GetParam()).is_held());
}

TEST_P(DiscussionLaws, OthersWhoAreNotSimulatedKeepTheirAnswers) {
  TeachingCache cache{item_delivery()};
  auto group = group_of(cache, {1, 2, 3});
  auto& session = *group.session;
  session.propose(cache);
  session.show();
  for (std::size_t i = 0; i < 3; ++i) {
    session.answer(i, std::vector<Answer>(session.lesson().tests.size(), IntegerVector{0, 0, 50}));
  }
  const std::vector<Learner*> nobody(3, nullptr);
  const auto revised = discuss(choice_of(GetParam()), session, cache, nobody, group.persons);
  EXPECT_EQ(revised, std::vector<std::vector<Answer>>(3));
}

INSTANTIATE_TEST_SUITE_P(All, DiscussionLaws,
                         ::testing::ValuesIn(discussion_models().begin(), discussion_models().end()),
                         [](const auto& instance) {
                           std::string name{instance.param.name};
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

// Answers of one test by hand: what the members say afterwards.
std::vector<std::vector<Answer>> after(const DiscussionChoice& choice, const std::vector<IntegerVector>& given,
                                       StartIndex start) {
  TeachingCache cache{item_delivery()};
  auto group = group_of(cache, {1, 2, 3, 4});
  const kith::Test test{.start = start, .covered = item_delivery().policy_bec_half_spaces()};
  Discussion discussion{cache.behaviours(), {&test, 1}, 1, {}};
  for (std::size_t i = 0; i < given.size(); ++i) {
    discussion.members.push_back({group.learners[i].get(), {given[i]}, group.persons[i]});
  }
  return choice.model->revise(choice.values, discussion);
}

const StartIndex kTest{4000};

TEST(Majority, IsFollowedUnlessThereIsATie) {
  const IntegerVector a{0, 0, 5}, b{0, 1, 3}, c{1, 0, 2};
  const auto choice = choice_of(model_named("majority"));
  for (const auto& answers : after(choice, {a, b, a, c}, kTest)) EXPECT_EQ(answers, std::vector<Answer>{a});
  const auto tied = after(choice, {b, a, b, a}, kTest);
  EXPECT_EQ(tied[0], std::vector<Answer>{b});
  EXPECT_EQ(tied[1], std::vector<Answer>{a});
  EXPECT_EQ(after(choice, {a, b, c}, kTest)[1], std::vector<Answer>{b});
}

// Whatever the group answered, and in whatever order: the answer that more gave than any other, else everybody's own.
TEST(Majority, IsThatOfACount) {
  TeachingCache cache{item_delivery()};
  auto group = group_of(cache, {1, 2, 3, 4, 5});
  ASSERT_TRUE(group.session->propose(cache));
  const auto& model = model_named("majority");
  const ParameterValues values{model.parameters};
  for (std::size_t votes = 0; votes < 4 * 4 * 4 * 4 * 4; ++votes) {  // of five people, for one of three answers or none
    Discussion discussion{cache.behaviours(), std::span{group.session->lesson().tests}.first(1), 1, {}};
    std::map<std::int64_t, int> counts;
    std::size_t rest = votes;
    for (const auto& learner : group.learners) {
      const auto vote = static_cast<std::int64_t>(rest % 4);
      rest /= 4;
      const Answer answer = vote == 0 ? Answer{} : Answer{IntegerVector{vote, 0, 1}};
      if (answer) ++counts[vote];
      discussion.members.push_back({learner.get(), {answer}, RandomStream{0}});
    }
    std::vector<std::int64_t> first;  // the answers that most gave
    for (const auto& [vote, count] : counts) {
      const auto others = [&, &n = count](const auto& other) { return other.second > n; };
      if (std::none_of(counts.begin(), counts.end(), others)) first.push_back(vote);
    }

    const auto revised = model.revise(values, discussion);
    for (std::size_t i = 0; i < revised.size(); ++i) {
      const auto expected =
          first.size() == 1 ? Answer{IntegerVector{first.front(), 0, 1}} : discussion.members[i].answers[0];
      ASSERT_EQ(revised[i].at(0), expected) << votes << ", member " << i + 1;
    }
  }
}

TEST(TruthWins, AsOftenAsItSays) {
  const auto right = item_delivery().feature_counts(kTest);
  auto wrong = right;
  wrong[2] += 3;
  ASSERT_FALSE(judge_path(item_delivery().domain(), right, wrong).is_right);
  auto choice = choice_of(model_named("truth-wins"));
  choice.values.set("convinces", 1.0);
  for (const auto& answers : after(choice, {wrong, right, wrong}, kTest)) {
    EXPECT_EQ(answers, std::vector<Answer>{right});
  }
  EXPECT_EQ(after(choice, {wrong, wrong, wrong}, kTest)[0], std::vector<Answer>{wrong});  // nobody knows
  choice.values.set("convinces", 0.0);
  EXPECT_EQ(after(choice, {wrong, right, wrong}, kTest)[0], std::vector<Answer>{wrong});
}

TEST(DeGroot, MixesBeliefsInTheSharesOfTrust) {
  TeachingCache cache{item_delivery()};
  auto group = group_of(cache, {1, 2});
  const auto& bec = item_delivery().policy_bec_half_spaces();
  for (std::size_t period = 1; period <= 5; ++period) group.learners[0]->watch(bec, period);
  const auto sure = *group.learners[0]->belief(), unsure = *group.learners[1]->belief();
  const double precise = 1.0 / (sure.spread() * sure.spread()), vague = 1.0 / (unsure.spread() * unsure.spread());
  const double trust = precise / (precise + vague);  // in the one who is sure
  ASSERT_GT(trust, 0.5);
  auto choice = choice_of(model_named("degroot"));
  choice.values.set("openness", 0.6);
  const kith::Test test{.start = kTest, .covered = {}};
  Discussion discussion{cache.behaviours(), {&test, 1}, 1, {}};
  for (std::size_t i = 0; i < 2; ++i) {
    discussion.members.push_back({group.learners[i].get(), {std::nullopt}, group.persons[i]});
  }
  (void)choice.model->revise(choice.values, discussion);
  // Points are drawn systematically: the mass in a region is off by at most a few points of the 300.
  for (const auto& half_space : bec) {
    const auto mass = [&](const ParticleBelief& one) { return one.mass_in({&half_space, 1}); };
    const double mean = trust * mass(sure) + (1.0 - trust) * mass(unsure);
    EXPECT_NEAR(mass(*group.learners[0]->belief()), 0.4 * mass(sure) + 0.6 * mean, 0.03);
    EXPECT_NEAR(mass(*group.learners[1]->belief()), 0.4 * mass(unsure) + 0.6 * mean, 0.03);
  }
}

}  // namespace
}  // namespace kith
