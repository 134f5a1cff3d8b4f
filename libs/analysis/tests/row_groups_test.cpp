#include "row_groups.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kith {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using Intercepts = std::vector<std::vector<std::string>>;

// Teams of three, each member asked twice.
std::string two_answers_each() {
  std::string text = "team,member,strategy,y\n";
  for (int team = 1; team <= 6; ++team) {
    for (int member = 1; member <= 3; ++member) {
      for (int answer = 0; answer < 2; ++answer)
        text += std::to_string(team) + "," + std::to_string(member) + (team % 2 == 0 ? ",a," : ",b,") +
                std::to_string(team + answer) + "\n";
    }
  }
  return text;
}

TEST(IdentifierNames, AreWordsForWhoARowIsAbout) {
  for (const auto* name : {"team", "Team", "participant_id", "participantID", "personId", "student", "id", "ID",
                           "study.subject", "teamid", "my group", "work group", "group"})
    EXPECT_TRUE(is_identifier_name(name)) << name;
  for (const auto* name : {"valid", "covid", "identity", "team_size", "grouping", "period", "", "1", "paid", "grid",
                           "age group", "treatmentGroup"})
    EXPECT_FALSE(is_identifier_name(name)) << name;
}

TEST(RowGroups, AreThoseOfIdentifiersThatRepeat) {
  const auto rows = Dataset::parse("id,team,y\n1,1,1\n2,1,2\n3,2,3\n4,3,4\n5,4,5\n6,5,6\n", "t.csv");
  EXPECT_EQ(find_row_groups(rows, {"y"}).intercepts, (Intercepts{{"team"}}));
  EXPECT_THAT(find_row_groups(rows, {"y", "team"}).intercepts, IsEmpty());  // a factor of the model
}

TEST(RowGroups, AreMembersWithinTheirTeamWhereEveryTeamNumbersThemAnew) {
  const auto rows = Dataset::parse(two_answers_each(), "t.csv");
  const auto groups = find_row_groups(rows, {"y", "strategy"});
  EXPECT_EQ(groups.intercepts, (Intercepts{{"team"}, {"team", "member"}}));
  EXPECT_EQ(intercepts_text(groups.intercepts), "(1|team) + (1|team:member)");
  EXPECT_EQ(row_factor(rows, {"team", "member"}).levels.size(), 18u);
}

TEST(RowGroups, AreOneForTwoNamesOfTheSame) {
  const auto rows = Dataset::parse("team,team_id,y\na,1,1\na,1,2\nb,2,3\nb,2,4\nc,3,5\nd,4,6\ne,5,6\n", "t.csv");
  EXPECT_EQ(find_row_groups(rows, {"y"}).intercepts, (Intercepts{{"team"}}));
}

TEST(RowGroups, CrossWherePeopleAreInSeveralTeams) {
  std::string text = "team,person,y\n";
  for (int i = 0; i < 40; ++i)
    text += std::to_string(i / 8) + ",p" + std::to_string(i * 7 % 20) + "," + std::to_string(i) + "\n";
  EXPECT_EQ(find_row_groups(Dataset::parse(text, "t.csv"), {"y"}).intercepts, (Intercepts{{"team"}, {"person"}}));
}

// kith's own tables: the address of the random numbers says who was taught, else composition and replicate do.
TEST(RowGroups, AreTheSamePeopleUnderSeveralStrategies) {
  std::string teams = "strategy,composition,replicate,team,seed_address,y\n";
  std::string learners = "strategy,composition,replicate,team,member,y\n";
  for (int team = 0; team < 12; ++team) {
    const std::string who = (team % 2 == 0 ? "NNN," : "PPP,") + std::to_string(team / 2 % 3);
    const std::string start = (team < 6 ? "common," : "joint,") + who + "," + std::to_string(team);
    teams += start + ",7/" + who + "," + std::to_string(team * 5 % 7) + "\n";
    for (int member = 1; member <= 2; ++member) learners += start + "," + std::to_string(member) + ",0.5\n";
  }
  for (std::size_t at = teams.find("7/NNN,"); at != std::string::npos; at = teams.find("7/NNN,")) teams[at + 5] = '/';
  for (std::size_t at = teams.find("7/PPP,"); at != std::string::npos; at = teams.find("7/PPP,")) teams[at + 5] = '/';
  EXPECT_EQ(find_row_groups(Dataset::parse(teams, "t.csv"), {"y", "strategy", "composition"}).intercepts,
            (Intercepts{{"seed_address"}}));
  const auto rows = Dataset::parse(learners, "t.csv");
  EXPECT_EQ(find_row_groups(rows, {"y", "strategy"}).intercepts,
            (Intercepts{{"team"}, {"composition", "replicate"}, {"composition", "replicate", "member"}}));
  EXPECT_EQ(find_row_groups(rows, {"y", "replicate"}).intercepts, (Intercepts{{"team"}}));
}

// A column "group" is often the condition, not a group of people.
TEST(RowGroups, AreNotMadeOfAFewValuesUnlessSomebodySaysSo) {
  auto rows = Dataset::parse("group,y\na,1\na,2\nb,3\nb,4\n", "t.csv");
  const auto guessed = find_row_groups(rows, {"y"});
  EXPECT_THAT(guessed.intercepts, IsEmpty());
  EXPECT_THAT(guessed.notes,
              ElementsAre(HasSubstr("column 'group' is named like an identifier but has only 2 values")));
  rows.set_kind("group", ColumnKind::kIdentifier);
  EXPECT_EQ(find_row_groups(rows, {"y"}).intercepts, (Intercepts{{"group"}}));
}

TEST(RowGroups, TakeRowsWithoutAnIdentifierForGroupsOfTheirOwn) {
  const auto rows = Dataset::parse("team,y\n1,1\n1,2\n2,3\n2,3\n3,5\n,4\n,5\n4,3\n5,2\n", "t.csv");
  EXPECT_EQ(row_factor(rows, {"team"}).levels.size(), 7u);
  EXPECT_EQ(find_row_groups(rows, {"y"}).intercepts, (Intercepts{{"team"}}));
}

TEST(RowGroups, FollowTheCodebook) {
  auto rows = Dataset::parse("school,team,y\n1,1,1\n1,2,2\n2,3,3\n2,1,3\n3,2,5\n4,3,1\n", "t.csv");
  rows.describe({.file = "t.csv",
                 .columns = {{.name = "school", .kind = ColumnKind::kIdentifier},
                             {.name = "team", .kind = ColumnKind::kNumber},
                             {.name = "absent", .kind = ColumnKind::kCount}}});
  EXPECT_EQ(find_row_groups(rows, {"y"}).intercepts, (Intercepts{{"school"}}));
}

}  // namespace
}  // namespace kith
