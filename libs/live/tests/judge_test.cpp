// One judge says which paths are right: tests, exams, screening, lessons and tables agree with it about near ties.
#include "kith/domains/judgement.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "kith/core/distributions.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/explain/curriculum.hpp"
#include "kith/geometry/cover.hpp"
#include "kith/teaching/exam.hpp"
#include "live_play.hpp"

namespace kith {
namespace {

using testing::Play;

std::string digits(double x, int n = 17) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", n, x);
  return text;
}

// A family of forks: from every start two ways lead to the end at once. The first forks differ clearly, so that there
// is something to teach; the others are near ties, whose ways differ by `factors` times what is equal.
struct Forks {
  Domain domain;
  std::vector<double> factors;  // per state; 0: a clear fork
};

constexpr std::size_t kClear = 6;
const std::vector<double> kWeights{-2.0, -0.5, 3.0};

// @param size  of the features of near ties, @param scale  of the weights in the file.
Forks forks(double size, double scale, const std::string& normalize, RandomStream random) {
  const std::vector<double> near{0.0, 0.4, 0.8, 1.25, 2.5, 40.0};
  std::string states = "state,name,terminal,start\n", transitions = "state,action,next,probability,a,b,c\n";
  std::vector<double> factors;
  const auto add = [&](std::span<const double> left, std::span<const double> right, double factor) {
    const auto name = "s" + std::to_string(factors.size());
    states += name + "," + name + ",false,true\n";
    const bool is_swapped = uniform_index(2, random) == 1;  // so that either action may be the robot's
    for (const bool first : {true, false}) {
      const auto& features = first == is_swapped ? right : left;
      transitions += name + (first ? ",left" : ",right") + ",end,1";
      for (const double x : features) transitions += "," + digits(x);
      transitions += "\n";
    }
    factors.push_back(factor);
  };
  for (std::size_t i = 0; i < kClear; ++i) {
    std::array<double, 3> left{}, right{};
    for (auto& x : left) x = static_cast<double>(uniform_index(4, random));
    for (auto& x : right) x = static_cast<double>(uniform_index(4, random)) + 0.5;
    add(left, right, 0.0);
  }
  const double length = std::sqrt(kWeights[0] * kWeights[0] + kWeights[1] * kWeights[1] + kWeights[2] * kWeights[2]);
  for (int i = 0; i < 3; ++i) {
    for (const double factor : near) {
      std::array<double, 3> left{}, right{};
      for (auto& x : left) x = size * uniform01(random);
      double value = 0.0;
      for (std::size_t k = 0; k < 3; ++k) value += kWeights[k] * left[k] / length;
      // Another mix of features, and as much less of the last as makes the loss.
      const double equal = 1e-6 * std::max(1.0, std::abs(value));
      right = {left[0] + 0.3 * size, left[1] + 0.6 * size, left[2] + 0.3 * size};
      right[2] -= factor * equal * length / kWeights[2];
      add(left, right, factor);
    }
  }
  states += "end,the end,true,false\n";
  const auto weight = [&](std::size_t k) { return digits(scale * kWeights[k], 6); };
  const auto text =
      "schema = \"kith.domain/1\"\nid = \"forks\"\n[model]\nformat = \"csv\"\nstates = \"states.csv\"\n"
      "transitions = \"transitions.csv\"\n[[feature]]\nname = \"a\"\n[[feature]]\nname = \"b\"\n"
      "[[feature]]\nname = \"c\"\n[reward]\nweights = { a = " +
      weight(0) + ", b = " + weight(1) + ", c = " + weight(2) + " }\nnormalize = \"" + normalize +
      "\"\n[prior]\nhalfspaces = [ { a = -1 } ]\n";
  DomainFiles files;
  files.known = {{"states.csv", states}, {"transitions.csv", transitions}};
  auto reading = parse_domain(text, "forks.toml", {}, files);
  if (!reading.domain) throw std::runtime_error{to_text(reading.diagnostics.front())};
  return {*std::move(reading.domain), std::move(factors)};
}

// The other way of a fork.
std::size_t other_choice(const Atlas& atlas, StartIndex start) {
  return atlas.deviation_counts(start, 0) == atlas.feature_counts(start) ? 1 : 0;
}

std::shared_ptr<const LiveStudy> study_about(const std::shared_ptr<const Atlas>& atlas) {
  std::string text = testing::kLiveStudy;
  text.replace(text.find("item-delivery"), 13, "two-goals");
  const auto reading = parse_study(text, "live.toml", {.overrides = {}, .folder = KITH_SOURCE_DIR});
  auto study = *make_live_study(*reading.study, testing::atlas_of("two-goals"));
  study.atlas = atlas;
  for (StartIndex start{0}; start.value() < atlas->num_states(); ++start) study.screening.push_back(start);
  return std::make_shared<const LiveStudy>(std::move(study));
}

// Submits, in a session, answers that are right or not as `is_right` says of them.
void expect_session_agrees(TeachingCache& cache, RandomStream random) {
  const auto& atlas = cache.atlas();
  const auto& domain = atlas.domain();
  Session session{cache, {}, strategy_named(kBaseline), {RandomStream{1}}, RandomStream{2}};
  ASSERT_TRUE(session.propose(cache));
  std::size_t checked = 0;
  for (int round = 0; round < 12 && !session.finished(); ++round) {
    session.show();
    std::vector<Answer> answers;
    std::vector<bool> right;
    for (const auto& test : session.lesson().tests) {
      const auto& robot = atlas.feature_counts(test.start);
      // A random difference, its entries scaled so that the loss is about what is equal.
      IntegerVector path = robot;
      const auto size = std::ldexp(1.0, static_cast<int>(uniform_index(domain.is_exact() ? 3 : 24, random)));
      for (std::size_t k = 0; k < path.size(); ++k) path[k] += std::llround((2.0 * uniform01(random) - 1.0) * size);
      if (judge_path(domain, robot, path).is_better) path = robot + (robot - path);  // then it is worse
      right.push_back(judge_path(domain, robot, path).is_right);
      EXPECT_EQ(grade_answer(atlas, test.start, path).share_right, right.back() ? 1.0 : 0.0);
      answers.emplace_back(path);
    }
    session.answer(0, answers);
    const auto& feedback = session.close_tests();
    for (std::size_t t = 0; t < right.size(); ++t) {
      const auto& verdict = feedback.verdicts[0][t];
      EXPECT_EQ(verdict.correct, right[t]);
      EXPECT_EQ(verdict.regret == 0.0, right[t]);
      ++checked;
    }
    session.give_feedback();
    if (!session.propose(cache)) break;
  }
  EXPECT_GT(checked, 0u);
}

// Whether the last answer to a screening was right.
bool screened(const Play& play) {
  const auto& events = play.events();
  const auto last = std::find_if(events.rbegin(), events.rend(),
                                 [](const RoomEvent& event) { return event.get<happening::Screened>() != nullptr; });
  return last->get<happening::Screened>()->right;
}

// The share of beliefs that the curriculum finds right in its first component is that of the judge.
void expect_curriculum_agrees(TeachingCache& cache) {
  const auto& atlas = cache.atlas();
  const auto& domain = atlas.domain();
  CurriculumOptions options;
  options.beliefs = 200;
  const auto first = make_curriculum(atlas, options).components.front();
  Cone region{domain.num_features()};
  auto prior = domain.prior();
  std::sort(prior.begin(), prior.end());
  ASSERT_TRUE(region.clip(prior));
  const Eigen::MatrixXd points = cover(region, options.beliefs);
  for (const auto& test : first.tests) {
    double right = 0.0;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      const auto answer = cache.behaviours().answer(test.start, cache.behaviours().locate(Direction{points.col(i)}));
      right += answer && judge_path(domain, atlas.feature_counts(test.start), *answer).is_right ? 1.0 : 0.0;
    }
    EXPECT_DOUBLE_EQ(test.share_right, right / static_cast<double>(points.cols()));
  }
}

TEST(Judge, IsTheSameForTestsExamsScreeningAndLessonsAboutNearTies) {
  std::uint64_t seed = 0;
  for (const double size : {0.01, 1.0, 50.0, 20'000.0}) {
    for (const double scale : {1.0, 1e-9, 1e6}) {
      SCOPED_TRACE("features of " + digits(size, 6) + ", weights times " + digits(scale, 6));
      const RandomStream random = RandomStream{36}.split(++seed);
      auto made = forks(size, scale, seed % 2 == 0 ? "l1" : "l2", random.split("forks"));
      ASSERT_FALSE(made.domain.is_exact());
      const auto atlas = std::make_shared<const Atlas>(std::move(made.domain));
      const auto& domain = atlas->domain();
      Play play{study_about(atlas), "N"};
      play.join(1);
      ASSERT_EQ(play.seat(1, "consent", {{"accept", true}, {"version", play.study().group().consent_version}}), "");
      ASSERT_EQ(play.seat(1, "checked"), "");
      for (StartIndex start{0}; start.value() < atlas->num_states(); ++start) {
        const auto choice = other_choice(*atlas, start);
        const auto other = atlas->deviation_counts(start, choice);
        const auto judged = judge_path(domain, atlas->feature_counts(start), other);
        const double factor = made.factors[atlas->id(start).start.value()];
        if (start.value() >= kClear) {
          EXPECT_EQ(judged.is_right, factor <= 1.0) << factor;
        }
        EXPECT_FALSE(judged.is_better);
        EXPECT_EQ(judged.regret == 0.0, judged.is_right);
        EXPECT_EQ(grade_answer(*atlas, start, other),
                  (Grade{judged.is_right ? 1.0 : 0.0, judged.is_right ? 0.0 : judged.raw_regret}));
        const auto action = domain.mdp(MdpIndex{0}).choices(atlas->id(start).start)[choice].action;
        ASSERT_EQ(
            play.seat(1, "screen", {{"test", start.value()}, {"actions", Json::array({action.value()})}, {"ms", 5}}),
            "");
        EXPECT_EQ(screened(play), judged.is_right) << factor;
      }
      TeachingCache cache{atlas};
      expect_session_agrees(cache, random.split("answers"));
      expect_curriculum_agrees(cache);
    }
  }
}

TEST(Judge, IsTheSameForTestsExamsLessonsAndTablesOfExactDomains) {
  for (const std::string name : {"item-delivery", "two-goals"}) {
    SCOPED_TRACE(name);
    const auto atlas = testing::atlas_of(name);
    TeachingCache cache{atlas};
    ASSERT_TRUE(atlas->find_tables());
    expect_session_agrees(cache, RandomStream{36}.split(name));
    expect_curriculum_agrees(cache);
    const GradeTable table{*atlas};
    RandomStream random = RandomStream{37}.split(name);
    for (int i = 0; i < 3000; ++i) {
      const PolicyCellIndex cell{uniform_index(atlas->tables().cells().size(), random)};
      const StartIndex start{uniform_index(atlas->num_states(), random)};
      const auto answer = atlas->tables().answer(start, cell);
      const bool is_right = answer && judge_path(atlas->domain(), atlas->feature_counts(start), *answer).is_right;
      EXPECT_EQ(table.is_right(cell, atlas->tables().hull(start)), is_right);
      EXPECT_EQ(grade_answer(*atlas, start, answer).share_right, is_right ? 1.0 : 0.0);
    }
  }
}

}  // namespace
}  // namespace kith
