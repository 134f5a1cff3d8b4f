// Strategies with tables of their own and beliefs about teams in study files.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "kith/study/study.hpp"
#include "kith/study/study_file.hpp"
#include "kith/study/tables.hpp"
#include "kith/teaching/demonstration_selection.hpp"
#include "kith/teaching/learner_bank.hpp"

namespace kith {
namespace {

std::string study(const std::string& strategies, const std::string& rest) {
  return "schema = \"kith.study/1\"\nid = \"kinds\"\ndomain = \"colored-tiles\"\nseed = 3\nreplicates = 2\n[design]\n"
         "strategies = [" +
         strategies +
         "]\ncompositions = [\"NN\"]\n[learner.N]\nability = { mean = 0.75, sd = 0.02 }\nconfirm_gain = { value = 0.0 "
         "}\n"
         "correct_gain = { value = 0.02 }\nparticles = 100\n[stop]\nmax_periods = 4\n" +
         rest;
}

std::vector<std::string> ids_in(const StudyReading& reading) {
  std::vector<std::string> result;
  for (const auto& diagnostic : reading.diagnostics) result.push_back(diagnostic.id);
  return result;
}

// Teaches for one belief in odd periods and for the other in even ones, or the other way round.
class TakesTurns : public Strategy {
 public:
  explicit TakesTurns(bool common_first) : common_{common_first} {}
  [[nodiscard]] std::unique_ptr<Strategy> clone() const override { return std::make_unique<TakesTurns>(*this); }
  [[nodiscard]] UnitProposal propose(const TeachingView& view, UnitSelector& select, RandomStream random) override {
    const std::string rule = common_ ? "common" : "joint";
    common_ = !common_;
    return {SourceBelief::of_team(rule), select.for_belief(view.belief.aggregate(rule), random)};
  }

 private:
  bool common_;
};

std::vector<StrategyKind> with_turns() {
  static const std::array parameters{
      Parameter{.name = "common_first", .default_value = true, .description = "whether the common belief comes first"}};
  std::vector<StrategyKind> kinds{strategy_kinds().begin(), strategy_kinds().end()};
  kinds.push_back({"turns", "teach for what all members know and for what one knows in turn",
                   [](const ParameterValues&) {
                     return TeamBeliefNeeds{.members = false, .rules = {"common", "joint"}};
                   },
                   [](const ParameterValues& values) -> std::unique_ptr<Strategy> {
                     return std::make_unique<TakesTurns>(values.boolean("common_first"));
                   },
                   parameters});
  return kinds;
}

TEST(StudyKinds, StrategiesOfOnesOwnHaveParametersAndState) {
  const auto kinds = with_turns();
  const auto text = study("\"turns\", \"late\"", "[strategy.late]\nkind = \"turns\"\ncommon_first = false\n");
  const auto reading = parse_study(text, "study.toml", {.kinds = {.strategies = kinds}});
  ASSERT_TRUE(reading.study) << reading.diagnostics.front().message;
  const auto& spec = reading.study->variants.front();
  ASSERT_EQ(spec.strategies.size(), 2u);
  EXPECT_EQ(spec.strategies[1].name, "late");
  EXPECT_FALSE(spec.strategies[1].parameters.boolean("common_first"));
  const Atlas atlas{*reading.domain};
  const auto teams = run_teams(atlas, *reading.study, team_addresses(*reading.study)).teams;
  for (const auto& team : teams) {
    for (const auto& period : team.period_records) {
      const bool common = (period.period % 2 == 1) == (team.address.strategy == "turns");
      EXPECT_EQ(period.source, common ? "common" : "joint") << team.address.strategy << ' ' << period.period;
    }
  }
  // Frozen and read again it is the same study.
  const auto again =
      parse_study(to_toml(*reading.study, *reading.domain), "again.toml", {.kinds = {.strategies = kinds}});
  ASSERT_TRUE(again.study) << again.diagnostics.front().message;
  EXPECT_EQ(again.study->variants.front().strategies, spec.strategies);
  EXPECT_FALSE(parse_study(text, "study.toml").study) << "only who asks for it gets it";
}

TEST(StudyKinds, SayWhatIsWrongWithStrategies) {
  EXPECT_EQ(ids_in(parse_study(study("\"mine\"", ""), "t")), (std::vector<std::string>{"E0402"}));
  EXPECT_EQ(ids_in(parse_study(study("\"mine\"", "[strategy.mine]\nkind = \"joint\"\n"), "t")),
            std::vector<std::string>{});
  EXPECT_EQ(ids_in(parse_study(study("\"alone\"", "[strategy.alone]\nkind = \"baseline\"\n"), "t")),
            (std::vector<std::string>{"E0418"}));
  EXPECT_EQ(ids_in(parse_study(study("\"joint\"", "[strategy.mine]\nkind = \"joint\"\n"), "t")),
            (std::vector<std::string>{"W0404"}));
  const auto renamed = parse_study(study("\"joint\", \"adaptive\", \"plan\"", ""), "t");
  EXPECT_EQ(ids_in(renamed), (std::vector<std::string>{"W0408", "E0403"}));
  const auto planned = parse_study(study("\"adaptive\"", "[strategy.plan]\nmin_gain = 0.1\ncapacity = 2\n"), "t");
  EXPECT_EQ(ids_in(planned), (std::vector<std::string>{"W0408", "W0407"}));
  ASSERT_TRUE(planned.study);
  EXPECT_EQ(planned.study->variants.front().strategies.front().parameters.count("capacity"), 2);
  const auto unknown_key = parse_study(study("\"joint\"", "[strategy.joint]\ndepth = 3\n"), "t");
  EXPECT_FALSE(unknown_key.study);
  const auto no_kind = parse_study(study("\"mine\"", "[strategy.mine]\n"), "t");
  EXPECT_FALSE(no_kind.study);
}

TEST(StudyKinds, KeepTheBeliefsThatAreAskedFor) {
  const auto one = parse_study(study("\"joint\"", "[teacher]\nbeliefs = [\"joint\"]\n"), "t");
  ASSERT_TRUE(one.study) << one.diagnostics.front().message;
  const Atlas atlas{*one.domain};
  const auto teams = run_teams(atlas, *one.study, team_addresses(*one.study)).teams;
  std::string periods;
  write_study_tables(*one.study, teams, [&](std::string_view file, std::string_view piece) {
    if (file == "periods.csv") periods += piece;
  });
  EXPECT_NE(periods.find("gain,p_bec_joint\n"), std::string::npos) << periods.substr(0, 300);
  EXPECT_EQ(ids_in(parse_study(study("\"common\"", "[teacher]\nbeliefs = [\"joint\"]\n"), "t")),
            (std::vector<std::string>{"E0419"}));
  EXPECT_EQ(ids_in(parse_study(study("\"joint\"", "[teacher]\nbeliefs = [\"joint\", \"jiont\"]\n"), "t")),
            (std::vector<std::string>{"E0419"}));
  EXPECT_EQ(ids_in(parse_study(study("\"joint\"", "[teacher]\nbeliefs = [\"joint\", \"joint\"]\n"), "t")),
            (std::vector<std::string>{"E0403"}));
}

TEST(StudyKinds, RulesOfOnesOwnHaveColumns) {
  std::vector<AggregationRule> rules{aggregation_rules().begin(), aggregation_rules().end()};
  rules.push_back({"first", "what one member knows",
                   [](ParticleBelief& belief, const TeamResponses& responses, RandomStream random) {
                     const auto least = std::min_element(responses.addresses.begin(), responses.addresses.end());
                     const auto i = static_cast<std::size_t>(least - responses.addresses.begin());
                     belief.observe(responses.lists[i], responses.likelihood, random);
                     return std::vector<std::size_t>{};
                   }});
  const auto reading = parse_study(study("\"joint\"", "[teacher]\nbeliefs = [\"common\", \"joint\", \"first\"]\n"), "t",
                                   {.kinds = {.rules = rules}});
  ASSERT_TRUE(reading.study) << reading.diagnostics.front().message;
  const Atlas atlas{*reading.domain};
  const auto teams = run_teams(atlas, *reading.study, team_addresses(*reading.study)).teams;
  ASSERT_FALSE(teams[0].period_records.empty());
  EXPECT_EQ(teams[0].period_records[0].p_bec.size(), 3u);
  std::string periods;
  write_study_tables(*reading.study, teams, [&](std::string_view file, std::string_view piece) {
    if (file == "periods.csv") periods += piece;
  });
  EXPECT_NE(periods.find("gain,p_bec_common,p_bec_joint,p_bec_first\n"), std::string::npos);
}

// What kinds of learners the teacher thinks of is read, written and read again.
TEST(StudyKindsTest, NameKindsOfLearners) {
  const std::string asks = "[teacher]\nhypotheses = \"kinds\"\n";
  const auto reading = parse_study(study("\"joint\"", asks + "kinds = [\"bayesian\", \"decaying\"]\n"), "s.toml");
  ASSERT_TRUE(reading.study);
  const auto& kinds = reading.study->variants.front().teaching.kinds;
  EXPECT_EQ(kinds_of(kinds).size(), 2u);
  EXPECT_EQ(kinds_of(kinds).back().kind, "decaying");
  const auto again = parse_study(to_toml(*reading.study, *reading.domain), "again.toml");
  ASSERT_TRUE(again.study);
  EXPECT_EQ(kinds_of(again.study->variants.front().teaching.kinds), kinds_of(kinds));

  EXPECT_EQ(kinds_of(parse_study(study("\"joint\"", asks), "s.toml").study->variants.front().teaching.kinds).size(),
            6u);
  EXPECT_EQ(ids_in(parse_study(study("\"joint\"", asks + "kinds = [\"baysian\"]\n"), "s.toml")),
            (std::vector<std::string>{"E0424"}));
  EXPECT_EQ(ids_in(parse_study(study("\"joint\"", asks + "kinds = []\n"), "s.toml")),
            (std::vector<std::string>{"E0424"}));
  EXPECT_EQ(ids_in(parse_study(study("\"joint\"", "[teacher]\nkinds = [\"bayesian\"]\n"), "s.toml")),
            (std::vector<std::string>{"W0405"}));
}

}  // namespace
}  // namespace kith
