#include "kith/study_design/targets.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "error_ids.hpp"
#include "small_study.hpp"

namespace kith {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::small_study;

constexpr const char* kTargets = R"(schema = "kith.targets/1"
[[target]]
quantity = "periods"
teams = "group"
value = 5.0
tolerance = 0.5
[[target]]
quantity = "knowledge"
statistic = "sd"
teams = "baseline/NN"
value = 0.1
within_factor = 2.0
[[parameter]]
name = "scale"
keys = ["learner.*.ability_scale"]
min = 0.5
max = 2.0
scale = "log"
[[finding]]
effect = "periods: group - baseline"
significant = true
)";

std::string with(const std::string& old, const std::string& replacement) {
  std::string text = kTargets;
  const auto at = text.find(old);
  if (at == std::string::npos) throw std::logic_error{"the file does not contain " + old};
  return text.replace(at, old.size(), replacement);
}

std::vector<std::string> ids(const std::string& text) {
  std::vector<std::string> result;
  for (const auto& diagnostic : parse_targets(text, "targets.toml", small_study).diagnostics)
    result.push_back(diagnostic.id);
  return result;
}

const std::vector<std::pair<std::string, std::string>>& broken_files() {
  static const std::vector<std::pair<std::string, std::string>> kFiles{
      {"E0106", with("kith.targets/1", "kith.targets/9")},
      {"E0801", with("\"baseline/NN\"", "\"baseline/XX\"")},
      {"E0802", with("tolerance = 0.5", "")},
      {"E0803", with("value = 0.1", "value = -0.1")},
      {"E0804", with("[[parameter]]",
                     "[[target]]\nquantity = \"periods\"\nteams = \"group\"\nvalue = 1\ntolerance = 1\n[[parameter]]")},
      {"E0805", with("max = 2.0", "max = 0.5")},
      {"E0806", with("keys = [\"learner.*.ability_scale\"]", "keys = []")},
      {"E0807", with("keys = [\"learner.*.ability_scale\"]",
                     "keys = [\"learner.N.ability_scale\", \"learner.*.ability_scale\"]")},
      {"E0808", with("ability_scale\"]", "ability_scael\"]")},
      {"E0809", with("group - baseline", "group - nobody")},
      {"E0814", with("tolerance = 0.5", "tolerance = 0.5\nsd = 1.0")},
      {"E0814", with("tolerance = 0.5", "sd = 1.0\nn = 10\nstandard_error = 0.2\ntolerance = 1")},
      {"E0815", with("tolerance = 0.5", "tolerance = 0.5\ndf = [3, 224]")},
      {"E0810", with("significant = true", "significant = true\nf = 4.0")},
  };
  return kFiles;
}

TEST(TargetsFile, ReadsTargetsParametersAndFindings) {
  const auto reading = parse_targets(kTargets, "targets.toml", small_study);
  ASSERT_TRUE(reading.targets) << reading.diagnostics.size();
  const auto& set = *reading.targets;
  ASSERT_EQ(set.targets.size(), 2u);
  EXPECT_EQ(to_string(set.targets[0]), "periods of group, mean");
  EXPECT_EQ(to_string(set.targets[1]), "knowledge of baseline/NN, sd");
  EXPECT_EQ(set.targets[1].priority, 2u);  // by place, unless it says otherwise
  EXPECT_TRUE(set.targets[1].is_factor);
  ASSERT_EQ(set.parameters.size(), 1u);
  EXPECT_THAT(set.parameters[0].keys, ElementsAre("learner.N.ability_scale"));
  EXPECT_EQ(set.parameters[0].present, 1.0);
  EXPECT_THAT(overrides_of(set.parameters, {1.25}), ElementsAre("learner.N.ability_scale=1.25"));
  ASSERT_EQ(set.findings.size(), 1u);
  EXPECT_TRUE(set.findings[0].significant);
}

TEST(TargetsFile, SaysWhatIsWrongAndWhere) {
  for (const auto& [id, text] : broken_files()) EXPECT_THAT(ids(text), ElementsAre(id));
  const auto reading = parse_targets(with("\"baseline/NN\"", "\"baseline/XX\""), "targets.toml", small_study);
  const auto& diagnostic = reading.diagnostics.front();
  EXPECT_EQ(diagnostic.file, "targets.toml");
  EXPECT_EQ(diagnostic.line, 10u);
  EXPECT_EQ(diagnostic.column, 9u);
  EXPECT_THAT(diagnostic.hint, HasSubstr("known: group, baseline, common"));
}

TEST(TargetsFile, RefusesFiguresThatNobodyCanMean) {
  const std::vector<std::string> wrong{
      with("value = 5.0", "value = 1e10"),
      with("value = 5.0", "value = -1e300"),
      with("tolerance = 0.5", "tolerance = 1e10"),
      with("within_factor = 2.0", "within_factor = 1e10"),
      with("max = 2.0", "max = 1e300"),
      with("min = 0.5", "min = -9223372036854775807"),
      with("significant = true", "significant = true\nf = 1e7\ndf = [3, 224]"),
      with("significant = true", "significant = true\nf = 4.0\ndf = [9223372036854775807, 224]"),
      with("significant = true", "significant = true\nf = 4.0\ndf = [3, 1e10]"),
  };
  for (const auto& text : wrong) EXPECT_THAT(ids(text), ::testing::Contains("E0110")) << text;
  EXPECT_THAT(ids(with("significant = true", "significant = true\nf = 1e6\ndf = [1e6, 1e9]")), ElementsAre());
}

TEST(TargetsFile, RefusesRangesThatTheStudyRefuses) {
  const auto reading = parse_targets(with("max = 2.0", "max = 9.0"), "targets.toml", small_study);
  ASSERT_EQ(reading.diagnostics.size(), 1u);
  EXPECT_EQ(reading.diagnostics.front().id, "E0808");
}

TEST(TargetsFile, OfThePaperIsGood) {
  const auto text = testing::text_of(std::filesystem::path{KITH_SOURCE_DIR} / "studies" / "paper-targets.toml");
  const auto reading =
      parse_targets(text, "paper-targets.toml", [](const auto& overrides) { return load_study("paper", {overrides}); });
  ASSERT_TRUE(reading.targets);
  EXPECT_EQ(reading.targets->targets.size(), 10u);
  for (const auto& target : reading.targets->targets) EXPECT_TRUE(target.standard_error) << to_string(target);
  EXPECT_EQ(reading.targets->parameters.size(), 6u);
}

TEST(Effect, IsWrittenAsItIsRead) {
  const auto paper = *load_study("paper").study;
  for (const auto* text : {"periods: strategy", "knowledge: composition", "knowledge: strategy x composition",
                           "area_sr: strategy in NNP", "periods: strategy eta2 = 0.02",
                           "knowledge: individual-low - group/NNN", "completed: joint - baseline = -0.5"}) {
    const auto reading = parse_effect(text, paper.variants.front());
    ASSERT_TRUE(reading.effect) << text << ": " << reading.problem;
    EXPECT_EQ(to_string(*reading.effect), text);
  }
}

TEST(Effect, IsRefusedWithAReason) {
  const auto paper = *load_study("paper").study;
  const std::vector<std::pair<std::string, std::string>> refused{
      {"strategy", "names no quantity"},
      {"speed: strategy", "no quantity 'speed'"},
      {"periods: strategy in XXX", "no composition 'XXX'"},
      {"periods: joint - nobody", "the study has no teams 'nobody'"},
      {"periods: joint - joint", "different teams"},
      {"periods: joint - common eta2 = 0.1", "own unit"},
      {"periods: strategy = 0.1", "eta2"},
      {"periods: strategy eta2 = 1.5", "between 0 and 1"},
      {"periods: joint - common = 0", "must not be 0"},
      {"periods: joint - common = many", "no number"},
      {"periods: whatever it is", "not understood"}};
  for (const auto& [text, problem] : refused) {
    const auto reading = parse_effect(text, paper.variants.front());
    EXPECT_FALSE(reading.effect) << text;
    EXPECT_THAT(reading.problem, HasSubstr(problem));
  }
  EXPECT_THAT(parse_effect("periods: composition", small_study({}).study->variants.front()).problem,
              HasSubstr("fewer than two compositions"));
}

TEST(TargetsFile, ReadsStandardErrorsAndWhatTheyAreComputedFrom) {
  const auto read = [](const std::string& text) { return parse_targets(text, "targets.toml", small_study).targets; };
  const auto mean = read(with("tolerance = 0.5", "sd = 1.68\nn = 240"));
  ASSERT_TRUE(mean);
  EXPECT_DOUBLE_EQ(*mean->targets[0].standard_error, 1.68 / std::sqrt(240.0));
  EXPECT_DOUBLE_EQ(mean->targets[0].tolerance, 2.0 * 1.68 / std::sqrt(240.0));  // none wished: two standard errors
  const auto sd = read(with("within_factor = 2.0", "within_factor = 2.0\nn = 51"));
  ASSERT_TRUE(sd);
  EXPECT_DOUBLE_EQ(*sd->targets[1].standard_error, 0.1 / std::sqrt(100.0));
  EXPECT_DOUBLE_EQ(published_error(sd->targets[1]), 0.1);  // of the logarithm
  const auto given = read(with("tolerance = 0.5", "tolerance = 0.5\nstandard_error = 0.1"));
  ASSERT_TRUE(given);
  EXPECT_DOUBLE_EQ(published_error(given->targets[0]), 0.1);
  EXPECT_DOUBLE_EQ(published_error(given->targets[1]), std::log(2.0) / 2.0);  // without one, half a tolerance
}

TEST(TargetsFile, ReadsPublishedFs) {
  const auto paper = [](const auto& overrides) { return load_study("paper", {overrides}); };
  const std::string text =
      "schema = \"kith.targets/1\"\n[[target]]\nstatistic = \"F\"\neffect = \"periods: composition\"\n"
      "value = 4.67\ndf = [3, 224]\n";
  const auto reading = parse_targets(text, "targets.toml", paper);
  ASSERT_TRUE(reading.targets) << reading.diagnostics.front().message;
  const auto& target = reading.targets->targets.front();
  EXPECT_EQ(to_string(target), "F of periods: composition");
  // The standard deviation of the non-central F whose mean is the published value: computed by hand.
  EXPECT_NEAR(*target.standard_error, 2.4, 0.05);
  auto contrast = text;
  contrast.replace(contrast.find("periods: composition"), 20, "periods: joint - common");
  EXPECT_EQ(parse_targets(contrast, "targets.toml", paper).diagnostics.front().id, "E0815");
}

TEST(FMoments, AreThoseOfTheCentralFWithoutNonCentrality) {
  const auto moments = f_moments(3.0, 24.0, 0.0);
  EXPECT_DOUBLE_EQ(moments.mean, 24.0 / 22.0);
  EXPECT_NEAR(moments.sd, std::sqrt(2.0 * 24.0 * 24.0 * 25.0 / (3.0 * 22.0 * 22.0 * 20.0)), 1e-12);
}

TEST(Miss, IsCountedInTolerances) {
  const auto set = *parse_targets(kTargets, "targets.toml", small_study).targets;
  EXPECT_DOUBLE_EQ(miss(set.targets[0], 5.25), 0.5);
  EXPECT_DOUBLE_EQ(miss(set.targets[1], 0.2), 1.0);
  EXPECT_DOUBLE_EQ(miss(set.targets[1], 0.05), -1.0);
  EXPECT_TRUE(std::isfinite(miss(set.targets[1], 0.0)));
}

}  // namespace
}  // namespace kith
