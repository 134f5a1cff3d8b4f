#include "kith/fit/predict_answers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include "kith/belief/particle_belief.hpp"
#include "kith/core/error.hpp"
#include "kith/domains/judgement.hpp"
#include "kith/fit/accuracy.hpp"
#include "kith/learners/learner_model.hpp"
#include "open_table.hpp"

namespace kith {
namespace {

constexpr double kSmallest = 1e-6;      // probability that is predicted of anything
constexpr double kAnswersOfMean = 2.0;  // answers that a mean counts as
constexpr std::size_t kFolds = 10;      // of people, for the Rasch model
constexpr std::array kAbilitiesShown{0.5, 0.55, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95, 0.99};

struct AskedOf {
  std::size_t world = 0;
  bool right = false;
};
using AskedOfPeople = std::vector<std::vector<AskedOf>>;

// A model that is a table of probabilities of a right answer, for each setting of its parameters and each world.
struct SettingsTable {
  std::string name;
  std::vector<std::vector<double>> right;  // shape [settings][worlds]
};

// One world with the paths that could be best for somebody.
class AskedWorld {
 public:
  explicit AskedWorld(const RecordedWorld& world)
      : atlas_{world.domain}, test_{atlas_.index({MdpIndex{0}, world.domain.initial_state(MdpIndex{0})})} {
    for (const auto& path : atlas_.tables().coverage_set(test_)) {
      paths_.push_back(path);
      right_.push_back(judge_path(atlas_.domain(), atlas_.feature_counts(test_), path).is_right);
    }
  }

  [[nodiscard]] const Atlas& atlas() const { return atlas_; }

  // Probability of a right answer of somebody who takes their best path.
  [[nodiscard]] double right_at_best(const ParticleBelief& belief) const {
    return mean(belief, [&](const Direction& /*weights*/, const IntegerVector& best) {
      const auto number = std::find(paths_.begin(), paths_.end(), best) - paths_.begin();
      return right_[static_cast<std::size_t>(number)] ? 1.0 : 0.0;
    });
  }
  // Of somebody who takes paths with probabilities proportional to exp(rationality * return).
  [[nodiscard]] double right_by_worth(const ParticleBelief& belief, double rationality) const {
    return mean(belief, [&](const Direction& weights, const IntegerVector& best) {
      const auto worth = [&](const IntegerVector& path) { return dot(path, std::span{weights.data(), path.size()}); };
      const double top = worth(best);
      double right = 0.0, all = 0.0;
      for (std::size_t i = 0; i < paths_.size(); ++i) {
        const double share = std::exp(rationality * (worth(paths_[i]) - top));
        all += share;
        if (right_[i]) right += share;
      }
      return right / all;
    });
  }

 private:
  // Over the weights that have a best path; 0 if none has.
  template <typename F>
  [[nodiscard]] double mean(const ParticleBelief& belief, F f) const {
    double sum = 0.0, possible = 0.0;
    for (std::size_t i = 0; i < belief.size(); ++i) {
      const auto point = belief.point(i);
      const auto best = atlas_.tables().answer(test_, atlas_.tables().cells().locate(point));
      if (!best) continue;
      possible += belief.weights()[i];
      sum += belief.weights()[i] * f(point, *best);
    }
    return possible > 0.0 ? sum / possible : 0.0;
  }

  Atlas atlas_;
  StartIndex test_;
  std::vector<IntegerVector> paths_;
  std::vector<bool> right_;
};

// The worlds of one family, what its videos should teach, and beliefs of people who learned that.
class WorldFamily {
 public:
  void add(std::size_t number, const AskedWorld& world) {
    numbers_.push_back(number);
    worlds_.push_back(&world);
  }

  void finish() {
    auto cone = worlds_.front()->atlas().prior_cone();
    for (const auto* world : worlds_) {
      for (const auto& half_space : world->atlas().policy_bec_half_spaces()) static_cast<void>(cone.clip(half_space));
    }
    const auto& prior = worlds_.front()->atlas().prior_cone();
    for (const auto& half_space : cone.minimal_set()) {
      const auto facets = prior.facets();
      if (std::find(facets.begin(), facets.end(), half_space) == facets.end()) taught_.push_back(half_space);
    }
    cover_.emplace(prior, FilterOptions{}.particles);
  }

  [[nodiscard]] const std::vector<std::size_t>& numbers() const { return numbers_; }
  [[nodiscard]] const AskedWorld& world(std::size_t i) const { return *worlds_[i]; }

  // @param doubt  mass at the start where the constraint `wrong` holds; nothing: an unbiased start.
  [[nodiscard]] ParticleBelief belief(double ability, std::optional<std::size_t> wrong, double doubt) const {
    ParticleBelief belief{*cover_, {.resample_below = 0.0}};
    if (wrong && !taught_.empty()) {
      const auto& constraint = taught_[std::min(*wrong, taught_.size() - 1)];
      const double holds = belief.mass_in(std::array{constraint});
      std::vector<double> factors;
      for (std::size_t i = 0; i < belief.size(); ++i) {
        factors.push_back(constraint.contains(belief.point(i)) ? doubt / holds : (1.0 - doubt) / (1.0 - holds));
      }
      if (holds > 0.0 && holds < 1.0) belief.weigh_by(factors);
    }
    belief.observe(taught_, HalfSpaceLikelihood{ability, LikelihoodForm::kDiscontinuous, belief.dimension()},
                   RandomStream{0});
    return belief;
  }

 private:
  std::vector<std::size_t> numbers_;
  std::vector<const AskedWorld*> worlds_;
  std::vector<HalfSpace> taught_;
  std::optional<PriorCover> cover_;
};

std::span<const double> fitted_values(const LearnerModel& model, std::string_view name) {
  const auto found =
      std::find_if(model.fitted.begin(), model.fitted.end(), [&](const auto& f) { return f.name == name; });
  return found->values;
}

using RightIn = std::function<double(const WorldFamily& family, std::size_t world)>;

// One row of a table: the probability in every world.
std::vector<double> row_of(const std::vector<WorldFamily>& families, std::size_t num_worlds, const RightIn& right) {
  std::vector<double> row(num_worlds, 0.0);
  for (const auto& family : families) {
    for (std::size_t i = 0; i < family.numbers().size(); ++i) row[family.numbers()[i]] = right(family, i);
  }
  return row;
}

std::vector<SettingsTable> tables_of_kinds(const std::vector<WorldFamily>& families, std::size_t num_worlds) {
  SettingsTable bayesian{"bayesian", {}}, slipping{"slipping", {}}, noisy{"noisy-rational", {}},
      misconceived{"misconceived", {}};
  for (const double ability : kAbilitiesShown) {
    std::map<const WorldFamily*, ParticleBelief> unbiased;
    for (const auto& family : families) unbiased.emplace(&family, family.belief(ability, {}, 0.0));
    bayesian.right.push_back(row_of(families, num_worlds, [&](const WorldFamily& family, std::size_t i) {
      return family.world(i).right_at_best(unbiased.at(&family));
    }));
    const auto own = bayesian.right.back();
    for (const double slip : fitted_values(slipping_model(), "slip")) {
      for (const double guess : fitted_values(slipping_model(), "guess")) {
        auto& row = slipping.right.emplace_back();
        for (const double p : own) row.push_back((1.0 - slip) * p + guess * (1.0 - p));
      }
    }
    for (const double rationality : fitted_values(noisy_rational_model(), "rationality")) {
      noisy.right.push_back(row_of(families, num_worlds, [&](const WorldFamily& family, std::size_t i) {
        return family.world(i).right_by_worth(unbiased.at(&family), rationality);
      }));
    }
    for (const double number : fitted_values(misconceived_model(), "constraint")) {
      constexpr double kDoubt = 0.05;
      std::map<const WorldFamily*, ParticleBelief> biased;
      for (const auto& family : families) {
        biased.emplace(&family, family.belief(ability, static_cast<std::size_t>(number) - 1, kDoubt));
      }
      misconceived.right.push_back(row_of(families, num_worlds, [&](const WorldFamily& family, std::size_t i) {
        return family.world(i).right_at_best(biased.at(&family));
      }));
    }
  }
  return {bayesian, slipping, noisy, misconceived};
}

double log_of(double right, bool is_right) {
  const double p = std::clamp(right, kSmallest, 1.0 - kSmallest);
  return std::log(is_right ? p : 1.0 - p);
}

// The probability of every answer of a person, whose settings' shares follow the answers so far.
std::vector<double> one_after_the_other(const SettingsTable& table, std::vector<double> shares,
                                        const std::vector<AskedOf>& answers) {
  std::vector<double> predictions;
  for (const auto& [world, right] : answers) {
    double p = 0.0, sum = 0.0;
    for (std::size_t s = 0; s < shares.size(); ++s) p += shares[s] * table.right[s][world];
    predictions.push_back(p);
    for (std::size_t s = 0; s < shares.size(); ++s) sum += shares[s] *= std::exp(log_of(table.right[s][world], right));
    for (double& share : shares) share /= sum;
  }
  return predictions;
}

// The predictions of a table for every answer of a person: settings are as frequent as among all others, and their
// probabilities follow the answers so far. @param logs  of all answers of a person, shape [people][settings].
std::vector<double> predicted_by(const SettingsTable& table, const std::vector<std::vector<double>>& logs,
                                 std::size_t held_out, const std::vector<AskedOf>& answers) {
  constexpr int kRounds = 60;
  const auto num_settings = table.right.size();
  std::vector<double> shares(num_settings, 1.0 / static_cast<double>(num_settings));
  for (int round = 0; round < kRounds; ++round) {
    std::vector<double> next(num_settings, 0.0), weights(num_settings);
    for (std::size_t person = 0; person < logs.size(); ++person) {
      if (person == held_out) continue;
      double sum = 0.0;
      for (std::size_t s = 0; s < num_settings; ++s) sum += weights[s] = shares[s] * logs[person][s];
      for (std::size_t s = 0; s < num_settings; ++s) next[s] += weights[s] / sum;
    }
    for (std::size_t s = 0; s < num_settings; ++s) shares[s] = next[s] / static_cast<double>(logs.size() - 1);
  }
  return one_after_the_other(table, std::move(shares), answers);
}

// Rescaled, so that the largest of a person is 1.
std::vector<std::vector<double>> likelihoods_of(const SettingsTable& table, const AskedOfPeople& people) {
  std::vector<std::vector<double>> all;
  for (const auto& answers : people) {
    std::vector<double> logs(table.right.size(), 0.0);
    for (std::size_t s = 0; s < logs.size(); ++s) {
      for (const auto& [world, right] : answers) logs[s] += log_of(table.right[s][world], right);
    }
    const double top = *std::max_element(logs.begin(), logs.end());
    for (double& log : logs) log = std::exp(log - top);
    all.push_back(std::move(logs));
  }
  return all;
}

// The Rasch model of people outside a fold as a table: abilities from -4 to 4 standard deviations, and how frequent
// they are.
struct RaschTable {
  SettingsTable table{"Rasch", {}};
  std::vector<double> shares;
};
RaschTable rasch_without(const AskedOfPeople& people, std::size_t fold, std::size_t num_worlds) {
  std::vector<AccuracyRecord> records;
  for (std::size_t person = 0; person < people.size(); ++person) {
    if (person % kFolds == fold) continue;
    for (const auto& [world, right] : people[person]) {
      records.push_back({std::to_string(person), std::to_string(world), right});
    }
  }
  const auto fit = fit_accuracy(records);
  std::vector<double> difficulty(num_worlds, 0.0);
  for (const auto& item : fit.items) difficulty[std::stoul(item.id)] = item.difficulty;
  RaschTable rasch;
  constexpr int kHalf = 40;
  double sum = 0.0;
  for (int k = -kHalf; k <= kHalf; ++k) {
    const double z = 4.0 * k / kHalf;
    sum += rasch.shares.emplace_back(std::exp(-z * z / 2.0));
    auto& row = rasch.table.right.emplace_back();
    for (const double one : difficulty) row.push_back(1.0 / (1.0 + std::exp(one - z * fit.ability_sd)));
  }
  for (double& share : rasch.shares) share /= sum;
  return rasch;
}

struct Counts {
  double right = 0.0;
  double all = 0.0;
};

// Predictions of all models for one person, shape [models][answers]; names in the same order.
class HeldOut {
 public:
  HeldOut(const AskedOfPeople& people, std::size_t person, std::size_t num_worlds)
      : people_{people}, person_{person}, by_world_(num_worlds) {
    for (std::size_t other = 0; other < people.size(); ++other) {
      if (other == person) continue;
      for (const auto& [world, right] : people[other]) {
        by_world_[world].right += right ? 1.0 : 0.0;
        by_world_[world].all += 1.0;
        everybody_.right += right ? 1.0 : 0.0;
        everybody_.all += 1.0;
      }
    }
  }

  [[nodiscard]] std::vector<double> everybody() const {
    return std::vector<double>(people_[person_].size(), everybody_.right / everybody_.all);
  }
  [[nodiscard]] std::vector<double> running() const {
    Counts own{kAnswersOfMean * everybody_.right / everybody_.all, kAnswersOfMean};
    std::vector<double> predictions;
    for (const auto& [world, right] : people_[person_]) {
      predictions.push_back(own.right / own.all);
      own.right += right ? 1.0 : 0.0;
      own.all += 1.0;
    }
    return predictions;
  }
  [[nodiscard]] std::vector<double> difficulty() const {
    std::vector<double> predictions;
    for (const auto& [world, right] : people_[person_]) {
      const auto& counts = by_world_[world];
      predictions.push_back((counts.right + kAnswersOfMean * everybody_.right / everybody_.all) /
                            (counts.all + kAnswersOfMean));
    }
    return predictions;
  }

 private:
  const AskedOfPeople& people_;
  std::size_t person_;
  std::vector<Counts> by_world_;
  Counts everybody_;
};

// How probably the prediction of a right answer is larger than that of a wrong one.
double area_under_curve(std::vector<std::pair<double, bool>> predictions) {
  std::sort(predictions.begin(), predictions.end());
  double wrong_below = 0.0, area = 0.0, right = 0.0;
  for (std::size_t i = 0; i < predictions.size();) {
    std::size_t end = i;
    double rights = 0.0, wrongs = 0.0;
    for (; end < predictions.size() && predictions[end].first == predictions[i].first; ++end) {
      (predictions[end].second ? rights : wrongs) += 1.0;
    }
    area += rights * (wrong_below + wrongs / 2.0);
    wrong_below += wrongs;
    right += rights;
    i = end;
  }
  return right > 0.0 && wrong_below > 0.0 ? area / (right * wrong_below) : 0.5;
}

std::vector<CalibrationBin> calibration_of(const std::vector<std::pair<double, bool>>& predictions) {
  constexpr std::size_t kBins = 10;
  std::vector<CalibrationBin> bins(kBins);
  for (const auto& [p, right] : predictions) {
    auto& bin = bins[std::min(static_cast<std::size_t>(p * double{kBins}), kBins - 1)];
    ++bin.answers;
    bin.predicted += p;
    bin.right += right ? 1.0 : 0.0;
  }
  for (auto& bin : bins) {
    if (bin.answers == 0) continue;
    bin.predicted /= static_cast<double>(bin.answers);
    bin.right /= static_cast<double>(bin.answers);
  }
  return bins;
}

// Sum over people of a total over the number of all answers, with the standard error over people.
std::pair<double, double> per_answer(const std::vector<double>& totals, double answers) {
  const auto n = static_cast<double>(totals.size());
  double sum = 0.0, squares = 0.0;
  for (const double one : totals) {
    sum += one;
    squares += one * one;
  }
  return {sum / answers, std::sqrt(std::max(0.0, squares - sum * sum / n) / (n - 1.0) * n) / answers};
}

}  // namespace

PredictionReport predict_answers(const std::vector<RecordedWorld>& worlds,
                                 const std::vector<RecordedResponse>& responses, const ParallelOptions& parallel) {
  std::map<std::string, std::size_t> number_of;
  std::vector<AskedWorld> asked;
  asked.reserve(worlds.size());
  std::map<std::string, WorldFamily> by_name;
  for (const auto& world : worlds) {
    number_of.emplace(world.id, asked.size());
    asked.emplace_back(world);
    by_name[world.family].add(asked.size() - 1, asked.back());
  }
  std::vector<WorldFamily> families;
  for (auto& [name, family] : by_name) {
    family.finish();
    families.push_back(family);
  }
  std::map<std::size_t, std::vector<AskedOf>> by_person;
  for (const auto& response : responses) {
    const auto world = number_of.find(response.world);
    if (world == number_of.end()) {
      throw Error{{detail::fault("E0702", "there is no world '" + response.world + "'", "", response.line)}};
    }
    by_person[response.participant].push_back({world->second, response.optimal});
  }
  AskedOfPeople people;
  for (auto& [person, answers] : by_person) people.push_back(std::move(answers));
  constexpr std::size_t kFewest = 3;
  if (people.size() < kFewest) {
    auto diagnostic = detail::fault("E0710", "there are fewer than three people", "", 0);
    diagnostic.infeasible = true;
    throw Error{{diagnostic}};
  }

  const auto tables = tables_of_kinds(families, asked.size());
  std::vector<std::vector<std::vector<double>>> likelihoods;
  for (const auto& table : tables) likelihoods.push_back(likelihoods_of(table, people));
  std::vector<std::string> names{"everybody", "person", "difficulty", "Rasch"};
  for (const auto& table : tables) names.push_back(table.name);

  PredictionReport report;
  std::vector<RaschTable> rasch(std::min(kFolds, people.size()));
  report.complete = for_each_index(rasch.size(), parallel,
                                   [&](std::size_t fold) { rasch[fold] = rasch_without(people, fold, asked.size()); });
  if (!report.complete) return report;
  std::vector<std::vector<std::vector<double>>> predictions(people.size());  // shape [people][models][answers]
  report.complete = for_each_index(people.size(), parallel, [&](std::size_t person) {
    const HeldOut others{people, person, asked.size()};
    auto& own = predictions[person];
    own = {others.everybody(), others.running(), others.difficulty()};
    const auto& fold = rasch[person % kFolds];
    own.push_back(one_after_the_other(fold.table, fold.shares, people[person]));
    for (std::size_t t = 0; t < tables.size(); ++t) {
      own.push_back(predicted_by(tables[t], likelihoods[t], person, people[person]));
    }
  });
  if (!report.complete) return report;

  report.people = people.size();
  report.answers = responses.size();
  const auto num_answers = static_cast<double>(responses.size());
  std::vector<std::vector<double>> losses(names.size());  // shape [models][people]
  for (std::size_t m = 0; m < names.size(); ++m) {
    auto& model = report.models.emplace_back();
    model.model = names[m];
    std::vector<std::pair<double, bool>> all;
    for (std::size_t person = 0; person < people.size(); ++person) {
      double loss = 0.0;
      for (std::size_t i = 0; i < people[person].size(); ++i) {
        loss -= log_of(predictions[person][m][i], people[person][i].right);
        all.emplace_back(predictions[person][m][i], people[person][i].right);
      }
      losses[m].push_back(loss);
    }
    std::tie(model.log_loss, model.log_loss_se) = per_answer(losses[m], num_answers);
    model.area = area_under_curve(all);
    model.calibration = calibration_of(all);
  }
  const auto filter = static_cast<std::size_t>(std::find(names.begin(), names.end(), "bayesian") - names.begin());
  for (std::size_t m = 0; m < names.size(); ++m) {
    std::vector<double> differences;
    for (std::size_t person = 0; person < people.size(); ++person) {
      differences.push_back(losses[m][person] - losses[filter][person]);
    }
    std::tie(report.models[m].difference, report.models[m].difference_se) = per_answer(differences, num_answers);
  }
  for (std::size_t person = 0; person < people.size(); ++person) {
    std::size_t best = 0;
    for (std::size_t m = 1; m < names.size(); ++m) best = losses[m][person] < losses[best][person] ? m : best;
    ++report.models[best].best_for;
  }
  return report;
}

}  // namespace kith
