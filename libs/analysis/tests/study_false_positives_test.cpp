// Error rates of analyses of studies; see error_rates.hpp.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "error_rates.hpp"
#include "run_findings.hpp"

namespace kith {
namespace {

using testing::binomial;
using testing::kStudies;
using testing::p_of;
using testing::Rates;

struct NullStudy {
  RunTeams teams;
  std::vector<double> periods, knowledge, area_sr;
};

// Teams of a study without effects. `periods` are counts if everybody was taught once, else any numbers.
NullStudy null_study(bool same_people, RandomStream& random) {
  NullStudy study;
  auto& teams = study.teams;
  teams.strategy = {"strategy", {"baseline", "individual-low", "individual-high", "common", "joint"}, {}};
  teams.composition = {"composition", {"NNN", "PPP"}, {}};
  constexpr std::size_t kReplicates = 10;
  std::vector<double> periods_of(2 * kReplicates), knowledge_of(2 * kReplicates);
  for (auto& one : periods_of) one = standard_normal(random);
  for (auto& one : knowledge_of) one = standard_normal(random);
  auto of_areas = random.split("areas");
  std::vector<double> area_of(2 * kReplicates);
  for (auto& one : area_of) one = standard_normal(of_areas);
  for (std::size_t strategy = 0; strategy < 5; ++strategy) {
    for (std::size_t composition = 0; composition < 2; ++composition) {
      for (std::size_t replicate = 0; replicate < kReplicates; ++replicate) {
        const auto people = composition * kReplicates + replicate;
        const double shared = same_people ? 0.7 * periods_of[people] : 0.0;
        teams.strategy.codes.push_back(strategy);
        teams.composition.codes.push_back(composition);
        teams.setting.emplace_back();
        auto& team = teams.records.emplace_back();
        team.seed_address = fmt::format("7/{}", same_people ? people : teams.size());
        team.status = SessionStatus::kComplete;
        study.periods.push_back(same_people ? 8.0 + shared + standard_normal(random)
                                            : static_cast<double>(2 + binomial(8, 0.7, random)));
        study.knowledge.push_back((same_people ? knowledge_of[people] : 0.0) + standard_normal(random));
        study.area_sr.push_back(std::exp(0.18 * ((same_people ? area_of[people] : 0.0) + standard_normal(of_areas))));
      }
    }
  }
  return study;
}

void add_study(const NullStudy& study, bool same_people, Rates& rates) {
  const auto& teams = study.teams;
  const std::string kind = same_people ? "Study, same people: " : "Study, other people: ";
  const AnalysisOptions how;
  const auto main = *effects(teams, "knowledge", study.knowledge, how);
  const auto* const tests = same_people ? "Tests of the fixed" : "Analysis of variance (type II)";
  for (const auto* term : {"strategy", "composition", "strategy:composition"})
    rates.add(kind + "`knowledge`, " + term, p_of(main, tests, term));
  if (same_people) {
    for (const auto* term : {"strategy", "composition", "strategy:composition"})
      rates.add(std::string{"Analysis of variance as published, same people: "} + term,
                p_of(main, "Analysis of variance as published", term),
                "the analysis of variance as published takes teams of the same people as independent; it is shown for "
                "comparison only, with a warning");
  }
  // The first part of `demonstrations`: areas, whose skewness is about .8, as in the paper's study.
  const auto areas = *effects(teams, "area_sr", study.area_sr, how);
  for (const auto* term : {"strategy", "composition", "strategy:composition"})
    rates.add(kind + "`demonstrations`, " + term, p_of(areas, tests, term));
  const auto within = *effects_within(teams, "knowledge", study.knowledge, how);
  rates.add(kind + "`knowledge-within-composition`, any", p_of(within, "", "", "corrected p-value"));
  rates.add(kind + (same_people ? "Friedman" : "Kruskal-Wallis") + " in one composition",
            p_of(within, "", "NNN", same_people ? "Friedman p-value" : "Kruskal-Wallis p-value"));
  const auto belief = *beliefs(teams, "knowledge", study.knowledge, how);
  rates.add(kind + "`knowledge-beliefs`", p_of(belief, "Planned contrasts", "team beliefs - individual beliefs"));
  rates.add(kind + "`knowledge-beliefs`, at each composition, any",
            p_of(belief, "Planned contrasts of strategy at each", "", "corrected p-value"));
  rates.add(kind + "`knowledge-beliefs`, dependence on composition", p_of(belief, "Does the difference", ""));
  const auto varied = *variation(teams, "periods", study.periods, how);
  rates.add(kind + "`periods-variation`, variance ratio",
            p_of(varied, "Variance", "all", same_people ? "p-value, jackknife" : "p-value, F"),
            same_people ? ""
                        : "the values of this simulation, like periods, have lighter tails than the normal "
                          "distribution that the F test assumes");
  rates.add(kind + "`periods-variation`, Brown-Forsythe", p_of(varied, "Variance", "all", "p-value, Brown-Forsythe"));
  const auto alone = *against_baseline(teams, "knowledge", study.knowledge, how);
  rates.add(kind + "`knowledge-baseline`", p_of(alone, "", "together - alone"));
  if (!same_people) return;
  const auto pairs = *paired(teams, "knowledge", study.knowledge, how);
  rates.add(kind + "`knowledge-paired`, any pair (Holm)", p_of(pairs, "Differences within", "", "corrected p-value"),
            "the pairs depend on each other, which Holm's correction does not use");
  rates.add(kind + "within people, Mauchly", p_of(pairs, "Corrections", "strategy", "p-value, Mauchly"));
  for (const auto* term : {"strategy", "strategy:composition"}) {
    rates.add(kind + "within people, " + term, p_of(pairs, "Analysis of variance within", term));
    rates.add(kind + "within people, " + term + ", Greenhouse-Geisser",
              p_of(pairs, "Corrections", term, "p-value, Greenhouse-Geisser"));
    rates.add(kind + "within people, " + term + ", Huynh-Feldt",
              p_of(pairs, "Corrections", term, "p-value, Huynh-Feldt"));
  }
}

TEST(FalsePositivesSlow, OfStudiesWithTheSamePeople) {
  Rates rates;
  for (std::size_t study = 0; study < kStudies; ++study) {
    auto random = RandomStream{108}.split(study);
    add_study(null_study(true, random), true, rates);
  }
  rates.expect_nominal();
}

TEST(FalsePositivesSlow, OfStudiesWithOtherPeople) {
  Rates rates;
  for (std::size_t study = 0; study < kStudies; ++study) {
    auto random = RandomStream{109}.split(study);
    add_study(null_study(false, random), false, rates);
  }
  rates.expect_nominal();
}

}  // namespace
}  // namespace kith
