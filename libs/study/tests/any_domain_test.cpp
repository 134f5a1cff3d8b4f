// Teams are taught in domains of two to eight features, discounted or not, with tables and without.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "domain_texts.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/geometry/cone.hpp"
#include "kith/study/study.hpp"
#include "kith/study/tables.hpp"

namespace kith {
namespace {

// Rubble, smoke and a charger on the way to a goal: four features.
const std::string kFourFeatures = testing::map_domain(
    "four", "\"..r.G\", \".#s#.\", \"S.rBs\"",
    "\"#\" = \"wall\"\n\"r\" = { terrain = \"rubble\", optional = true }\n"
    "\"s\" = { terrain = \"smoke\", optional = true }\n\"B\" = { station = \"charger\", optional = true }\n",
    {{"rubble", "leave:rubble"}, {"smoke", "leave:smoke"}, {"recharge", "leave:charger"}, {"step", "action"}},
    "rubble = -3, smoke = -1.5, recharge = 2.5, step = -1", "[prior]\nhalfspaces = [ { step = -1 } ]\n",
    "[mdp]\ndiscount = 1.0\n");

const std::string kTwoFeatures =
    testing::rubble_domain("\"..rG\", \".#r.\", \"S...\"", "[prior]\nhalfspaces = [ { step = -1 } ]\n");

Domain domain_from(const std::string& text) {
  auto reading = parse_domain(text, "test.toml");
  for (const auto& diagnostic : reading.diagnostics) {
    EXPECT_EQ(diagnostic.severity, Severity::kWarning) << diagnostic.id << ' ' << diagnostic.message;
  }
  return *std::move(reading.domain);
}

LearnerType learner(char letter, double ability, double sd, double confirm, double correct) {
  LearnerType type{.letter = letter, .label = {}};
  type.parameters.set("ability.mean", ability);
  type.parameters.set("ability.sd", sd);
  type.parameters.set("confirm_gain", Spread{.half_normal = confirm, .value = {}});
  type.parameters.set("correct_gain", Spread{.half_normal = correct, .value = {}});
  type.parameters.set("particles", std::int64_t{300});
  return type;
}

Study study_for(const Domain& domain) {
  StudySpec spec;
  spec.id = "any";
  spec.seed = 3;
  spec.replicates = 2;
  take_domain(spec, domain);
  for (const auto* name : {"baseline", "individual-low", "common", "joint"}) {
    spec.strategies.push_back(strategy_named(name));
  }
  spec.compositions = {"NP"};
  spec.learner_types = {learner('N', 0.703, 0.034, 0.033, 0.056), learner('P', 0.809, 0.025, 0.022, 0.052)};
  spec.teaching.filter.particles = 300;
  spec.teaching.max_periods = 30;
  return {{spec}};
}

// A header and the rows below it.
std::vector<std::vector<std::string>> cells_of(const std::string& csv) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines{csv};
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells{line};
    for (rows.emplace_back(); std::getline(cells, line, ',');) rows.back().push_back(line);
  }
  return rows;
}

using Tables = std::map<std::string, std::string, std::less<>>;

Tables tables_of(const Study& study, const std::vector<TeamRecord>& teams) {
  Tables tables;
  write_study_tables(study, teams,
                     [&](std::string_view file, std::string_view piece) { tables[std::string{file}] += piece; });
  return tables;
}

// The cells of a row by the names of their columns.
using Row = std::map<std::string, std::string>;
std::vector<Row> rows_of(const std::string& csv) {
  const auto cells = cells_of(csv);
  std::vector<Row> rows;
  for (std::size_t i = 1; i < cells.size(); ++i) {
    auto& row = rows.emplace_back();
    for (std::size_t k = 0; k < cells[i].size(); ++k) row[cells[0][k]] = cells[i][k];
  }
  return rows;
}

// What the tables say of answers and knowledge, computed again from the domain and what else the tables say.
void expect_tables_recomputed(const Atlas& atlas, const Tables& tables) {
  const auto& domain = atlas.domain();
  const auto scale = static_cast<double>(domain.count_scale());
  for (const auto& row : rows_of(tables.at("responses.csv"))) {
    if (row.at("answer").empty()) {
      EXPECT_EQ(row.at("regret"), "");
      continue;
    }
    const StartId id{MdpIndex{std::stoul(row.at("mdp"))}, StateIndex{std::stoul(row.at("start"))}};
    const auto& robot = atlas.feature_counts(atlas.index(id));
    std::istringstream answer{row.at("answer")};
    double lost = 0.0;
    for (std::size_t k = 0; k < domain.num_features(); ++k) {
      double count = 0.0;
      answer >> count;
      lost += domain.weights().raw[k] * (static_cast<double>(robot[k]) / scale - count);
    }
    const double said = std::stod(row.at("regret"));
    EXPECT_NEAR(said, lost, row.at("correct") == "true" ? 1e-4 : 1e-9) << "in the units of the domain file";
    EXPECT_EQ(row.at("correct") == "true", said == 0.0);
  }
  std::map<std::string, std::vector<double>> known;  // by team
  for (const auto& row : rows_of(tables.at("learners.csv")))
    known[row.at("team")].push_back(std::stod(row.at("p_bec")));
  for (const auto& row : rows_of(tables.at("teams.csv"))) {
    const auto& members = known.at(row.at("team"));
    double mean = 0.0;
    for (const double mass : members) mean += mass / static_cast<double>(members.size());
    EXPECT_NEAR(std::stod(row.at("knowledge")), mean, 1e-12);
  }
}

void expect_taught(const Atlas& atlas) {
  const auto study = study_for(atlas.domain());
  const auto teams = run_teams(atlas, study, team_addresses(study)).teams;
  ASSERT_EQ(teams.size(), 8u);
  double knowledge = 0.0;
  for (const auto& team : teams) {
    EXPECT_GT(team.periods, 0u);
    EXPECT_GT(team.demonstrations, 0u);
    EXPECT_GT(team.tests, 0u);
    EXPECT_LE(team.knowledge, 1.0);
    knowledge += team.knowledge / static_cast<double>(teams.size());
    for (const auto& period : team.period_records) {
      EXPECT_GT(period.area_sr, 0.0);
      EXPECT_LE(period.running_area_sr, sphere_area(atlas.domain().num_features()) / 2.0 * (1.0 + 1e-9));
    }
    for (const auto& response : team.responses) {
      EXPECT_EQ(response.correct, response.regret.has_value() && *response.regret == 0.0);
    }
  }
  // Far more than somebody knows who knows the prior only.
  EXPECT_GT(knowledge, 3.0 * atlas.policy_bec_area_sr() / atlas.prior_cone().solid_angle());
  expect_tables_recomputed(atlas, tables_of(study, teams));
  // The same again on any number of threads, which share what they know of policies.
  for (const std::size_t threads : {1u, 2u, 8u}) {
    RunOptions options;
    options.threads = threads;
    const auto again = run_teams(atlas, study, team_addresses(study), options).teams;
    ASSERT_EQ(again.size(), teams.size());
    for (std::size_t i = 0; i < teams.size(); ++i) {
      EXPECT_EQ(again[i].knowledge, teams[i].knowledge);
      EXPECT_EQ(again[i].periods, teams[i].periods);
      EXPECT_EQ(again[i].demonstrations, teams[i].demonstrations);
      EXPECT_EQ(again[i].area_sr, teams[i].area_sr);
    }
  }
}

TEST(AnyDomain, TwoFeaturesAreTaught) { expect_taught(Atlas{domain_from(kTwoFeatures)}); }

TEST(AnyDomain, FourFeaturesAreTaughtInAFewPartsThenTogether) {
  const Atlas atlas{domain_from(kFourFeatures)};
  EXPECT_FALSE(atlas.find_tables());
  std::vector<std::string> names;
  for (const auto& component : atlas.knowledge_components()) names.push_back(component.name);
  EXPECT_GE(names.size(), 2u);
  EXPECT_LE(names.size(), 6u);
  EXPECT_EQ(names.back(), "rubble+smoke+recharge");
  expect_taught(atlas);
}

TEST(AnyDomain, DiscountedOnesAreTaught) {
  std::string text{kFourFeatures};
  const std::string from = "discount = 1.0";
  expect_taught(Atlas{domain_from(text.replace(text.find(from), from.size(), "discount = 0.97"))});
}

TEST(AnyDomain, TablesNameWorldsThatHaveNames) {
  const std::string listed =
      "[[family.world]]\nname = \"all clear\"\npresent = []\n"
      "[[family.world]]\npresent = [\"rubble\"]\n"
      "[[family.world]]\nname = \"after the storm\"\npresent = [\"smoke\", \"charger\"]\n";
  for (const bool has_names : {true, false}) {
    const Atlas atlas{domain_from(kFourFeatures + (has_names ? listed : ""))};
    const auto study = study_for(atlas.domain());
    const auto teams = run_teams(atlas, study, team_addresses(study)).teams;
    const auto tables = tables_of(study, teams);
    for (const auto* file : {"responses.csv", "demonstrations.csv"}) {
      const auto rows = cells_of(tables.at(file));
      ASSERT_GT(rows.size(), 1u);
      const auto mdp = std::ranges::find(rows[0], "mdp") - rows[0].begin();
      ASSERT_EQ(std::ranges::count(rows[0], "mdp_name"), has_names ? 1 : 0) << file;
      for (std::size_t i = 1; has_names && i < rows.size(); ++i) {
        const MdpIndex m{std::stoul(rows[i].at(static_cast<std::size_t>(mdp)))};
        EXPECT_EQ(rows[i].at(static_cast<std::size_t>(mdp) + 1), atlas.domain().world_name(m));
      }
    }
  }
}

}  // namespace
}  // namespace kith
