// The parts of a report, each by itself.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <string>
#include <utility>
#include <vector>

#include "answers.hpp"
#include "bibliography.hpp"
#include "kith/geometry/outline.hpp"
#include "parameters.hpp"
#include "sections.hpp"

namespace kith::detail {
namespace {

using ::testing::ElementsAre;

constexpr auto kBibtex = R"(% a comment
@article{a2020,
  author  = {Doe, Jane Q. and Roe, R.},
  title   = {On {Things},
             and Others},
  journal = {A Journal},
  volume  = {3},
  number  = {2},
  pages   = {1--4},
  year    = {2020}
}

@misc{b1999,
  author = {Poe, Edgar Allan and Doe, Jane and Roe, R.},
  title  = {Notes},
  year   = {1999}
}
)";

TEST(Bibliography, WritesReferencesAsPeopleDo) {
  const auto references = parse_bibtex(kBibtex);
  ASSERT_EQ(references.size(), 2u);
  EXPECT_EQ(reference_text(references[0]),
            "Doe, J. Q., & Roe, R. (2020). On Things, and Others. A Journal, 3(2), 1-4.");
  EXPECT_EQ(reference_text(references[1]), "Poe, E. A., Doe, J., & Roe, R. (1999). Notes.");
  EXPECT_EQ(citation_text(references[0]), "Doe & Roe, 2020");
  EXPECT_EQ(citation_text(references[1]), "Poe et al., 1999");
  EXPECT_THAT(references[1].bibtex, ::testing::StartsWith("@misc{b1999,"));
  EXPECT_THAT(references[1].bibtex, ::testing::EndsWith("}"));
}

TEST(Bibliography, OfTextWithoutEntriesIsEmpty) {
  for (const auto* text : {"", "@", "@article{", "% only a comment"}) EXPECT_TRUE(parse_bibtex(text).empty()) << text;
}

TEST(Parameters, HaveMeaningsByKey) {
  EXPECT_EQ(meaning_of("study.replicates"), "teams per cell (strategy and composition)");
  EXPECT_EQ(meaning_of("learner.N.ability.sd"), "standard deviation of the initial ability");
  EXPECT_EQ(meaning_of("learner.Q.ability.sd"), meaning_of("learner.N.ability.sd"));
  EXPECT_TRUE(meaning_of("design.vary.teacher.process_noise").has_value());
  for (const auto* unknown : {"", "study", "study.replicates.x", "learner.N.ability", "design.vary"}) {
    EXPECT_FALSE(meaning_of(unknown).has_value()) << unknown;
  }
}

// Corners on the border, in order round the inside, no two of them half a turn apart.
void expect_outline(const Cone& cone) {
  const auto corners = outline(cone);
  ASSERT_GE(corners.size(), 3u);
  const auto inside = cone.interior_direction();
  const Eigen::Vector3d centre{static_cast<double>(inside[0]), static_cast<double>(inside[1]),
                               static_cast<double>(inside[2])};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto& next = corners[(i + 1) % corners.size()];
    EXPECT_NEAR(corners[i].norm(), 1.0, 1e-12);
    EXPECT_GT(corners[i].dot(next), -0.999);
    EXPECT_GT(corners[i].cross(next).dot(centre), 0.0);
    double margin = 1.0;
    for (const auto& facet : cone.facets()) margin = std::min(margin, facet.margin(corners[i]));
    EXPECT_NEAR(margin, 0.0, 1e-9);
  }
}

TEST(Outline, RunsCounterClockwiseAlongTheBorder) {
  const HalfSpace a{IntegerVector{1, 0, 0}}, b{IntegerVector{1, 2, 0}}, c{IntegerVector{0, 1, 3}};
  for (const auto& half_spaces : {std::vector{a}, std::vector{a, b}, std::vector{b, a}, std::vector{a, b, c},
                                  std::vector{a, b.opposite()}, std::vector{a.opposite(), b, c.opposite()}}) {
    expect_outline(Cone::intersection(half_spaces).value());
  }
}

TEST(Outline, OfTheWholeSphereIsEmpty) { EXPECT_TRUE(outline(Cone{}).empty()); }

TeamRecord team_of(std::size_t periods, double knowledge, std::size_t replicate = 1) {
  TeamRecord team;
  team.address.replicate = replicate;
  team.status = SessionStatus::kComplete;
  team.periods = periods;
  team.knowledge = knowledge;
  return team;
}

TEST(TellingTeams, AreOfDifferentStrategiesWherePossible) {
  ReportDesign design;
  RunData data;
  const auto add = [&](const std::string& strategy, std::size_t periods, double knowledge) {
    design.series.push_back({strategy, "", strategy, 0, {}});
    design.cells.push_back({design.series.size() - 1, "NP", 1});
    design.cell_of_team.push_back(design.cells.size() - 1);
    data.teams.push_back(team_of(periods, knowledge));
  };
  add("baseline", 30, 0.01);  // not taught together
  add("common", 9, 0.1);      // the lowest knowledge, and the slowest
  add("joint", 8, 0.5);       // the slowest of the others
  add("individual-low", 7, 0.6);
  add("individual-low", 2, 0.9);
  const auto teams = telling_teams(design, data);
  ASSERT_EQ(teams.size(), 3u);
  EXPECT_EQ(teams[0].team, 3u);
  EXPECT_THAT(teams[0].why, ::testing::StartsWith("typical"));
  EXPECT_EQ(teams[1].team, 2u);
  EXPECT_EQ(teams[1].why, "the slowest (8 periods) of the teams of other strategies");
  EXPECT_EQ(teams[2].team, 1u);
  EXPECT_EQ(teams[2].why, "the lowest final knowledge (0.10) of the teams taught together");
}

TEST(TellingTeams, AreTheOnlyTeamIfThereIsOne) {
  ReportDesign design{{{"baseline", "Baseline", "baseline", 0, {}}}, {{0, "N", 1}}, {0}, 1};
  RunData data;
  data.teams = {team_of(3, 0.5)};
  EXPECT_EQ(telling_teams(design, data).size(), 1u);
}

// What the report says of teams that needed so many periods together and alone, in the same order of people.
std::string said_of(const std::vector<std::size_t>& together, const std::vector<std::size_t>& alone, bool paired) {
  ReportDesign design{{{"joint", "Joint", "joint", 0, {}}, {"baseline", "Baseline", "baseline", 0, {}}},
                      {{0, "NP", together.size()}, {1, "NP", alone.size()}},
                      {},
                      2};
  RunData data;
  for (std::size_t cell : {0u, 1u}) {
    const auto& values = cell == 0 ? together : alone;
    for (std::size_t i = 0; i < values.size(); ++i) {
      design.cell_of_team.push_back(cell);
      data.teams.push_back(team_of(values[i], 0.0, i + 1));
    }
  }
  const std::vector<Finding> findings;
  const FirstScreen screen{.design = design, .data = data, .findings = findings, .paired = paired};
  return answer_about_alone(screen, kPeriods).answer;
}

// Whether teams are too few follows from what their interval still allows, not from how many they are.
TEST(Answers, AreOfTooFewTeamsIfALargeDifferenceMayBe) {
  EXPECT_EQ(said_of({20, 60, 100, 140}, {21, 59, 101, 139}, true), "no difference found");
  EXPECT_EQ(said_of({20, 60, 100, 140}, {61, 19, 141, 99}, true), "too few teams to tell");
  EXPECT_EQ(said_of({2, 6}, {2, 6}, false), "too few teams to tell");
  std::vector<std::size_t> many;
  for (const auto& [teams, said] : {std::pair{12, "too few teams to tell"}, {14, "no difference found"}}) {
    while (many.size() < static_cast<std::size_t>(teams)) many.push_back(many.size() % 2 == 0 ? 4 : 6);
    EXPECT_EQ(said_of(many, many, false), said) << teams;
  }
  // Nothing varies, so nothing is left to find.
  EXPECT_EQ(said_of({3, 4, 4}, {3, 4, 4}, true), "not tested");
}

// Groups of people differ and the teams of one composition do not: more teams would tell nothing.
TEST(Answers, AreNotOfTooFewTeamsWhereTeamsOfACellAreAlike) {
  constexpr std::size_t kTeams = 6;
  ReportDesign design{{{"joint", "Joint", "joint", 0, {}}, {"baseline", "Baseline", "baseline", 0, {}}},
                      {{0, "NP", kTeams}, {0, "PP", kTeams}, {1, "NP", kTeams}, {1, "PP", kTeams}},
                      {},
                      2};
  RunData data;
  for (std::size_t cell = 0; cell < design.cells.size(); ++cell) {
    for (std::size_t i = 0; i < kTeams; ++i) {
      design.cell_of_team.push_back(cell);
      data.teams.push_back(team_of(cell == 0 || cell == 3 ? 4 : 6, 0.0, i + 1));
    }
  }
  const std::vector<Finding> findings;
  const FirstScreen screen{.design = design, .data = data, .findings = findings, .paired = true};
  EXPECT_EQ(answer_about_alone(screen, kPeriods).answer, "no difference found");
}

}  // namespace
}  // namespace kith::detail
