// Weights that explain what a robot does.
#include "kith/bec/inference.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "kith/bec/comparison.hpp"
#include "kith/core/error.hpp"
#include "kith/geometry/cover.hpp"
#include "kith/mdp/behaviour.hpp"
#include "robot_plan.hpp"

namespace kith {
namespace {

constexpr double kTolerance = 1e-9;              // as that of behave()
constexpr double kLeastExplained = 0.5;          // of a policy that is explained at all
constexpr double kMostChance = 0.05;             // that a robot that acts at random is explained as well
constexpr std::size_t kMostPlanned = 4'000'000;  // states, in looking for the best of the weights that cover the prior
constexpr std::size_t kFewestLooks = 32, kMostLooks = 512;  // of those
constexpr std::size_t kLooksImproved = 6;                   // how many of them
constexpr std::size_t kMostImprovements = 40;
constexpr std::size_t kMostClashes = 3;
constexpr std::uint32_t kNoChoice = 0xFFFFFFFF;

using Weights = std::vector<double>;

Weights as_weights(const Direction& w) { return {w.data(), w.data() + w.size()}; }

double margin_of(const HalfSpace& half_space, const Weights& w) {
  double length = 0.0;
  for (const std::int64_t x : half_space.normal()) length += static_cast<double>(x) * static_cast<double>(x);
  return dot(half_space.normal(), std::span{w}) / std::sqrt(length);
}

Weights at_length_1(Weights w) {
  const double length = std::sqrt(std::inner_product(w.begin(), w.end(), w.begin(), 0.0));
  for (double& x : w) x /= length;
  return w;
}

double margin_of(const Cone& region, const Weights& w) {
  double least = 1.0;
  for (const HalfSpace& facet : region.facets()) least = std::min(least, margin_of(facet, w));
  return least;
}

// The middle of the extreme rays, or any direction inside.
Weights centre_of(const Cone& region) {
  Weights sum(region.dimension(), 0.0);
  for (const IntegerVector& ray : region.generators()) {
    double length = 0.0;
    for (const std::int64_t x : ray) length += static_cast<double>(x) * static_cast<double>(x);
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += static_cast<double>(ray[k]) / std::sqrt(length);
  }
  const double size =
      *std::max_element(sum.begin(), sum.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  if (std::abs(size) > kTolerance && margin_of(region, at_length_1(sum)) > 0.0) return at_length_1(sum);
  const IntegerVector inside = region.interior_direction();
  for (std::size_t k = 0; k < sum.size(); ++k) sum[k] = static_cast<double>(inside[k]);
  return at_length_1(sum);
}

// Nearly the same direction, with as few digits as leave most of the margin.
Weights rounded(const Weights& w, const Cone& region) {
  const double margin = margin_of(region, w);
  for (double unit = 100.0; unit < 1e9; unit *= 10.0) {
    Weights few;
    bool some = false;
    for (const double x : w) {
      few.push_back(std::round(x * unit) / unit + 0.0);
      some = some || few.back() != 0.0;
    }
    if (some && margin_of(region, at_length_1(few)) > 0.9 * margin) return few;
  }
  return w;
}

// How well some weights explain the policy, and what is best under them.
struct Look {
  Weights weights;
  double share = -1.0;  // < 0: there is no finite optimum
  double loss = 0.0;
  std::vector<Behaviour> plans;  // per MDP

  [[nodiscard]] bool is_better_than(const Look& other) const {
    return share != other.share ? share > other.share : loss < other.loss;
  }
};

class PolicyInference {
 public:
  PolicyInference(const Domain& domain, const ObservedPolicy& policy)
      : domain_{domain}, policy_{policy}, prior_{domain.num_features()} {
    if (!prior_.clip(domain.prior())) throw std::logic_error{"infer_weights: the prior has no interior"};
    find_likeliest();
  }

  WeightInference infer() {
    WeightInference result;
    std::optional<Look> found;
    std::optional<Cone> region = optimal_region();
    if (region) {
      found = looked_at(rounded(centre_of(*region), *region));
      if (found->share < 0.0) found.reset();
    }
    result.is_optimal = found && is_all(found->share);
    if (!found || !explains_all_likeliest(*found)) {
      region.reset();
      found = search();
      result.is_optimal = is_all(found->share);
    }
    if (!result.is_optimal) refuse_chance(*found);
    if (!region) {
      region = region_of(*found);
      auto better = looked_at(rounded(centre_of(*region), *region));
      if (better.share >= found->share) found = std::move(better);
    }
    if (*region == prior_) refuse_indifference();

    result.weights = found->weights;
    result.margin = margin_of(*region, at_length_1(found->weights));
    result.share = found->share;
    result.loss = found->loss;
    result.num_seen = num_seen_;
    result.unexplained = unexplained(*found);
    describe_sides(*found, *region, result);
    describe_clashes(*found, *region, result);
    result.left_out = left_out(*found);
    result.region = *std::move(region);
    if (result.left_out.size() >= domain_.num_starts()) refuse_starts(result);
    return result;
  }

 private:
  static bool is_all(double share) { return share > 1.0 - kTolerance; }

  [[nodiscard]] const Mdp& mdp(std::size_t m) const { return domain_.mdp(MdpIndex{m}); }
  [[nodiscard]] bool is_seen(std::size_t m, std::size_t s) const { return policy_.is_seen[m][s]; }

  // --- the policy ---

  void find_likeliest() {
    const auto wrong = [] { throw std::invalid_argument{"infer_weights: the policy is not one of this domain"}; };
    if (policy_.probability.size() != domain_.num_mdps() || policy_.is_seen.size() != domain_.num_mdps()) wrong();
    for (std::size_t m = 0; m < domain_.num_mdps(); ++m) {
      const auto n = mdp(m).num_states();
      if (policy_.probability[m].size() != mdp(m).num_choices() || policy_.is_seen[m].size() != n) wrong();
      auto& likeliest = likeliest_.emplace_back(n, kNoChoice);
      for (std::size_t s = 0; s < n; ++s) {
        num_states_ += 1;
        if (!is_seen(m, s)) continue;
        num_seen_ += 1;
        const auto first =
            policy_.probability[m].begin() + static_cast<std::ptrdiff_t>(mdp(m).first_choice(StateIndex{s}));
        const auto last = first + static_cast<std::ptrdiff_t>(mdp(m).choices(StateIndex{s}).size());
        const auto at = std::max_element(first, last);
        const double other = 1.0 - std::accumulate(first, last, 0.0);  // of what is no choice
        if (at != last && *at > 0.0 && *at >= other) likeliest[s] = static_cast<std::uint32_t>(at - first);
      }
    }
    if (num_seen_ == 0) wrong();
  }

  // Exactly, if the policy is known everywhere; nothing if it is not, or has none.
  [[nodiscard]] std::optional<Cone> optimal_region() {
    Cone region = prior_;
    for (std::size_t m = 0; m < domain_.num_mdps(); ++m) {
      if (std::find(likeliest_[m].begin(), likeliest_[m].end(), kNoChoice) != likeliest_[m].end()) return std::nullopt;
      const auto counts = count_policy(mdp(m), likeliest_[m], domain_.count_scale());
      if (!counts) return std::nullopt;
      for (std::size_t s = 0; s < likeliest_[m].size(); ++s) {
        for (const HalfSpace& half_space : demands(m, s, *counts, likeliest_[m][s])) {
          if (!region.implies(half_space) && !region.clip(half_space)) return std::nullopt;
        }
      }
    }
    return region;
  }

  // What makes a choice as good as all others, if what comes after it counts so much.
  [[nodiscard]] std::vector<HalfSpace> demands(std::size_t m, std::size_t s, const std::vector<IntegerVector>& counts,
                                               std::size_t taken) const {
    const auto choices = mdp(m).choices(StateIndex{s});
    const auto rest = [&](StateIndex next) -> const IntegerVector& { return counts[next.value()]; };
    const auto own = counts_of(mdp(m), choices[taken], domain_.count_scale(), rest);
    std::vector<HalfSpace> result;
    for (std::size_t c = 0; c < choices.size(); ++c) {
      if (c == taken) continue;
      const auto half_space =
          preference(own - counts_of(mdp(m), choices[c], domain_.count_scale(), rest), domain_.count_scale());
      if (half_space) result.push_back(*half_space);
    }
    return result;
  }

  // --- looking at weights ---

  [[nodiscard]] static double worth(const Mdp& mdp, const Behaviour& plan, const Weights& w, const Choice& choice) {
    double value = 0.0;
    for (const Outcome& outcome : mdp.outcomes(choice)) {
      const auto phi = mdp.features(outcome);
      value += outcome.probability * (std::inner_product(w.begin(), w.end(), phi.begin(), 0.0) +
                                      mdp.discount() * plan.values[outcome.next.value()]);
    }
    return value;
  }

  [[nodiscard]] static double slack(double value) { return kTolerance * std::max(1.0, std::abs(value)); }

  [[nodiscard]] bool is_best(const Look& look, std::size_t m, std::size_t s, std::uint32_t choice) const {
    if (choice == kNoChoice) return false;
    const double value = look.plans[m].values[s];
    const auto at_1 = at_length_1(look.weights);
    return worth(mdp(m), look.plans[m], at_1, mdp(m).choices(StateIndex{s})[choice]) >= value - slack(value);
  }

  [[nodiscard]] bool is_explained(const Look& look, std::size_t m, std::size_t s) const {
    return is_seen(m, s) && is_best(look, m, s, likeliest_[m][s]);
  }

  [[nodiscard]] bool explains_all_likeliest(const Look& look) const {
    for (std::size_t m = 0; m < domain_.num_mdps(); ++m) {
      for (std::size_t s = 0; s < likeliest_[m].size(); ++s) {
        if (is_seen(m, s) && !is_explained(look, m, s)) return false;
      }
    }
    return true;
  }

  [[nodiscard]] Look looked_at(Weights weights) {
    Look look;
    look.weights = std::move(weights);
    const auto w = at_length_1(look.weights);
    for (std::size_t m = 0; m < domain_.num_mdps(); ++m) {
      auto plan = behave(mdp(m), w, {.scale = domain_.count_scale()});
      if (!plan) return look;
      look.plans.push_back(*std::move(plan));
    }
    double share = 0.0;
    std::uint64_t hash = 0xCBF29CE484222325ull;
    for (std::size_t m = 0; m < domain_.num_mdps(); ++m) {
      for (std::size_t s = 0; s < likeliest_[m].size(); ++s) {
        hash = (hash ^ look.plans[m].choice[s]) * 0x100000001B3ull;
        if (is_seen(m, s)) share += share_at(look, m, s, w);
      }
    }
    look.share = share / static_cast<double>(num_seen_);
    look.loss /= static_cast<double>(num_seen_);
    behaviours_.insert(hash);
    return look;
  }

  [[nodiscard]] double share_at(Look& look, std::size_t m, std::size_t s, const Weights& w) const {
    const auto choices = mdp(m).choices(StateIndex{s});
    const auto first = mdp(m).first_choice(StateIndex{s});
    const double value = look.plans[m].values[s];
    double share = 0.0;
    for (std::size_t c = 0; c < choices.size(); ++c) {
      const double probability = policy_.probability[m][first + c];
      if (probability == 0.0) continue;
      const double lost = value - worth(mdp(m), look.plans[m], w, choices[c]);
      if (lost <= slack(value)) {
        share += probability;
      } else {
        look.loss += probability * lost;
      }
    }
    return share;
  }

  // --- search ---

  [[nodiscard]] Look search() {
    const auto n = std::clamp(kMostPlanned / std::max<std::size_t>(num_states_, 1), kFewestLooks, kMostLooks);
    const Eigen::MatrixXd points = cover(prior_, n);
    std::vector<Look> looks;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      auto look = looked_at(as_weights(points.col(i)));
      if (look.share >= 0.0) insert(looks, std::move(look));
    }
    if (looks.empty()) {
      throw Error{ErrorKind::kInfeasible, "no weights were found for which what is best is finite",
                  Advice{"set a discount below 1 in [mdp], or give actions a cost that everybody knows under [prior]"}};
    }
    Look best = looks.front();
    for (Look& look : looks) {
      auto improved = improve(std::move(look));
      if (improved.is_better_than(best)) best = std::move(improved);
    }
    return best;
  }

  // Keeps the best few.
  static void insert(std::vector<Look>& looks, Look look) {
    const auto at =
        std::find_if(looks.begin(), looks.end(), [&](const Look& other) { return look.is_better_than(other); });
    if (at == looks.end() && looks.size() >= kLooksImproved) return;
    looks.insert(at, std::move(look));
    if (looks.size() > kLooksImproved) looks.pop_back();
  }

  [[nodiscard]] Look improve(Look look) {
    for (std::size_t round = 0; round < kMostImprovements; ++round) {
      auto next = looked_at(centre_of(most_satisfied(look)));
      if (next.share < 0.0 || !next.is_better_than(look)) break;
      look = std::move(next);
    }
    return look;
  }

  struct Demand {
    double margin;
    std::vector<HalfSpace> half_spaces;
  };

  // Clips the prior by what states demand, from the state that is satisfied best on; those that leave nothing do not
  // count. What comes later is best under the weights of the look.
  [[nodiscard]] Cone most_satisfied(const Look& look) const {
    std::vector<Demand> all;
    std::unordered_set<HalfSpace> met;
    for (std::size_t m = 0; m < domain_.num_mdps(); ++m) {
      for (std::size_t s = 0; s < likeliest_[m].size(); ++s) {
        if (likeliest_[m][s] == kNoChoice) continue;
        Demand demand{1.0, demands(m, s, look.plans[m].counts, likeliest_[m][s])};
        bool is_new = false;
        for (const HalfSpace& half_space : demand.half_spaces) {
          demand.margin = std::min(demand.margin, margin_of(half_space, look.weights));
          is_new = met.insert(half_space).second || is_new;
        }
        if (is_new) all.push_back(std::move(demand));
      }
    }
    std::stable_sort(all.begin(), all.end(), [](const Demand& a, const Demand& b) { return a.margin > b.margin; });
    Cone region = prior_;
    for (const Demand& demand : all) {
      Cone smaller = region;
      if (smaller.clip(demand.half_spaces)) region = std::move(smaller);
    }
    return region;
  }

  // Weights under which what is best under those of the look stays best.
  [[nodiscard]] Cone region_of(const Look& look) const {
    Cone region = prior_;
    for (std::size_t m = 0; m < domain_.num_mdps(); ++m) {
      for (std::size_t s = 0; s < likeliest_[m].size(); ++s) {
        for (const HalfSpace& half_space : demands(m, s, look.plans[m].counts, look.plans[m].choice[s])) {
          if (margin_of(half_space, look.weights) > kTolerance && !region.implies(half_space))
            (void)region.clip(half_space);
        }
      }
    }
    return region;
  }

  // --- what is refused ---

  // The chance that a robot that takes each choice alike does what is best in so many states, for one of the behaviours
  // that were looked at.
  void refuse_chance(const Look& look) const {
    double by_chance = 0.0;
    double explained = 0.0;
    std::size_t count = 0;
    Look copy = look;
    const auto w = at_length_1(look.weights);
    for (std::size_t m = 0; m < domain_.num_mdps(); ++m) {
      for (std::size_t s = 0; s < likeliest_[m].size(); ++s) {
        const auto choices = mdp(m).choices(StateIndex{s}).size();
        if (!is_seen(m, s) || choices < 2) continue;
        std::size_t best = 0;
        for (std::uint32_t c = 0; c < choices; ++c) best += is_best(look, m, s, c) ? 1u : 0u;
        by_chance += static_cast<double>(best) / static_cast<double>(choices);
        explained += share_at(copy, m, s, w);
        ++count;
      }
    }
    const auto n = static_cast<double>(std::max<std::size_t>(count, 1));
    const double p = by_chance / n;
    const double x = std::min(explained / n, 1.0);
    const auto part = [](double a, double b) { return a > 0.0 ? a * std::log(a / b) : 0.0; };
    const double divergence = x <= p || p >= 1.0 ? 0.0 : part(x, p) + part(1.0 - x, 1.0 - p);
    const double chance = std::log(static_cast<double>(behaviours_.size())) - n * divergence;
    if (look.share >= kLeastExplained && chance < std::log(kMostChance)) return;
    const auto percent = [](double part_of) { return std::to_string(std::lround(100.0 * part_of)) + " %"; };
    refuse("E0341",
           "no weights explain what this robot does: the best explain " + percent(look.share) +
               " of it; of a robot that acts at random these weights would explain " + percent(p),
           "check that states and actions are those of the domain; if they are, another feature has to tell apart what "
           "the robot tells apart");
  }

  [[noreturn]] void refuse_indifference() const {
    refuse("E0342", "nothing follows from this policy: whatever it could have done counts the same",
           "give the domain features that differ between actions");
  }

  [[noreturn]] void refuse_starts(const WeightInference& result) const {
    refuse("E0343",
           "from every start the robot meets a state that the weights do not explain (" +
               std::to_string(result.unexplained.size()) + ") or in which it was not seen (" +
               std::to_string(num_states_ - num_seen_) + ")",
           "record whole paths to an end, or add a feature that explains more");
  }

  [[noreturn]] static void refuse(const std::string& id, const std::string& message, const std::string& hint) {
    Diagnostic diagnostic;
    diagnostic.id = id;
    diagnostic.message = message;
    diagnostic.hint = hint;
    diagnostic.infeasible = true;
    throw Error{ErrorKind::kInfeasible, message, {diagnostic}};
  }

  // --- what is told ---

  [[nodiscard]] std::vector<UnexplainedState> unexplained(const Look& look) const {
    std::vector<UnexplainedState> result;
    const auto w = at_length_1(look.weights);
    for (std::size_t m = 0; m < domain_.num_mdps(); ++m) {
      for (std::size_t s = 0; s < likeliest_[m].size(); ++s) {
        if (!is_seen(m, s) || is_explained(look, m, s)) continue;
        const auto choices = mdp(m).choices(StateIndex{s});
        UnexplainedState one{{MdpIndex{m}, StateIndex{s}}, std::nullopt, choices[look.plans[m].choice[s]].action, 0.0};
        if (likeliest_[m][s] != kNoChoice) {
          one.does = choices[likeliest_[m][s]].action;
          one.loss = look.plans[m].values[s] - worth(mdp(m), look.plans[m], w, choices[likeliest_[m][s]]);
        }
        result.push_back(one);
      }
    }
    return result;
  }

  void describe_sides(const Look& look, const Cone& region, WeightInference& result) {
    for (const HalfSpace& facet : region.facets()) result.sides.push_back({facet, 0});
    std::unordered_map<HalfSpace, std::size_t> place;
    for (std::size_t i = 0; i < result.sides.size(); ++i) place.emplace(result.sides[i].half_space, i);
    for (std::size_t m = 0; m < domain_.num_mdps(); ++m) {
      for (std::size_t s = 0; s < likeliest_[m].size(); ++s) {
        if (!is_explained(look, m, s)) continue;
        std::set<std::size_t> shown;
        for (const HalfSpace& half_space : demands(m, s, look.plans[m].counts, likeliest_[m][s])) {
          if (const auto at = place.find(half_space); at != place.end()) shown.insert(at->second);
        }
        for (const std::size_t i : shown) {
          ++result.sides[i].support;
          shown_by_.try_emplace(result.sides[i].half_space, StartId{MdpIndex{m}, StateIndex{s}});
        }
      }
    }
    std::stable_sort(result.sides.begin(), result.sides.end(),
                     [](const RegionSide& a, const RegionSide& b) { return a.support < b.support; });
  }

  void describe_clashes(const Look& look, const Cone& region, WeightInference& result) const {
    auto worst = result.unexplained;
    std::stable_sort(worst.begin(), worst.end(),
                     [](const UnexplainedState& a, const UnexplainedState& b) { return a.loss > b.loss; });
    for (const UnexplainedState& one : worst) {
      if (!one.does || result.clashes.size() >= kMostClashes) break;
      const auto m = one.state.mdp.value();
      const auto s = one.state.start.value();
      std::vector<HalfSpace> wanted;
      for (const HalfSpace& half_space : demands(m, s, look.plans[m].counts, likeliest_[m][s])) {
        if (margin_of(half_space, look.weights) < 0.0) wanted.push_back(half_space);
      }
      if (wanted.empty()) continue;
      std::vector<HalfSpace> all{region.facets().begin(), region.facets().end()};
      all.push_back(wanted.front());
      auto conflict = irreducible_conflict(all);
      if (conflict.empty()) continue;
      std::rotate(conflict.begin(), std::find(conflict.begin(), conflict.end(), wanted.front()), conflict.end());
      Clash clash{{one.state}, conflict};
      for (const HalfSpace& half_space : conflict) {
        const auto at = shown_by_.find(half_space);
        if (at == shown_by_.end()) continue;
        if (std::find(clash.states.begin(), clash.states.end(), at->second) == clash.states.end())
          clash.states.push_back(at->second);
      }
      result.clashes.push_back(std::move(clash));
    }
  }

  // From the states that are not explained or not seen back to all from which the robot, or what is best, most likely
  // comes there: these are the paths that are shown.
  [[nodiscard]] std::vector<StartId> left_out(const Look& look) const {
    std::vector<StartId> result;
    for (std::size_t m = 0; m < domain_.num_mdps(); ++m) {
      const auto& best = look.plans[m].choice;
      auto own = likeliest_[m];
      for (std::size_t s = 0; s < own.size(); ++s) own[s] = own[s] == kNoChoice ? best[s] : own[s];
      std::vector<std::vector<std::uint32_t>> into(own.size());
      for (const auto& next : {likeliest_next(mdp(m), own), likeliest_next(mdp(m), best)}) {
        for (std::uint32_t s = 0; s < next.size(); ++s) {
          if (next[s] < into.size()) into[next[s]].push_back(s);
        }
      }
      std::vector<bool> is_out(own.size(), false);
      std::vector<std::uint32_t> queue;
      for (std::uint32_t s = 0; s < is_out.size(); ++s) {
        if (is_explained(look, m, s)) continue;
        is_out[s] = true;
        queue.push_back(s);
      }
      while (!queue.empty()) {
        const auto s = queue.back();
        queue.pop_back();
        for (const std::uint32_t from : into[s]) {
          if (is_out[from]) continue;
          is_out[from] = true;
          queue.push_back(from);
        }
      }
      for (const StateIndex start : domain_.starts(MdpIndex{m})) {
        if (is_out[start.value()]) result.push_back({MdpIndex{m}, start});
      }
    }
    return result;
  }

  const Domain& domain_;
  const ObservedPolicy& policy_;
  Cone prior_;
  std::vector<std::vector<std::uint32_t>> likeliest_;  // per MDP and state: a position in choices
  std::size_t num_states_ = 0;
  std::size_t num_seen_ = 0;
  std::unordered_set<std::uint64_t> behaviours_;  // that were looked at
  std::unordered_map<HalfSpace, StartId> shown_by_;
};

}  // namespace

WeightInference infer_weights(const Domain& domain, const ObservedPolicy& policy) {
  if (domain.num_features() < 2) {
    throw Error{ErrorKind::kInfeasible, "domain '" + domain.id() + "' has a single feature: there is nothing to weigh"};
  }
  return PolicyInference{domain, policy}.infer();
}

}  // namespace kith
