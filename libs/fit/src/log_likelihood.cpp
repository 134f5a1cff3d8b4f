#include "kith/fit/log_likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include "kith/belief/prior_cover.hpp"
#include "kith/core/error.hpp"

namespace kith {
namespace {

bool holds(const std::vector<HalfSpace>& half_spaces, const Eigen::Vector3d& w) {
  return std::all_of(half_spaces.begin(), half_spaces.end(), [&](const HalfSpace& h) { return h.contains(w); });
}

// The regions of a period, so that their masses are quickly summed.
struct PeriodRegions {
  std::vector<HalfSpace> possible;              // minimal
  std::vector<HalfSpace> consistent;            // with the answers that lie inside their cones, minimal
  std::vector<std::vector<HalfSpace>> outside;  // cones of the other answers
  bool contradictory = false;                   // no weight gives these answers
};

PeriodRegions regions_of(const LoggedPeriod& period) {
  PeriodRegions regions;
  auto cone = Cone::intersection(period.possible);
  if (!cone) return {.possible = {}, .consistent = {}, .outside = {}, .contradictory = true};
  regions.possible = cone->minimal_set();
  for (const auto& region : period.answers) {
    if (!region.inside) {
      regions.outside.push_back(region.cone);
      continue;
    }
    for (const auto& half_space : region.cone) {
      if (!cone->clip(half_space)) regions.contradictory = true;
    }
  }
  regions.consistent = cone->minimal_set();
  return regions;
}

// The mass of the weights that give exactly the answers.
double consistent_mass(const PeriodRegions& regions, const ParticleBelief& belief) {
  if (regions.contradictory) return 0.0;
  if (regions.outside.empty()) return belief.mass_in(regions.consistent);
  double mass = 0.0;
  const auto weights = belief.weights();
  for (std::size_t i = 0; i < belief.size(); ++i) {
    const auto point = belief.point(i);
    if (weights[i] == 0.0 || !holds(regions.consistent, point)) continue;
    const bool fits = std::none_of(regions.outside.begin(), regions.outside.end(),
                                   [&](const auto& cone) { return holds(cone, point); });
    if (fits) mass += weights[i];
  }
  return mass;
}

// One run of the filter of one person, for all points of the grid.
class Replay {
 public:
  Replay(const PersonLog& person, const LearnerModel& model, const std::vector<HalfSpace>& policy,
         const ParameterGrid& grid, double slip, RandomStream random)
      : person_{person}, model_{model}, policy_{policy}, slip_{slip}, random_{random} {
    for (std::size_t i = 0; i < grid.size(); ++i) {
      points_.push_back(grid.point(i));
      start_.push_back(std::min(points_.back().ability, model.ability_max));
    }
    for (const auto& period : person.periods) regions_.push_back(regions_of(period));
    log_likelihood.resize(grid.size());
    knowledge.resize(grid.size());
  }

  void run(const PriorCover& cover) {
    std::vector<std::size_t> all(points_.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    for (const auto& [ability, group] : by_ability(all, start_)) {
      teach(0, ability, ParticleBelief{cover, model_.filter}, 0.0, group);
    }
  }

  std::vector<double> log_likelihood;  // shape [grid]
  std::vector<double> knowledge;

 private:
  using Group = std::vector<std::size_t>;  // points that have had the same abilities so far

  static std::map<double, Group> by_ability(const Group& group, const std::vector<double>& abilities) {
    std::map<double, Group> groups;
    for (std::size_t j = 0; j < group.size(); ++j) groups[abilities[j]].push_back(group[j]);
    return groups;
  }

  // From period t on. The belief is this group's own.
  void teach(std::size_t t, double ability, ParticleBelief belief, double log_probability, const Group& group) {
    if (t == person_.periods.size()) return finish(belief, log_probability, group);
    const auto& period = person_.periods[t];
    observe(belief, period.conveyed, ability, "watch", t);
    log_probability += log_answer(t, belief);
    std::vector<double> heard;
    for (const auto i : group) {
      const double gain = period.all_correct ? points_[i].confirm_gain : points_[i].correct_gain;
      heard.push_back(period.feedback ? std::min(ability + gain, model_.ability_max) : ability);
    }
    for (const auto& [new_ability, same] : by_ability(group, heard)) {
      auto own = belief;
      observe(own, period.taught, new_ability, "feedback", t);
      begin(t + 1, new_ability, std::move(own), log_probability, same);
    }
  }

  // A new component sets the ability back; points then differ by where they started.
  void begin(std::size_t t, double ability, ParticleBelief belief, double log_probability, const Group& group) {
    const bool same = t == person_.periods.size() || person_.periods[t].component == person_.periods[t - 1].component;
    // All points of a group started at one ability: groups never grow together again.
    teach(t, same ? ability : start_[group.front()], std::move(belief), log_probability, group);
  }

  void finish(const ParticleBelief& belief, double log_probability, const Group& group) {
    const double mass = policy_.empty() ? 0.0 : belief.mass_in(policy_);
    for (const auto i : group) {
      log_likelihood[i] = log_probability;
      knowledge[i] = mass;
    }
  }

  void observe(ParticleBelief& belief, const std::vector<HalfSpace>& half_spaces, double ability, std::string_view what,
               std::size_t t) const {
    constexpr double kSurest = 1.0 - 1e-9;  // certainty could exclude every particle
    const double scaled = std::min(scaled_ability(ability, model_.ability_scale), kSurest);
    const HalfSpaceLikelihood likelihood{scaled, model_.form};
    belief.observe(half_spaces, likelihood, random_.split(what).split(t));
  }

  [[nodiscard]] double log_answer(std::size_t t, const ParticleBelief& belief) const {
    const auto& period = person_.periods[t];
    if (period.answers.empty()) return 0.0;
    const double possible = belief.mass_in(regions_[t].possible);
    if (possible <= 0.0) return 0.0;
    const double share = std::min(consistent_mass(regions_[t], belief) / possible, 1.0);
    return std::log(std::max((1.0 - slip_) * share + slip_ * period.chance, 1e-300));
  }

  const PersonLog& person_;
  const LearnerModel& model_;
  const std::vector<HalfSpace>& policy_;
  double slip_;
  RandomStream random_;
  std::vector<PeriodRegions> regions_;  // shape [periods]
  std::vector<ParameterPoint> points_;  // shape [grid]
  std::vector<double> start_;           // shape [grid]
};

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
  std::vector<PriorCover> covers;
  covers.reserve(logs.models.size());
  for (const auto& model : logs.models) covers.emplace_back(model.prior, model.filter.particles);

  const std::size_t num_people = logs.people.size();
  const std::size_t num_tasks = num_people * options.replicates;
  std::vector<std::vector<double>> log_likelihood(num_tasks);
  std::vector<std::vector<double>> knowledge(num_tasks);
  LikelihoodTable table{.grid = grid, .log_likelihood = {}, .knowledge = {}};
  table.complete = for_each_index(num_tasks, options.parallel, [&](std::size_t task) {
    const auto& person = logs.people[task % num_people];
    const auto random = RandomStream{options.seed}.split("fit").split(person.id).split(task / num_people);
    Replay replay{person, logs.models.at(person.model), logs.policy, grid, options.slip, random};
    replay.run(covers[person.model]);
    log_likelihood[task] = std::move(replay.log_likelihood);
    knowledge[task] = std::move(replay.knowledge);
  });
  if (!table.complete) return table;

  std::vector<double> runs(options.replicates);
  for (std::size_t person = 0; person < num_people; ++person) {
    auto& row = table.log_likelihood.emplace_back(grid.size());
    auto& mass = table.knowledge.emplace_back(grid.size(), 0.0);
    for (std::size_t i = 0; i < grid.size(); ++i) {
      for (std::size_t r = 0; r < runs.size(); ++r) {
        runs[r] = log_likelihood[r * num_people + person][i];
        mass[i] += knowledge[r * num_people + person][i] / static_cast<double>(runs.size());
      }
      row[i] = log_mean(runs);
    }
  }
  return table;
}

}  // namespace kith
