#include "kith/fit/kinds_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>

#include "simulated_people.hpp"

namespace kith {
namespace {

// As many teams of one person of a kind: three sets of tests in each of up to 20 periods.
ResponseLogs people_of(const std::string& kind, const std::string& more, std::size_t teams, std::size_t periods) {
  const auto text =
      testing::study_text("N", teams,
                          "[stop]\nmastery = \"fixed\"\nperiods_per_component = " + std::to_string(periods) +
                              "\nduplicate_sets = 3\n[learner.N]\nkind = \"" + kind + "\"\n" + more +
                              "ability = { mean = 0.75, sd = 0.04 }\nconfirm_gain = { half_normal = 0.02 }\n"
                              "correct_gain = { half_normal = 0.05 }\nparticles = 300\n");
  const testing::ScratchFolder folder;
  testing::run_into(folder.path() / "run", text);
  return import_run_folder(folder.path() / "run", AnswerDetail::kPath, {}, PeopleRead::kAnyKind);
}

TEST(KindsFit, TellsWhoImitatesFromWhoDoesNot) {
  const auto imitating = people_of("imitating", "reward = 0.2\n", 3, 2);
  const auto report = fit_kinds(imitating, {.abilities = {0.7, 0.8}});
  ASSERT_EQ(report.people.size(), 3u);
  double shares = 0.0;
  for (const auto& kind : report.kinds) shares += kind.share;
  EXPECT_NEAR(shares, 1.0, 1e-9);
  for (const auto& person : report.people) {
    EXPECT_EQ(report.kinds[person.likeliest].kind, "imitating") << person.id;
    double sum = 0.0;
    for (const double one : person.probability) sum += one;
    EXPECT_NEAR(sum, 1.0, 1e-9);
  }
}

TEST(KindsFit, DoesNotDependOnThreads) {
  const auto logs = people_of("slipping", "", 3, 1);
  KindsOptions one{.abilities = {0.75}};
  one.parallel.threads = 1;
  auto three = one;
  three.parallel.threads = 3;
  const auto a = fit_kinds(logs, one), b = fit_kinds(logs, three);
  for (std::size_t i = 0; i < a.people.size(); ++i) EXPECT_EQ(a.people[i].log_evidence, b.people[i].log_evidence);
}

TEST(KindsFit, NeedsPathsAndPeople) {
  const auto fault = [](const ResponseLogs& logs) -> std::string {
    try {
      (void)fit_kinds(logs, {});
    } catch (const Error& error) {
      return error.diagnostics().front().id;
    }
    return "none";
  };
  auto logs = people_of("bayesian", "", 1, 1);
  for (auto& model : logs.models) model.atlas.reset();
  EXPECT_EQ(fault(logs), "E0714");
  logs.people.clear();
  EXPECT_EQ(fault(logs), "E0710");
}

}  // namespace
}  // namespace kith
