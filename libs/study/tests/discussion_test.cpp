// Groups that talk, in study files and in tables.

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "item_delivery.hpp"
#include "kith/study/study_file.hpp"
#include "kith/study/tables.hpp"
#include "kith/study/team_run.hpp"
#include "study_texts.hpp"

namespace kith {
namespace {

StudyReading talking_study(const std::string& group) {
  const auto text = R"(schema = "kith.study/1"
id = "talk"
domain = "item-delivery"
seed = 3
replicates = 1
[design]
strategies = ["common"]
compositions = ["NNP"]
)" + testing::kPaperLearners +
                    R"([teacher]
particles = 120
counterfactuals = 4
[stop]
max_periods = 3
)" + group;
  return parse_study(text, "talk.toml");
}

std::map<std::string, std::string> tables_with(const Study& study) {
  TeachingCache cache{testing::item_delivery()};
  TeamAddress address;
  address.composition = "NNP";
  const std::vector<TeamRecord> teams{run_team(testing::item_delivery(), cache, study.variants.front(), address)};
  std::map<std::string, std::string> tables;
  write_study_tables(study, teams,
                     [&](std::string_view file, std::string_view piece) { tables[std::string{file}].append(piece); });
  return tables;
}

TEST(StudiesThatTalk, SayHowAndAreReadAgain) {
  const auto reading = talking_study("[group.discussion]\nmodel = \"degroot\"\nopenness = 0.25\n");
  ASSERT_TRUE(reading.study) << to_text(reading.diagnostics.front());
  const auto& discussion = reading.study->variants.front().group.discussion;
  EXPECT_EQ(discussion.choice.model->name, "degroot");
  EXPECT_EQ(discussion.choice.values.real("openness"), 0.25);
  // Also where what is said about live sessions is left out.
  for (const auto group : {GroupText::kWritten, GroupText::kLeftOut}) {
    const auto again = parse_study(to_toml(*reading.study, *reading.domain, group), "again.toml");
    ASSERT_TRUE(again.study) << to_text(again.diagnostics.front());
    EXPECT_EQ(again.study->variants.front().group.discussion, discussion);
  }
  const auto none = talking_study("[group.discussion]\nmodel = \"none\"\n");
  EXPECT_EQ(to_toml(*none.study, *none.domain), to_toml(*talking_study("").study, *none.domain));
}

TEST(StudiesThatTalk, NameWhatIsWrong) {
  for (const char* group : {"model = \"shouting\"", "model = \"degroot\"\nopenness = 1.5",
                            "model = \"majority\"\nopenness = 0.5", "openness = 0.5"}) {
    const auto reading = talking_study("[group.discussion]\n" + std::string{group} + "\n");
    EXPECT_FALSE(reading.study) << group;
    ASSERT_FALSE(reading.diagnostics.empty());
    EXPECT_NE(to_text(reading.diagnostics.front()).find("talk.toml:"), std::string::npos);
  }
}

TEST(StudiesThatTalk, HaveATableOfTheirOwnAndNoOtherColumns) {
  const auto talks = talking_study("[group.discussion]\nmodel = \"truth-wins\"\nconvinces = 1.0\n");
  const auto silent = talking_study("");
  const auto with = tables_with(*talks.study), without = tables_with(*silent.study);
  EXPECT_EQ(without.count("discussions.csv"), 0u);
  ASSERT_EQ(with.count("discussions.csv"), 1u);
  EXPECT_EQ(with.size(), without.size() + 1);
  for (const auto& [file, text] : without) {
    EXPECT_EQ(with.at(file).substr(0, with.at(file).find('\n')), text.substr(0, text.find('\n'))) << file;
  }
  EXPECT_NE(with.at("discussions.csv").find("true"), std::string::npos);
}

}  // namespace
}  // namespace kith
