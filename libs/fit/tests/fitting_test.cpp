#include <gtest/gtest.h>

#include <cstdio>

#include <algorithm>
#include <cmath>
#include <set>

#include "kith/core/error.hpp"
#include "kith/fit/fit.hpp"
#include "simulated_people.hpp"

namespace kith {
namespace {

const std::string kTwoTypes =
    "[learner.N]\nability = { mean = 0.62, sd = 0.01, min = 0.55 }\nconfirm_gain = { value = 0.0 }\n"
    "correct_gain = { value = 0.02 }\nparticles = 60\n"
    "[learner.P]\nability = { mean = 0.88, sd = 0.01 }\nconfirm_gain = { value = 0.0 }\n"
    "correct_gain = { value = 0.02 }\nparticles = 60\n";

const testing::SimulatedPeople& few_people() {
  static const auto people = testing::simulate(testing::study_text(
      "NP", 5, kTwoTypes + "[stop]\nconsecutive_correct = 3\nduplicate_sets = 3\nmax_periods = 12\n"));
  return people;
}

FitOptions quick() {
  FitOptions options;
  options.replicates = 1;
  options.num_abilities = 6;
  options.num_gains = 3;
  options.num_draws = 10;
  options.folds = 0;
  return options;
}

ParameterGrid small_grid() { return make_grid(0.55, 0.9, 5, 0.1, 3); }

TEST(Fitting, LikelihoodsDoNotDependOnThreads) {
  LikelihoodOptions options{.replicates = 2, .seed = 4};
  options.parallel.threads = 1;
  const auto one = log_likelihoods(few_people().logs, small_grid(), options);
  options.parallel.threads = 3;
  const auto three = log_likelihoods(few_people().logs, small_grid(), options);
  EXPECT_EQ(one.log_likelihood, three.log_likelihood);
}

TEST(Fitting, SharingTheFilterChangesNoLikelihood) {
  const LikelihoodOptions options{.replicates = 1, .seed = 4};
  const auto grid = small_grid();
  const auto all = log_likelihoods(few_people().logs, grid, options);
  // Grids of eight points about some of the same values.
  for (const std::size_t first : {0u, 3u}) {
    ParameterGrid part{{grid.abilities[first], grid.abilities[first + 1]},
                       {grid.confirm_gains[0], grid.confirm_gains[1]},
                       {grid.correct_gains[0], grid.correct_gains[1]}};
    const auto some = log_likelihoods(few_people().logs, part, options);
    for (std::size_t i = 0; i < part.size(); ++i) {
      for (std::size_t j = 0; j < grid.size(); ++j) {
        if (!(grid.point(j) == part.point(i))) continue;
        EXPECT_EQ(some.log_likelihood[1][i], all.log_likelihood[1][j]);
      }
    }
  }
}

TEST(Fitting, TheProbabilitiesOfAPersonsVerdictsSumToOne) {
  // One period with one test: right and wrong are all there is.
  ResponseLogs logs;
  KnownLearner model;
  model.parameters.set("particles", std::int64_t{200});
  model.prior = Cone::intersection(std::vector{HalfSpace{IntegerVector{0, 0, -1}}}).value();
  logs.models.push_back(model);
  for (const bool right : {true, false}) {
    PersonLog person;
    person.id = "the same noise";
    LoggedPeriod period;
    period.conveyed = {HalfSpace{IntegerVector{-1, 0, 2}}};
    period.answers = {{{HalfSpace{IntegerVector{-1, 0, 4}}, HalfSpace{IntegerVector{0, 1, -2}}}, right}};
    period.chance = 0.5;
    person.periods = {period};
    logs.people.push_back(person);
  }
  const auto table = log_likelihoods(logs, small_grid(), {.replicates = 1, .seed = 1, .slip = 0.03});
  for (std::size_t i = 0; i < table.grid.size(); ++i) {
    EXPECT_NEAR(std::exp(table.log_likelihood[0][i]) + std::exp(table.log_likelihood[1][i]), 1.0, 1e-12);
  }
}

TEST(Fitting, PathsSayMoreThanVerdicts) {
  const auto text = testing::study_text(
      "NP", 5, kTwoTypes + "[stop]\nconsecutive_correct = 3\nduplicate_sets = 3\nmax_periods = 12\n");
  const auto verdicts = testing::simulate(text, AnswerDetail::kVerdict);
  double paths_top = 0.0;
  double verdicts_top = 0.0;
  const LikelihoodOptions options{.replicates = 1, .seed = 1};
  const auto of_paths = log_likelihoods(few_people().logs, small_grid(), options);
  const auto of_verdicts = log_likelihoods(verdicts.logs, small_grid(), options);
  for (std::size_t i = 0; i < of_paths.log_likelihood.size(); ++i) {
    paths_top += *std::max_element(of_paths.log_likelihood[i].begin(), of_paths.log_likelihood[i].end());
    verdicts_top += *std::max_element(of_verdicts.log_likelihood[i].begin(), of_verdicts.log_likelihood[i].end());
  }
  EXPECT_LT(paths_top, verdicts_top);  // a path is never more probable than that it is right or wrong
}

TEST(Fitting, FindsThatLabelledTypesDiffer) {
  const auto report = fit_learners(few_people().logs, quick());
  ASSERT_EQ(report.types.size(), 2u);
  EXPECT_EQ(report.types[0].name, "N");
  EXPECT_LT(report.types[0].fit.parameters.ability_mean, report.types[1].fit.parameters.ability_mean);
  ASSERT_EQ(report.people.size(), 10u);
  for (const auto& person : report.people) {
    EXPECT_LE(person.posterior.ability.lower, person.posterior.ability.mean);
    EXPECT_LE(person.posterior.ability.mean, person.posterior.ability.upper);
    EXPECT_TRUE(person.type_probabilities.empty());
  }
  for (const auto& type : report.types) {
    EXPECT_LE(type.lower.confirm_scale, type.median.confirm_scale);
    EXPECT_LE(type.median.confirm_scale, type.upper.confirm_scale);
    // Ten people who answer little: where the maximum is at an edge, it says so.
    const auto& best = type.fit.parameters;
    bool edge = false;
    for (const auto parameter : {&PopulationParameters::ability_mean, &PopulationParameters::ability_sd,
                                 &PopulationParameters::confirm_scale, &PopulationParameters::correct_scale}) {
      edge = edge || best.*parameter < 1.02 * kSmallestPopulation.*parameter ||
             best.*parameter > 0.98 * kLargestPopulation.*parameter;
    }
    EXPECT_EQ(type.at_edge.empty(), !edge);
  }
  EXPECT_FALSE(report.why_estimates_differ.empty());
  const auto section = learner_section('N', report.types[0]);
  char median[16];
  static_cast<void>(std::snprintf(median, sizeof median, "%.3f", report.types[0].median.confirm_scale));
  EXPECT_NE(section.find(median), std::string::npos);
  EXPECT_EQ(section.rfind("[learner.N]\n", 0), 0u);
  const auto pasted = parse_study(testing::study_text("N", 3, section), "pasted.toml");
  EXPECT_TRUE(pasted.study.has_value());
}

TEST(Fitting, SeparatesTypesWithoutLabelsAndSaysWhenItCannot) {
  auto options = quick();
  options.num_types = 2;
  const auto report = fit_learners(few_people().logs, options);
  ASSERT_EQ(report.types.size(), 2u);
  EXPECT_NEAR(report.types[0].share + report.types[1].share, 1.0, 1e-9);
  EXPECT_LE(report.types[0].fit.parameters.ability_mean, report.types[1].fit.parameters.ability_mean);
  for (const auto& person : report.people) {
    ASSERT_EQ(person.type_probabilities.size(), 2u);
    EXPECT_NEAR(person.type_probabilities[0] + person.type_probabilities[1], 1.0, 1e-9);
    EXPECT_EQ(person.type_unclear,
              *std::max_element(person.type_probabilities.begin(), person.type_probabilities.end()) < 0.9);
  }
}

TEST(Fitting, SaysThatShortSessionsCannotTellTheGainsApart) {
  const auto people = testing::simulate(testing::study_text("N", 8, "[stop]\nmax_periods = 3\n" + kTwoTypes));
  const auto report = fit_learners(people.logs, quick());
  const auto& known = report.types[0].identifiability;
  EXPECT_FALSE(known.gains_apart);
  EXPECT_EQ(known.sentences.at(0).rfind("these data cannot tell the gains apart", 0), 0u) << known.sentences.at(0);
  EXPECT_LT(known.difference, 0.2);
}

TEST(Fitting, ComparesModelsByPeopleWhoWereHeldOut) {
  auto options = quick();
  options.folds = 2;
  const auto report = fit_learners(few_people().logs, options);
  std::set<std::string> models;
  for (const auto& model : report.cross_validation) models.insert(model.model);
  EXPECT_EQ(models, (std::set<std::string>{"full", "equal gains", "no gains", "two types", "types as labelled"}));
  EXPECT_EQ(report.cross_validation.at(0).model, "full");
  EXPECT_EQ(report.cross_validation.at(0).difference, 0.0);
  EXPECT_EQ(report.sentences.size(), 5u);  // the last one says that 60 particles are few
  EXPECT_NE(report.sentences.back().find("noisy"), std::string::npos);
}

TEST(Fitting, StopsWhenAsked) {
  auto options = quick();
  options.parallel.threads = 1;
  options.parallel.on_progress = [](std::size_t done, std::size_t) { return done < 2; };
  const auto report = fit_learners(few_people().logs, options);
  EXPECT_FALSE(report.complete);
  EXPECT_TRUE(report.people.empty());
}

TEST(Fitting, RefusesTooFewPeople) {
  auto logs = few_people().logs;
  logs.people.resize(2);
  try {
    static_cast<void>(fit_learners(logs, quick()));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInfeasible);
    EXPECT_EQ(error.diagnostics().at(0).id, "E0710");
  }
}

}  // namespace
}  // namespace kith
