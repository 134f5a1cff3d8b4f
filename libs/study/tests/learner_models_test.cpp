// Every registered learner model in study files and documents.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "kith/belief/aggregation.hpp"
#include "kith/study/study_file.hpp"
#include "kith/study/tables.hpp"
#include "kith/teaching/strategy.hpp"

namespace kith {
namespace {

class LearnerModelFiles : public ::testing::TestWithParam<const LearnerModel*> {};

// A value other than the default, in the range; the default if there is none near.
ParameterValue another_value(const Parameter& parameter) {
  const auto& old = parameter.default_value;
  if (const auto* real = std::get_if<double>(&old)) return *real + (parameter.max - *real) / 128.0;
  if (const auto* count = std::get_if<std::int64_t>(&old)) {
    return *count > static_cast<std::int64_t>(parameter.min) ? *count - 1 : *count + 1;
  }
  if (const auto* boolean = std::get_if<bool>(&old)) return !*boolean;
  if (const auto* word = std::get_if<std::string>(&old)) {
    return parameter.words.empty() ? *word + "x" : std::string{parameter.words.back()};
  }
  return Spread{.half_normal = {}, .value = std::get<Spread>(old).half_normal.value_or(parameter.max / 64.0) / 4.0};
}

Study study_of(const LearnerModel& model, const ParameterValues& values) {
  StudySpec spec;
  spec.id = "one";
  spec.strategies = {strategy_named("common")};
  spec.compositions = {"XX"};
  spec.replicates = 2;
  spec.learner_types = {{.letter = 'X', .label = "x", .model = &model, .parameters = values}};
  return {{spec}};
}

TEST_P(LearnerModelFiles, GiveEveryParameterBack) {
  const auto& model = *GetParam();
  const auto domain = *load_study("quick").domain;
  ParameterValues defaults{model.parameters};
  auto others = defaults;
  for (const auto& parameter : model.parameters) others.set(parameter.name, another_value(parameter));
  for (const auto& values : {defaults, others}) {
    const auto text = to_toml(study_of(model, values), domain);
    const auto reading = parse_study(text, "study.toml");
    ASSERT_TRUE(reading.study) << (reading.diagnostics.empty() ? "" : reading.diagnostics.front().message) << '\n'
                               << text;
    const auto& type = reading.study->variants.front().learner_types.front();
    EXPECT_EQ(type.model, &model);
    EXPECT_EQ(type.parameters, values) << text;
    EXPECT_EQ(to_toml(*reading.study, domain), text);
  }
}

TEST_P(LearnerModelFiles, RefuseParametersOutOfRangeWithNameAndRange) {
  const auto& model = *GetParam();
  const auto domain = *load_study("quick").domain;
  const auto text = to_toml(study_of(model, ParameterValues{model.parameters}), domain);
  for (const auto& parameter : model.parameters) {
    if (!std::holds_alternative<double>(parameter.default_value)) continue;
    const auto setting = "learner.X." + std::string{parameter.name} + "=" + to_string(parameter.max + 1.0);
    const auto reading = parse_study(text, "study.toml", {.overrides = {setting}});
    ASSERT_FALSE(reading.diagnostics.empty()) << setting;
    EXPECT_EQ(reading.diagnostics.front().id, "E0110") << setting;
    const auto key = parameter.name.substr(parameter.name.rfind('.') + 1);
    EXPECT_NE(reading.diagnostics.front().message.find(key), std::string::npos) << setting;
  }
}

INSTANTIATE_TEST_SUITE_P(AllModels, LearnerModelFiles,
                         ::testing::ValuesIn(learner_models().begin(), learner_models().end()), [](const auto& one) {
                           std::string name{one.param->kind};
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

// --- strategies and rules of aggregation -------------------------------------------

std::string study_page() {
  std::ifstream file{std::string{KITH_SOURCE_DIR} + "/docs/study-files.md"};
  return {std::istreambuf_iterator<char>{file}, {}};
}

// Their parameters are listed by `kith explain`.
TEST(StrategyKinds, AreInTheDocuments) {
  std::string table = "| kind | what it does |\n|---|---|\n";
  for (const auto& kind : strategy_kinds()) {
    table += "| `" + std::string{kind.name} + "` | " + std::string{kind.description} + " |\n";
  }
  EXPECT_NE(study_page().find(table + "\n"), std::string::npos) << "docs/study-files.md must contain:\n\n" << table;
}

TEST(AggregationRules, AreInTheDocuments) {
  std::string table = "| rule | the belief about ... |\n|---|---|\n";
  for (const auto& rule : aggregation_rules()) {
    table += "| `" + std::string{rule.name} + "` | " + std::string{rule.description} + " |\n";
  }
  EXPECT_NE(study_page().find(table + "\n"), std::string::npos) << "docs/study-files.md must contain:\n\n" << table;
}

// --- a model of one's own --------------------------------------------------------

// Knows everything and has nothing but a name tag.
class Oracle final : public Learner {
 public:
  [[nodiscard]] std::unique_ptr<Learner> clone() const override { return std::make_unique<Oracle>(*this); }
  void begin_component() override {}
  void watch(std::span<const HalfSpace>, std::size_t) override {}
  [[nodiscard]] Response answer(Behaviours& behaviours, std::span<const StartIndex> tests, std::size_t) const override {
    Response response;
    for (const auto test : tests) response.answers.emplace_back(behaviours.atlas().feature_counts(test));
    return response;
  }
  void hear_feedback(bool, std::span<const HalfSpace>, std::size_t) override {}
  [[nodiscard]] std::optional<double> likelihood(const AnswerEvidence&) const override { return 1.0; }
  [[nodiscard]] double mass_in(std::span<const HalfSpace>) const override { return 1.0; }
};

constexpr std::array kOracleTraits{LearnerTrait{"tag", "Number on the name tag."}};

const LearnerModel kOracle{.kind = "oracle",
                           .description = "knows everything",
                           .parameters = {},
                           .traits = kOracleTraits,
                           .draw = [](const ParameterValues&, RandomStream) { return std::vector<double>{7.0}; },
                           .make = [](const ParameterValues&, std::span<const double>, const LearnerStart&,
                                      RandomStream) -> std::unique_ptr<Learner> { return std::make_unique<Oracle>(); }};

constexpr const char* kMixed = R"(schema = "kith.study/1"
id = "mixed"
domain = "item-delivery"
seed = 7
replicates = 1
[design]
strategies = ["joint"]
compositions = ["NX"]
[learner.N]
ability = { mean = 0.7, sd = 0.03 }
confirm_gain = { half_normal = 0.03 }
correct_gain = { value = 0.05 }
particles = 100
[learner.X]
kind = "oracle"
[teacher]
particles = 100
[record]
level = "particles"
)";

TEST(OwnLearnerModels, AreTaughtBesideBuiltInOnesAndHaveColumnsOfTheirOwn) {
  const std::array models{&bayesian_model(), &kOracle};
  const auto reading = parse_study(kMixed, "study.toml", {.kinds = {.learners = models}});
  ASSERT_TRUE(reading.study) << reading.diagnostics.front().message;
  const Atlas atlas{*reading.domain};
  const auto teams = run_teams(atlas, *reading.study, team_addresses(*reading.study)).teams;
  ASSERT_EQ(teams.size(), 1u);
  EXPECT_EQ(teams[0].learners[1].traits, (std::vector{7.0}));
  EXPECT_EQ(teams[0].learners[1].p_bec, 1.0);
  EXPECT_EQ(teams[0].learners[1].correct, teams[0].learners[1].tests);
  std::string learners, progress;
  write_study_tables(*reading.study, teams, [&](std::string_view file, std::string_view piece) {
    if (file == "learners.csv") learners += piece;
    if (file == "progress.csv") progress += piece;
  });
  EXPECT_NE(learners.find("member,type,ability,confirm_gain,correct_gain,tag,p_bec"), std::string::npos) << learners;
  EXPECT_NE(learners.find(",2,X,,,,7,1,"), std::string::npos) << learners;
  EXPECT_NE(progress.find(",2,X,,1,"), std::string::npos) << progress;
  EXPECT_FALSE(parse_study(kMixed, "study.toml").study) << "only who asks for it gets it";
}

}  // namespace
}  // namespace kith
