#include "kith/analysis/findings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kith/files/atomic_file.hpp"
#include "small_study.hpp"

namespace kith {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::small_study;

constexpr const char* kFindings = R"(schema = "kith.targets/1"
[[target]]
quantity = "periods"
[[parameter]]
name = "scale"
[[finding]]
effect = "periods: group - baseline"
significant = true
)";

FindingsReading read_with(const std::string& old, const std::string& replacement) {
  std::string text = kFindings;
  const auto at = text.find(old);
  if (at == std::string::npos) throw std::logic_error{"the file does not contain " + old};
  return parse_findings(text.replace(at, old.size(), replacement), "targets.toml",
                        small_study({}).study->variants.front());
}

TEST(Findings, AreReadBesideWhatCalibrationReads) {
  const auto reading = read_with("true", "true\nf = 4.67\ndf = [3, 224]\nalpha = 0.01");
  ASSERT_TRUE(reading.findings) << reading.diagnostics.size();
  ASSERT_EQ(reading.findings->size(), 1u);
  const auto& finding = reading.findings->front();
  EXPECT_EQ(to_string(finding.effect), "periods: group - baseline");
  EXPECT_TRUE(finding.significant);
  EXPECT_EQ(finding.alpha, 0.01);
  EXPECT_EQ(finding.f, 4.67);
  EXPECT_EQ(finding.df1, 3.0);
  EXPECT_EQ(finding.df2, 224.0);
}

TEST(Findings, AreRefusedWithTheirPlace) {
  const std::vector<std::tuple<std::string, std::string, std::string>> wrong{
      {"kith.targets/1", "kith.targets/9", "E0106"},
      {"group - baseline", "group - nobody", "E0809"},
      {"true", "true\nf = 4.0", "E0810"},
      {"true", "true\nf = 1e7\ndf = [3, 224]", "E0110"},
      {"true", "true\nf = 4.0\ndf = [9223372036854775807, 224]", "E0110"},
      {"true", "true\nf = 4.0\ndf = [3, 1e10]", "E0110"}};
  for (const auto& [old, replacement, id] : wrong) {
    const auto reading = read_with(old, replacement);
    EXPECT_FALSE(reading.findings) << replacement;
    ASSERT_FALSE(reading.diagnostics.empty()) << replacement;
    EXPECT_EQ(reading.diagnostics.front().id, id) << replacement;
    EXPECT_GT(reading.diagnostics.front().line, 0u) << replacement;
  }
  EXPECT_TRUE(read_with("true", "true\nf = 1e6\ndf = [1e6, 1e9]").findings);
}

TEST(Findings, OfThePaperAreGood) {
  const auto text = read_file(std::filesystem::path{KITH_SOURCE_DIR} / "studies" / "paper-targets.toml");
  const auto reading = parse_findings(text, "paper-targets.toml", load_study("paper").study->variants.front());
  ASSERT_TRUE(reading.findings);
  EXPECT_EQ(reading.findings->size(), 13u);
}

TEST(Effect, IsWrittenAsItIsRead) {
  const auto paper = *load_study("paper").study;
  for (const auto* text :
       {"periods: strategy", "knowledge: composition", "knowledge: strategy x composition", "area_sr: strategy in NNP",
        "periods: strategy eta2 = 0.02", "knowledge: baseline - group/NNN", "completed: joint - baseline = -0.5"}) {
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
      {"periods: group - joint", "joint is on both sides; list the others"},
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

}  // namespace
}  // namespace kith
