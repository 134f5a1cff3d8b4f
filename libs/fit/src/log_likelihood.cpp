#include "kith/fit/log_likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include "kith/belief/prior_cover.hpp"
#include "kith/learners/bayesian_learner.hpp"

namespace kith {
namespace {

EvidenceForm evidence_form(const KnownLearner& model) {
  const bool is_planned = model.atlas && !model.atlas->find_tables();
  return is_planned || model.prior.dimension() != 3 ? EvidenceForm::kAsGiven : EvidenceForm::kMinimal;
}

void require_answer_regions(const ResponseLogs& logs) {
  for (const auto& person : logs.people) {
    for (const auto& period : person.periods) {
      if (period.given.size() <= period.answers.size()) continue;
      throw std::invalid_argument{"log_likelihoods: call find_answer_regions() first, as there are no tables of paths"};
    }
  }
}

// One run of the filter of one person, for all points of the grid.
class Replay {
 public:
  Replay(const PersonLog& person, const KnownLearner& model, const ParameterGrid& grid, double slip,
         RandomStream random)
      : person_{person}, model_{model}, slip_{slip}, random_{random} {
    const double ability_max = model.parameters.real("ability_max");
    const double ability_scale = model.parameters.real("ability_scale");
    for (std::size_t i = 0; i < grid.size(); ++i) {
      const auto point = grid.point(i);
      people_.push_back({.ability = std::min(point.ability, ability_max),
                         .confirm_gain = point.confirm_gain,
                         .correct_gain = point.correct_gain,
                         .ability_max = ability_max,
                         .ability_scale = ability_scale});
    }
    const auto form = evidence_form(model);
    for (const auto& period : person.periods) {
      answers_.emplace_back(period.possible, period.answers, period.chance, form);
    }
    log_likelihood.resize(grid.size());
  }

  void run(const PriorCover& cover) {
    const FilterOptions filter{.particles = num_particles(model_.parameters),
                               .process_noise = model_.parameters.real("process_noise")};
    std::map<double, Group> groups;
    for (std::size_t i = 0; i < people_.size(); ++i) groups[people_[i].ability].push_back(i);
    for (const auto& [ability, group] : groups) {
      BayesianLearner learner{ParticleBelief{cover, filter}, people_[group.front()], model_.form, random_};
      learner.begin_component();
      teach(0, std::move(learner), 0.0, group);
    }
  }

  std::vector<double> log_likelihood;  // shape [grid]

 private:
  using Group = std::vector<std::size_t>;  // points that have had the same abilities so far: one learner stands for all

  // From period t on. The learner is this group's own, and one of its points. Recursion is at most as deep as there are
  // periods.
  void teach(std::size_t t, BayesianLearner learner, double log_probability, const Group& group) {
    if (t == person_.periods.size()) {
      for (const auto i : group) log_likelihood[i] = log_probability;
      return;
    }
    const auto& period = person_.periods[t];
    learner.watch(period.conveyed, t);
    log_probability += kith::log_likelihood(learner, answers_[t], slip_);
    if (!period.feedback) return go_on(t + 1, std::move(learner), log_probability, group);
    for (const auto& [ability, same] : by_next_ability(learner, period.all_correct, group)) {
      auto own = learner;
      own.become(people_[same.front()]);
      own.hear_feedback(period.all_correct, period.taught, t);
      go_on(t + 1, std::move(own), log_probability, same);
    }
  }

  // A new component sets the ability back to that at the start, which is the same for all points of a group: groups
  // never become one again.
  void go_on(std::size_t t, BayesianLearner learner, double log_probability, const Group& group) {
    if (t < person_.periods.size() && person_.periods[t].component != person_.periods[t - 1].component) {
      learner.begin_component();
    }
    teach(t, std::move(learner), log_probability, group);
  }

  [[nodiscard]] std::map<double, Group> by_next_ability(const BayesianLearner& learner, bool all_correct,
                                                        const Group& group) const {
    std::map<double, Group> groups;
    for (const auto i : group) groups[learner.ability_after(all_correct, people_[i])].push_back(i);
    return groups;
  }

  const PersonLog& person_;
  const KnownLearner& model_;
  double slip_;
  RandomStream random_;
  std::vector<AnswerEvidence> answers_;  // shape [periods]
  std::vector<BayesianPerson> people_;   // shape [grid]
};

// Of log_mean(), by the spread of what it averages.
double standard_error(const std::vector<double>& logs) {
  const auto n = static_cast<double>(logs.size());
  const double top = *std::max_element(logs.begin(), logs.end());
  double sum = 0.0, squares = 0.0;
  for (const double x : logs) {
    const double share = std::exp(x - top);
    sum += share;
    squares += share * share;
  }
  if (logs.size() < 2) return 0.0;
  const double mean = sum / n;
  return std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1.0)) / mean;
}

double log_mean(const std::vector<double>& logs) {
  const double top = *std::max_element(logs.begin(), logs.end());
  double sum = 0.0;
  for (const double x : logs) sum += std::exp(x - top);
  return top + std::log(sum / static_cast<double>(logs.size()));
}

std::vector<double> equally_spaced(double first, double last, std::size_t n) {
  std::vector<double> values;
  for (std::size_t i = 0; i < n; ++i) {
    values.push_back(first + (last - first) * static_cast<double>(i) / static_cast<double>(n - 1));
  }
  return values;
}

}  // namespace

ParameterPoint ParameterGrid::point(std::size_t i) const {
  const auto n = correct_gains.size();
  const auto m = confirm_gains.size();
  return {abilities[i / (n * m)], confirm_gains[i / n % m], correct_gains[i % n]};
}

ParameterGrid make_grid(double first, double last, std::size_t num_abilities, double gain_last, std::size_t num_gains) {
  if (!(first >= 0.5 && first < last && last <= 1.0)) {
    throw std::invalid_argument{"make_grid: 0.5 <= first < last <= 1 must hold"};
  }
  if (!(gain_last > 0.0 && gain_last <= 0.5)) throw std::invalid_argument{"make_grid: 0 < gain_last <= 0.5 must hold"};
  if (num_abilities < 2 || num_gains < 2) throw std::invalid_argument{"make_grid: at least 2 values of each"};
  return {equally_spaced(first, last, num_abilities), equally_spaced(0.0, gain_last, num_gains),
          equally_spaced(0.0, gain_last, num_gains)};
}

LikelihoodTable log_likelihoods(const ResponseLogs& logs, const ParameterGrid& grid, const LikelihoodOptions& options) {
  if (options.replicates == 0) throw std::invalid_argument{"log_likelihoods: replicates must be at least 1"};
  if (!(options.slip >= 0.0 && options.slip <= 1.0)) {
    throw std::invalid_argument{"log_likelihoods: slip must lie in [0, 1]"};
  }
  require_answer_regions(logs);
  std::vector<PriorCover> covers;
  covers.reserve(logs.models.size());
  for (const auto& model : logs.models) covers.emplace_back(model.prior, num_particles(model.parameters));

  const std::size_t num_people = logs.people.size();
  const std::size_t num_tasks = num_people * options.replicates;
  std::vector<std::vector<double>> log_likelihood(num_tasks);
  LikelihoodTable table{.grid = grid, .log_likelihood = {}, .standard_error = {}};
  table.complete = for_each_index(num_tasks, options.parallel, [&](std::size_t task) {
    const auto& person = logs.people[task % num_people];
    const auto random = RandomStream{options.seed}.split("fit").split(lessons_of(person)).split(task / num_people);
    Replay replay{person, logs.models.at(person.model), grid, options.slip, random};
    replay.run(covers[person.model]);
    log_likelihood[task] = std::move(replay.log_likelihood);
  });
  if (!table.complete) return table;

  std::vector<double> runs(options.replicates);
  for (std::size_t person = 0; person < num_people; ++person) {
    auto& row = table.log_likelihood.emplace_back(grid.size());
    auto& error = table.standard_error.emplace_back(grid.size());
    for (std::size_t i = 0; i < grid.size(); ++i) {
      for (std::size_t r = 0; r < runs.size(); ++r) runs[r] = log_likelihood[r * num_people + person][i];
      row[i] = log_mean(runs);
      error[i] = standard_error(runs);
    }
  }
  return table;
}

}  // namespace kith
