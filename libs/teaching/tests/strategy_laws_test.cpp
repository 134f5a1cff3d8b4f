// What holds for every kind of strategy in the registry.

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>

#include "item_delivery.hpp"
#include "kith/core/distributions.hpp"
#include "kith/core/error.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/teaching/session.hpp"
#include "robots_answers.hpp"

namespace kith {
namespace {

using testing::item_delivery;

// Few worlds and starts, so that there is little to ask about.
constexpr const char* kLibrary = R"(schema = "kith.domain/1"
id = "library"
[mdp]
discount = 1.0
max_steps = 60
[family]
starts = 3
[map]
rows = ["..q..#.k..G",
        "S.q..L.kk..",
        ".##..#.##..",
        ".....#..q..",
        "..kk.#..q..",
        ".....R....."]
[map.legend]
"." = "floor"
"#" = "wall"
"S" = { start = true }
"G" = { goal = true }
"L" = { terrain = "lift" }
"R" = { terrain = "ramp" }
"q" = { terrain = "quiet", optional = "exam" }
"k" = { terrain = "carpet", optional = "carpets" }
[[feature]]
name = "lift"
when = "enter:lift"
[[feature]]
name = "noise"
when = "enter:quiet"
[[feature]]
name = "step"
when = "action"
[reward]
weights = { lift = -5, noise = -3, step = -1 }
[prior]
halfspaces = [ { lift = -1 }, { noise = -1 }, { step = -1 } ]
)";

class EveryKind : public ::testing::TestWithParam<std::size_t> {
 protected:
  [[nodiscard]] static const StrategyKind& kind() { return strategy_kinds()[GetParam()]; }
  [[nodiscard]] static std::size_t team_size() { return kind().name == kBaseline ? 1 : 3; }

  [[nodiscard]] static RandomStream person(std::size_t i) { return RandomStream{21}.split("person").split(i); }

  // Who sits in seat i is seats[i].
  [[nodiscard]] static Session session_of(TeachingCache& cache, const std::vector<std::size_t>& seats) {
    std::vector<RandomStream> persons;
    for (const auto i : seats) persons.push_back(person(i));
    TeachingOptions options;
    options.filter.particles = 200;
    options.max_periods = 6;
    return {cache, options, strategy_named(kind().name), persons, RandomStream{21}.split("teacher")};
  }
  [[nodiscard]] static std::vector<std::size_t> in_order() {
    std::vector<std::size_t> seats;
    for (std::size_t i = 0; i < team_size(); ++i) seats.push_back(i);
    return seats;
  }

  // A person's answers depend on the person and the period only.
  static std::vector<std::vector<Answer>> answers(const Session& session, const std::vector<std::size_t>& seats) {
    std::vector<std::vector<Answer>> all;
    for (const auto i : seats) {
      auto random = person(i).split("answers").split(session.periods());
      auto& list = all.emplace_back();
      for (const auto& test : session.lesson().tests) {
        const auto paths = item_delivery().tables().coverage_set(test.start);
        list.emplace_back(paths[uniform_index(paths.size(), random)]);
      }
    }
    return all;
  }
};

TEST_P(EveryKind, SaysWhatItIs) {
  EXPECT_FALSE(kind().name.empty());
  EXPECT_FALSE(kind().description.empty());
  EXPECT_EQ(std::count_if(strategy_kinds().begin(), strategy_kinds().end(),
                          [](const auto& other) { return other.name == kind().name; }),
            1);
  for (const auto& parameter : kind().parameters) {
    EXPECT_FALSE(parameter.description.empty()) << parameter.name;
  }
  for (const auto& rule : kind().needs(ParameterValues{kind().parameters}).rules) {
    EXPECT_NE(find_aggregation_rule(rule), nullptr) << rule;
  }
}

TEST_P(EveryKind, RefusesParametersOutOfRange) {
  for (const auto& parameter : kind().parameters) {
    ParameterValues values{kind().parameters};
    if (std::holds_alternative<double>(parameter.default_value)) {
      EXPECT_THROW(values.set(parameter.name, parameter.max * 2.0 + 1.0), Error) << parameter.name;
    } else if (std::holds_alternative<std::int64_t>(parameter.default_value)) {
      EXPECT_THROW(values.set(parameter.name, static_cast<std::int64_t>(parameter.min) - 1), Error) << parameter.name;
    } else if (std::holds_alternative<std::string>(parameter.default_value) && !parameter.words.empty()) {
      EXPECT_THROW(values.set(parameter.name, std::string{"no such word"}), Error) << parameter.name;
    }
  }
}

TEST_P(EveryKind, TeachesAlikeForEqualStreamsAndAnswers) {
  TeachingCache cache{item_delivery()};
  TeachingCache other_cache{item_delivery()};
  auto a = session_of(cache, in_order());
  auto b = session_of(other_cache, in_order());
  while (a.propose(cache)) {
    ASSERT_TRUE(b.propose(other_cache));
    ASSERT_EQ(a.lesson(), b.lesson());
    a.submit(answers(a, in_order()));
    b.submit(answers(b, in_order()));
    ASSERT_EQ(a, b);
  }
  EXPECT_FALSE(b.propose(other_cache));
  EXPECT_GT(a.periods(), 2u);
}

TEST_P(EveryKind, DoesNotLookAtSeats) {
  TeachingCache cache{item_delivery()};
  auto straight = session_of(cache, in_order());
  auto seats = in_order();
  std::rotate(seats.begin(), seats.begin() + static_cast<std::ptrdiff_t>(seats.size() / 2), seats.end());
  auto permuted = session_of(cache, seats);
  while (straight.propose(cache)) {
    ASSERT_TRUE(permuted.propose(cache));
    auto here = straight.lesson();
    auto there = permuted.lesson();
    ASSERT_EQ(here.source.rule, there.source.rule);
    if (here.source.is_member()) {
      ASSERT_EQ(in_order()[here.source.member], seats[there.source.member]);
    }
    here.source = there.source = {};
    ASSERT_EQ(here, there);
    straight.submit(answers(straight, in_order()));
    permuted.submit(answers(permuted, seats));
  }
  EXPECT_FALSE(permuted.propose(cache));
}

TEST_P(EveryKind, IsReplayedFromItsEvents) {
  TeachingCache cache{item_delivery()};
  auto original = session_of(cache, in_order());
  while (original.propose(cache)) original.submit(answers(original, in_order()));
  TeachingCache fresh{item_delivery()};
  auto again = session_of(fresh, in_order());
  for (const auto& event : original.events()) again.apply(event, fresh);
  EXPECT_EQ(original, again);
}

// A copy in the middle of teaching goes on as the original does.
TEST_P(EveryKind, IsCopiedWithItsState) {
  TeachingCache cache{item_delivery()};
  auto original = session_of(cache, in_order());
  for (int period = 0; period < 3 && original.propose(cache); ++period) original.submit(answers(original, in_order()));
  auto copy = original;
  while (original.propose(cache)) {
    ASSERT_TRUE(copy.propose(cache));
    ASSERT_EQ(original.lesson(), copy.lesson());
    original.submit(answers(original, in_order()));
    copy.submit(answers(copy, in_order()));
  }
  EXPECT_FALSE(copy.propose(cache));
  EXPECT_EQ(original, copy);
}

// In a domain of few starts. A test that was demonstrated asks about something that all starts which ask about it did
// show, and lessons count such tests.
TEST_P(EveryKind, AsksWhatItShowedOnlyIfNothingElseServes) {
  const Atlas atlas{parse_domain(kLibrary, "library.toml").domain.value()};
  TeachingCache cache{atlas};
  auto taught = session_of(cache, in_order());
  std::vector<bool> shown(atlas.num_states());
  std::size_t num_repeated = 0;
  for (int period = 0; period < 8 && taught.propose(cache); ++period) {
    const auto& lesson = taught.lesson();
    const auto& component = atlas.knowledge_components()[lesson.component];
    for (const auto& one : lesson.demonstrations) shown[one.start.value()] = true;
    const auto all_shown = [&](const HalfSpace& constraint) {
      const auto number = atlas.constraints().find(constraint);
      if (!number) return false;
      const auto tests = atlas.tests_for(*number);
      return std::all_of(tests.begin(), tests.end(), [&](StartIndex start) {
        return shown[start.value()] || !component.uses_mdp[atlas.id(start).mdp.value()];
      });
    };
    std::size_t repeated = 0;
    for (const auto& test : lesson.tests) {
      if (!shown[test.start.value()]) continue;
      ++repeated;
      if (test.exact) {
        EXPECT_TRUE(std::any_of(test.covered.begin(), test.covered.end(), all_shown)) << lesson.period;
      }
    }
    EXPECT_EQ(lesson.tests_demonstrated, repeated);
    num_repeated += repeated;
    const std::vector<std::vector<Answer>> nobody(team_size(), std::vector<Answer>(lesson.tests.size()));
    taught.submit(nobody);
  }
  EXPECT_GT(taught.periods(), 2u);
  RecordProperty("repeated", static_cast<int>(num_repeated));
}

INSTANTIATE_TEST_SUITE_P(Registry, EveryKind, ::testing::Range(std::size_t{0}, strategy_kinds().size()),
                         [](const auto& c) {
                           std::string name{strategy_kinds()[c.param].name};
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(Session, KeepsTheAtlasAlive) {
  std::optional<Session> session;
  {
    TeachingCache cache{std::make_shared<const Atlas>(load_domain("colored-tiles"))};
    session.emplace(cache, TeachingOptions{}, strategy_named("common"), std::vector{RandomStream{1}}, RandomStream{2});
    ASSERT_TRUE(session->propose(cache));
  }
  EXPECT_EQ(session->atlas().domain().id(), "colored-tiles");
  session->show();
  session->answer(0, testing::robots_answers(*session));
  session->close_tests();
  EXPECT_TRUE(session->give_feedback().all_correct[0]);
}

}  // namespace
}  // namespace kith
