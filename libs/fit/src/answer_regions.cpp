#include "kith/fit/answer_regions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "kith/bec/behaviours.hpp"
#include "kith/belief/prior_cover.hpp"
#include "kith/learners/bayesian_learner.hpp"
#include "open_table.hpp"

namespace kith {
namespace {

constexpr std::array kAbilities{0.55, 0.7, 0.85};  // of the people whose weights are drawn
constexpr double kGain = 0.04;

bool is_planned(const KnownLearner& model) { return model.atlas && !model.atlas->find_tables(); }

// Whether two expectations are the same up to rounding; whole counts must be equal.
bool same_counts(const IntegerVector& a, const IntegerVector& b, std::int64_t scale) {
  if (scale == 1) return a == b;
  constexpr std::int64_t kRounding = 2;
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (std::abs(a[k] - b[k]) > kRounding) return false;
  }
  return true;
}

// What is known of the domain of one atlas: the paths met per test, and cycles that some weights go round for ever.
class Met {
 public:
  explicit Met(std::shared_ptr<const Atlas> atlas) : atlas_{std::move(atlas)}, cycles_(atlas_->domain().num_mdps()) {}

  [[nodiscard]] const Atlas& atlas() const noexcept { return *atlas_; }
  [[nodiscard]] std::int64_t scale() const { return atlas_->domain().count_scale(); }

  // The path as it was met first, or null.
  [[nodiscard]] const IntegerVector* find(StartIndex test, const IntegerVector& counts) const {
    const auto known = paths_.find(test);
    if (known == paths_.end()) return nullptr;
    const auto one = std::find_if(known->second.begin(), known->second.end(),
                                  [&](const IntegerVector& other) { return same_counts(counts, other, scale()); });
    return one == known->second.end() ? nullptr : &*one;
  }
  void add(StartIndex test, const IntegerVector& counts) {
    if (find(test, counts) == nullptr) paths_[test].push_back(counts);
  }
  [[nodiscard]] const std::vector<IntegerVector>& paths(StartIndex test) const { return paths_.at(test); }
  [[nodiscard]] bool has_paths(StartIndex test) const { return paths_.contains(test); }

  // Weights within these half-spaces gain by no cycle that was met.
  [[nodiscard]] const std::vector<HalfSpace>& losing(MdpIndex m) const { return cycles_[m.value()]; }
  void add_cycle(MdpIndex m, const HalfSpace& losing) {
    auto& known = cycles_[m.value()];
    if (std::find(known.begin(), known.end(), losing) == known.end()) known.push_back(losing);
  }

  [[nodiscard]] std::size_t num_paths() const {
    std::size_t n = 0;
    for (const auto& [test, paths] : paths_) n += paths.size();
    return n;
  }

 private:
  std::shared_ptr<const Atlas> atlas_;
  std::map<StartIndex, std::vector<IntegerVector>> paths_;
  std::vector<std::vector<HalfSpace>> cycles_;  // per MDP
};

// The half-space of the weights for which a cycle that these weights gain by earns nothing; nothing where none shows.
std::optional<HalfSpace> losing_cycle(const Mdp& mdp, const Direction& weights) {
  if (!is_exact(mdp)) return std::nullopt;
  constexpr double kFine = 1 << 20;
  IntegerVector rounded(static_cast<std::size_t>(weights.size()));
  for (std::size_t k = 0; k < rounded.size(); ++k) rounded[k] = std::llround(kFine * weights[static_cast<int>(k)]);
  const auto plan = plan_exactly(mdp, rounded);
  if (plan.cycle.empty() || plan.failure == PlanFailure::kNoTerminal) return std::nullopt;
  IntegerVector sum(rounded.size());
  for (std::size_t i = 0; i < plan.cycle.size(); ++i) {
    const auto to = plan.cycle[(i + 1) % plan.cycle.size()];
    const IntegerVector* best = nullptr;
    for (const auto& choice : mdp.choices(plan.cycle[i])) {
      const auto& outcome = mdp.outcomes(choice).front();
      if (outcome.next != to) continue;
      const auto& features = mdp.integer_features(outcome);
      if (best == nullptr || dot(features, rounded) > dot(*best, rounded)) best = &features;
    }
    if (best == nullptr) return std::nullopt;
    sum += *best;
  }
  if (sum.is_zero()) return std::nullopt;
  return HalfSpace{-sum};
}

// What one person's beliefs led to that was not known before.
struct Found {
  std::vector<std::pair<StartIndex, IntegerVector>> paths;
  std::vector<std::pair<MdpIndex, HalfSpace>> cycles;
  std::size_t drawn = 0;
  std::size_t missed = 0;
};

// Plans for weights that one person may hold.
class PersonSample {
 public:
  PersonSample(const Met& met, std::shared_ptr<PartitionStore> store, Found& found)
      : met_{met},
        behaviours_{met.atlas(), Behaviours::kDefaultCells, Behaviours::kDefaultRowBytes,
                    std::make_shared<PolicyPartitions>(std::move(store))},
        found_{found} {}

  void replay(const PersonLog& person, const KnownLearner& model, const PriorCover& cover, double ability,
              std::size_t draws, const RandomStream& random) {
    const FilterOptions filter{.particles = cover.size(), .process_noise = model.parameters.real("process_noise")};
    const BayesianPerson who{.ability = ability,
                             .confirm_gain = kGain,
                             .correct_gain = kGain,
                             .ability_max = model.parameters.real("ability_max"),
                             .ability_scale = model.parameters.real("ability_scale")};
    BayesianLearner learner{ParticleBelief{cover, filter}, who, model.form, random};
    for (std::size_t t = 0; t < person.periods.size(); ++t) {
      const auto& period = person.periods[t];
      if (t == 0 || period.component != person.periods[t - 1].component) learner.begin_component();
      learner.watch(period.conveyed, t);
      const auto& belief = *learner.belief();
      for (const auto& draw : belief.systematic_draws(draws, random.split("draws").split(t))) {
        look(belief.point(draw.index), period.given);
      }
      if (period.feedback) learner.hear_feedback(period.all_correct, period.taught, t);
    }
  }

 private:
  void look(const Direction& weights, const std::vector<GivenAnswer>& tests) {
    if (tests.empty()) return;
    ++found_.drawn;
    const auto cell = behaviours_.locate(weights);
    bool is_known = true;
    for (const auto& test : tests) {
      const auto counts = behaviours_.answer(test.test, cell);
      if (!counts) {
        is_known = look_for_cycle(met_.atlas().id(test.test).mdp, weights) && is_known;
      } else if (met_.find(test.test, *counts) == nullptr) {
        is_known = false;
        found_.paths.emplace_back(test.test, *counts);
      }
    }
    found_.missed += is_known ? 0u : 1u;
  }

  // Whether it was known that these weights have no optimum in a world.
  bool look_for_cycle(MdpIndex m, const Direction& weights) {
    const auto& losing = met_.losing(m);
    if (std::any_of(losing.begin(), losing.end(), [&](const HalfSpace& h) { return !h.contains(weights); }))
      return true;
    if (const auto cycle = losing_cycle(met_.atlas().domain().mdp(m), weights)) found_.cycles.emplace_back(m, *cycle);
    return false;
  }

  const Met& met_;
  Behaviours behaviours_;
  Found& found_;
};

class AnswerRegions {
 public:
  AnswerRegions(ResponseLogs& logs, const AnswerRegionOptions& options) : logs_{logs}, options_{options} {
    covers_.reserve(logs.models.size());
    for (const auto& model : logs.models) {
      covers_.emplace_back(model.prior, num_particles(model.parameters));
      if (!is_planned(model) || met_.contains(model.atlas.get())) continue;
      met_.emplace(model.atlas.get(), Met{model.atlas});
      stores_.emplace(model.atlas.get(), std::make_shared<PartitionStore>(*model.atlas));
    }
  }

  bool run() {
    if (met_.empty()) return true;
    for (std::size_t round = 0; round < options_.rounds; ++round) {
      if (!sample(round)) return false;
      if (static_cast<double>(sample_.missed) <= options_.missed * static_cast<double>(sample_.checked)) break;
    }
    for (const auto& [atlas, met] : met_) sample_.paths += met.num_paths();
    for (auto& person : logs_.people) {
      const auto& model = logs_.models[person.model];
      if (!is_planned(model)) continue;
      for (auto& period : person.periods) fill(period, met_.at(model.atlas.get()));
    }
    if (logs_.sample) sample_ = merged(*logs_.sample, sample_);
    logs_.sample = sample_;
    note_unknown_paths();
    return true;
  }

 private:
  static PathSample merged(const PathSample& a, const PathSample& b) {
    return {a.weights + b.weights, a.paths + b.paths, a.checked + b.checked, a.missed + b.missed};
  }

  bool sample(std::size_t round) {
    std::vector<Found> found(logs_.people.size());
    const bool complete = for_each_index(found.size(), options_.parallel, [&](std::size_t i) {
      const auto& person = logs_.people[i];
      const auto& model = logs_.models[person.model];
      if (!is_planned(model)) return;
      PersonSample one{met_.at(model.atlas.get()), stores_.at(model.atlas.get()), found[i]};
      auto random = RandomStream{options_.seed}.split("paths").split(lessons_of(person)).split(round);
      for (const auto& period : person.periods) {  // by the answers, too: each member of a team looks for other paths
        for (const auto& given : period.given) random = random.split(to_string(given.counts));
      }
      for (std::size_t a = 0; a < kAbilities.size(); ++a) {
        one.replay(person, model, covers_[person.model], kAbilities[a], options_.draws, random.split(a));
      }
    });
    if (!complete) return false;
    sample_.checked = sample_.missed = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      sample_.weights += found[i].drawn;
      sample_.checked += found[i].drawn;
      sample_.missed += found[i].missed;
      if (found[i].drawn == 0) continue;
      auto& met = met_.at(logs_.models[logs_.people[i].model].atlas.get());
      for (const auto& [test, counts] : found[i].paths) met.add(test, counts);
      for (const auto& [m, losing] : found[i].cycles) met.add_cycle(m, losing);
    }
    return true;
  }

  // Of the weights whose best path is this one; no cone if it is the only one.
  static std::vector<HalfSpace> where_best(const Met& met, StartIndex test, const IntegerVector& path) {
    std::vector<HalfSpace> cone;
    for (const auto& other : met.paths(test)) {
      if (other != path) cone.emplace_back(path - other);
    }
    return cone;
  }

  void fill(LoggedPeriod& period, const Met& met) {
    period.answers.clear();
    period.chance = 1.0;
    std::set<HalfSpace> possible;
    for (std::size_t i = 0; i < period.given.size(); ++i) {
      const auto& [test, counts] = period.given[i];
      const auto& losing = met.losing(met.atlas().id(test).mdp);
      possible.insert(losing.begin(), losing.end());
      const auto* path = met.find(test, counts);
      if (options_.detail == AnswerDetail::kPath && path != nullptr) {
        period.answers.push_back({where_best(met, test, *path), true});
        period.chance /= static_cast<double>(met.paths(test).size());
        continue;
      }
      if (options_.detail == AnswerDetail::kPath) ++num_unknown_;
      const auto& robot = met.atlas().feature_counts(test);
      const auto* own = met.find(test, robot);
      const bool has_paths = met.has_paths(test);
      period.answers.push_back(
          {has_paths ? where_best(met, test, own == nullptr ? robot : *own) : std::vector<HalfSpace>{},
           period.given_right[i]});
      period.chance /= 2.0;
    }
    period.possible.assign(possible.begin(), possible.end());
  }

  void note_unknown_paths() {
    if (num_unknown_ == 0) return;
    logs_.notes.push_back(detail::note("W0706",
                                       std::to_string(num_unknown_) +
                                           " answers are paths that none of the weights drawn takes; they count by "
                                           "their verdict",
                                       "", 0));
  }

  ResponseLogs& logs_;
  const AnswerRegionOptions& options_;
  std::vector<PriorCover> covers_;  // per model
  std::map<const Atlas*, Met> met_;
  std::map<const Atlas*, std::shared_ptr<PartitionStore>> stores_;
  PathSample sample_;
  std::size_t num_unknown_ = 0;
};

}  // namespace

bool find_answer_regions(ResponseLogs& logs, const AnswerRegionOptions& options) {
  if (options.draws == 0 || options.rounds == 0) {
    throw std::invalid_argument{"find_answer_regions: draws and rounds must be at least 1"};
  }
  return AnswerRegions{logs, options}.run();
}

}  // namespace kith
