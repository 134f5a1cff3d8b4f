#include "kith/mdp/policy_partition.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_set>
#include <utility>

#include "checks.hpp"
#include "component_paths.hpp"
#include "kith/core/assert.hpp"
#include "path_follower.hpp"

namespace kith {
namespace {

// By how much, relative to the length of the weights, a part's half-spaces must hold: far more than rounding.
constexpr double kClear = 1e-6;
constexpr std::uint32_t kNone = 0xFFFFFFFFu;

double dot_of(const double* normal, std::span<const double> weights) {
  double sum = 0.0;
  for (std::size_t k = 0; k < weights.size(); ++k) sum += normal[k] * weights[k];
  return sum;
}

}  // namespace

class PolicyPartition::Body {
 public:
  Body(const Mdp& mdp, std::span<const StateIndex> states, std::vector<double> robot_weights,
       const BehaveOptions& options)
      : mdp_{mdp}, states_{states.begin(), states.end()}, robot_{std::move(robot_weights)}, options_{options} {
    detail::require_exact(mdp, robot_.size(), "PolicyPartition");
    has_optima_ = mdp.by_distance().size() == mdp.num_states();
    find_components();
  }

  bool locate(std::span<const double> weights, bool may_grow) {
    detail::require_weights(mdp_, weights, "PolicyPartition");
    if (!has_optima_) return false;
    weights_ = weights;
    may_grow_ = may_grow;
    double square = 0.0;
    for (const double w : weights) square += w * w;
    clear_by_ = kClear * std::sqrt(square);
    for (std::size_t i = 0; i < gains_.size(); i += weights.size()) {
      if (dot_of(&gains_[i], weights) > clear_by_) return false;
    }
    rewards_.clear();
    follower_.reset();
    paths_.reset();
    loose_.clear();
    key_.clear();
    is_kept_ = true;
    for (std::size_t c = 0; c < components_.size(); ++c) {
      if (!(components_[c].is_alone ? step(c) : enter(c))) return false;
    }
    if (!is_kept_) key_.clear();
    return true;
  }

  [[nodiscard]] IntegerVector counts(std::size_t i) const {
    auto result = counts_at(states_[i].value());
    for (std::size_t k = 0; k < result.size(); ++k) result[k] *= options_.scale;
    return result;
  }

  [[nodiscard]] std::span<const std::uint32_t> key() const noexcept { return key_; }
  [[nodiscard]] std::size_t num_parts() const noexcept { return num_parts_; }
  [[nodiscard]] std::size_t memory() const noexcept { return bytes_; }

  void clear() {
    for (auto& component : components_) component.cases.clear();
    gains_.clear();
    known_gains_.clear();
    num_parts_ = 0;
    bytes_ = 0;
  }

 private:
  struct IntsHash {
    std::size_t operator()(const std::vector<std::int64_t>& ints) const noexcept {
      std::uint64_t hash = 0xCBF29CE484222325ull;
      for (const auto i : ints) {
        hash = (hash ^ static_cast<std::uint64_t>(i)) * 0xFF51AFD7ED558CCDull;
        hash ^= hash >> 32;
      }
      return static_cast<std::size_t>(hash);
    }
  };
  // The weights inside all half-spaces do the same within a component.
  struct Part {
    std::vector<double> normals;       // row-major, shape [n, d]: primitive
    std::vector<double> reach;         // the largest |counts_k| of any state, shape [d]
    std::vector<std::int64_t> counts;  // of the kept states, less those of the first exit; row-major, shape [kept, d]
    std::uint32_t number = 0;          // within the component
  };
  // What is known of a component for one list of differences between the counts of its exits.
  struct Case {
    std::vector<double> sums;  // per part: the sum of the counts of all states, row-major, shape [parts, d]
    std::vector<std::unique_ptr<Part>> parts;
  };
  struct Component {
    std::vector<std::uint32_t> exits;  // the states outside that its choices lead to, each once
    std::vector<std::uint32_t> kept;   // those of its states whose counts matter outside
    bool is_alone = false;             // a single state
    std::uint32_t num_parts = 0;
    std::unordered_map<std::vector<std::int64_t>, Case, IntsHash> cases;
  };
  // Where the weights of the last locate() lie in a component.
  struct Place {
    const Part* part = nullptr;
    IntegerVector base;  // the counts of the first exit, or of the only state
  };

  void find_components() {
    const auto starts = mdp_.component_starts();
    const auto by_component = mdp_.by_component();
    components_.resize(starts.empty() ? 0 : starts.size() - 1);
    places_.resize(components_.size());
    component_of_.assign(mdp_.num_states(), 0);
    kept_place_.assign(mdp_.num_states(), kNone);
    std::vector<bool> matters(mdp_.num_states(), false);
    for (const StateIndex s : states_) matters[s.value()] = true;
    for (std::size_t c = 0; c < components_.size(); ++c) {
      for (std::size_t i = starts[c]; i < starts[c + 1]; ++i) {
        component_of_[by_component[i].value()] = static_cast<std::uint32_t>(c);
      }
    }
    for (std::size_t c = 0; c < components_.size(); ++c) {
      auto& component = components_[c];
      component.is_alone = starts[c + 1] - starts[c] == 1;
      for (const StateIndex s : members(c)) {
        for (const Choice& choice : mdp_.choices(s)) {
          const StateIndex next = mdp_.outcomes(choice).front().next;
          if (!mdp_.is_terminal(next) && component_of_[next.value()] == c) continue;
          component.exits.push_back(static_cast<std::uint32_t>(next.value()));
          if (!mdp_.is_terminal(next)) matters[next.value()] = true;
        }
      }
      std::sort(component.exits.begin(), component.exits.end());
      component.exits.erase(std::unique(component.exits.begin(), component.exits.end()), component.exits.end());
    }
    for (std::size_t c = 0; c < components_.size(); ++c) {
      for (const StateIndex s : members(c)) {
        if (!matters[s.value()]) continue;
        kept_place_[s.value()] = static_cast<std::uint32_t>(components_[c].kept.size());
        components_[c].kept.push_back(static_cast<std::uint32_t>(s.value()));
      }
    }
  }

  [[nodiscard]] std::span<const StateIndex> members(std::size_t c) const {
    const auto starts = mdp_.component_starts();
    return mdp_.by_component().subspan(starts[c], starts[c + 1] - starts[c]);
  }

  // Of a state that matters, in a component that was located.
  [[nodiscard]] IntegerVector counts_at(std::size_t s) const {
    if (s >= mdp_.num_states()) return IntegerVector(mdp_.num_features());
    const auto& place = places_[component_of_[s]];
    auto result = place.base;
    if (place.part == nullptr) return result;
    const std::size_t d = mdp_.num_features();
    const std::int64_t* const own = &place.part->counts[kept_place_[s] * d];
    for (std::size_t k = 0; k < d; ++k) result[k] += own[k];
    return result;
  }

  // By how much half-spaces must hold where counts reach so far: then a choice is clearly better than another one.
  [[nodiscard]] double clearance(double largest_value) const {
    return std::max(clear_by_, 4.0 * options_.tolerance * std::max(1.0, largest_value));
  }

  // A component of one state: its best choice.
  bool step(std::size_t c) {
    const StateIndex s = members(c).front();
    const auto choices = mdp_.choices(s);
    ways_.clear();
    double best = 0.0;
    for (const Choice& choice : choices) {
      const Outcome& outcome = mdp_.outcomes(choice).front();
      auto& way = ways_.emplace_back(counts_at(outcome.next.value()), 0.0);
      way.first += mdp_.integer_features(outcome);
      way.second = dot(way.first, weights_);
      best = ways_.size() == 1 ? way.second : std::max(best, way.second);
    }
    std::optional<std::size_t> chosen;
    double earned = 0.0;
    for (std::size_t i = 0; i < ways_.size(); ++i) {
      if (!detail::is_tight(best, ways_[i].second, options_.tolerance)) continue;
      const double robots = dot(ways_[i].first, robot_);
      if (chosen && robots <= earned + options_.tolerance * std::max(1.0, std::abs(earned))) continue;
      chosen = i;
      earned = robots;
    }
    for (std::size_t i = 0; i < ways_.size() && is_kept_; ++i) {
      is_kept_ = ways_[i].second < best - clearance(std::abs(best)) || ways_[i].first == ways_[*chosen].first;
    }
    places_[c] = {nullptr, ways_[*chosen].first};
    key_.push_back(static_cast<std::uint32_t>(*chosen));
    return true;
  }

  // A component of several states: the part that the weights lie in, if it is known, else a plan.
  bool enter(std::size_t c) {
    auto& component = components_[c];
    const std::size_t d = weights_.size();
    const IntegerVector base = counts_at(component.exits.front());
    differences_.clear();
    for (std::size_t e = 1; e < component.exits.size(); ++e) {
      const auto difference = counts_at(component.exits[e]) - base;
      differences_.insert(differences_.end(), difference.begin(), difference.end());
    }
    const auto known = component.cases.find(differences_);
    if (known != component.cases.end()) {
      // Of two behaviours the better one is better or equal everywhere, so the best in sum is the only candidate.
      const auto& sums = known->second.sums;
      std::size_t best = 0;
      double most = 0.0;
      for (std::size_t i = 0; i * d < sums.size(); ++i) {
        const double sum = dot_of(&sums[i * d], weights_);
        if (i > 0 && sum <= most) continue;
        most = sum;
        best = i;
      }
      const Part& part = *known->second.parts[best];
      if (holds(part)) {
        places_[c] = {&part, base};
        key_.push_back(part.number);
        return true;
      }
    }
    return plan(c, base);
  }

  [[nodiscard]] bool holds(const Part& part) const {
    const std::size_t d = weights_.size();
    double largest = 0.0;
    for (std::size_t k = 0; k < d; ++k) largest += part.reach[k] * std::abs(weights_[k]);
    const double least = clearance(largest);
    for (std::size_t i = 0; i < part.normals.size(); i += d) {
      if (!(dot_of(&part.normals[i], weights_) > least)) return false;
    }
    return true;
  }

  bool plan(std::size_t c, const IntegerVector& base) {
    const auto& component = components_[c];
    if (rewards_.empty()) {
      rewards_ = detail::row_rewards(mdp_, weights_);
      paths_.emplace(mdp_, rewards_, options_.tolerance);
      follower_.reset();
      // Whatever is read of it later is written before.
      counts_.resize(mdp_.num_states() + mdp_.num_terminals(), IntegerVector(mdp_.num_features()));
    }
    for (const std::uint32_t exit : component.exits) {
      counts_[exit] = counts_at(exit) - base;
      paths_->set_value(StateIndex{exit}, dot(counts_[exit], weights_));
    }
    const auto found = paths_->solve_component(c);
    if (found == detail::PathsFound::kPositiveCycle) {
      keep_gain(paths_->cycle_features());
      return false;
    }
    if (found == detail::PathsFound::kTightCycle) return false;
    if (!follower_) follower_.emplace(mdp_, rewards_, paths_->values(), options_.tolerance);
    for (const StateIndex s : members(c)) follower_->find_step(s.value());
    for (const std::uint32_t s : paths_->order()) follower_->follow(s, std::span<const double>{robot_}, counts_);
    places_[c] = {keep(c), base};
    return true;
  }

  // A cycle that earns, unless it is known or hardly earns anything.
  void keep_gain(const IntegerVector& features) {
    if (!may_grow_ || !(dot(features, weights_) > clear_by_)) return;
    const auto cycle = primitive(features);
    if (!known_gains_.insert(cycle).second) return;
    for (const std::int64_t x : cycle) gains_.push_back(static_cast<double>(x));
    bytes_ += cycle.size() * sizeof(double) + 2 * sizeof(IntegerVector);
  }

  // The part of what was planned last, with the differences in `differences_`.
  const Part* keep(std::size_t c) {
    auto& component = components_[c];
    const std::size_t d = weights_.size();
    auto part = std::make_unique<Part>();
    for (const std::uint32_t s : component.kept) {
      part->counts.insert(part->counts.end(), counts_[s].begin(), counts_[s].end());
    }
    if (may_grow_ && is_kept_ && bound(c, *part)) {
      auto& known = component.cases[differences_];
      std::vector<double> sum(d, 0.0);
      for (const StateIndex s : members(c)) {
        for (std::size_t k = 0; k < d; ++k) sum[k] += static_cast<double>(counts_[s.value()][k]);
      }
      known.sums.insert(known.sums.end(), sum.begin(), sum.end());
      part->number = component.num_parts++;
      bytes_ += sizeof(Part) + (known.parts.empty() ? sizeof(Case) + differences_.size() * 8 + 64 : 0) +
                (part->normals.size() + 2 * d) * sizeof(double) + part->counts.size() * sizeof(std::int64_t);
      ++num_parts_;
      key_.push_back(part->number);
      return known.parts.emplace_back(std::move(part)).get();
    }
    is_kept_ = false;
    return loose_.emplace_back(std::move(part)).get();
  }

  // The half-spaces that the plan in `counts_` follows from. False unless all hold clearly.
  [[nodiscard]] bool bound(std::size_t c, Part& part) {
    const std::size_t d = weights_.size();
    part.reach.assign(d, 0.0);
    for (const StateIndex s : members(c)) {
      for (std::size_t k = 0; k < d; ++k) {
        part.reach[k] = std::max(part.reach[k], std::abs(static_cast<double>(counts_[s.value()][k])));
      }
    }
    std::unordered_set<IntegerVector> met;
    std::unordered_set<IntegerVector> losses;
    for (const StateIndex s : members(c)) {
      for (const Choice& choice : mdp_.choices(s)) {
        const Outcome& outcome = mdp_.outcomes(choice).front();
        auto loss = counts_[s.value()] - mdp_.integer_features(outcome);
        loss -= counts_[outcome.next.value()];
        if (!loss.is_zero() && met.insert(loss).second) losses.insert(primitive(loss));
      }
    }
    // Those that hold by least first: they are the first to fail elsewhere.
    std::vector<std::pair<double, const IntegerVector*>> by_margin;
    for (const IntegerVector& loss : losses) by_margin.emplace_back(dot(loss, weights_), &loss);
    std::sort(by_margin.begin(), by_margin.end());
    for (const auto& [margin, loss] : by_margin) {
      for (const std::int64_t x : *loss) part.normals.push_back(static_cast<double>(x));
    }
    return holds(part);
  }

  const Mdp& mdp_;
  std::vector<StateIndex> states_;
  std::vector<double> robot_;
  BehaveOptions options_;
  bool has_optima_ = true;  // every state can finish
  std::vector<Component> components_;
  std::vector<std::uint32_t> component_of_;  // shape [num_states]
  std::vector<std::uint32_t> kept_place_;    // shape [num_states]: position in Component::kept
  std::vector<double> gains_;                // cycles that earn for some weights, row-major, shape [n, d]: primitive
  std::unordered_set<IntegerVector> known_gains_;
  std::size_t num_parts_ = 0;
  std::size_t bytes_ = 0;

  // Of the last locate().
  std::span<const double> weights_;
  bool may_grow_ = true;
  bool is_kept_ = true;
  double clear_by_ = kClear;
  std::vector<Place> places_;  // per component
  std::vector<std::uint32_t> key_;
  std::vector<std::unique_ptr<Part>> loose_;  // parts that are not kept
  std::vector<std::int64_t> differences_;
  std::vector<std::pair<IntegerVector, double>> ways_;
  std::vector<double> rewards_;  // empty until something is planned
  std::optional<detail::ComponentPaths> paths_;
  std::optional<detail::PathFollower> follower_;  // of paths_
  std::vector<IntegerVector> counts_;
};

PolicyPartition::PolicyPartition(const Mdp& mdp, std::span<const StateIndex> states, std::vector<double> robot_weights,
                                 const BehaveOptions& options)
    : body_{std::make_unique<Body>(mdp, states, std::move(robot_weights), options)} {}
PolicyPartition::PolicyPartition(PolicyPartition&&) noexcept = default;
PolicyPartition& PolicyPartition::operator=(PolicyPartition&&) noexcept = default;
PolicyPartition::~PolicyPartition() = default;

bool PolicyPartition::locate(std::span<const double> weights, bool may_grow) {
  return body_->locate(weights, may_grow);
}
IntegerVector PolicyPartition::counts(std::size_t i) const { return body_->counts(i); }
std::span<const std::uint32_t> PolicyPartition::key() const noexcept { return body_->key(); }
std::size_t PolicyPartition::num_parts() const noexcept { return body_->num_parts(); }
std::size_t PolicyPartition::memory() const noexcept { return body_->memory(); }
void PolicyPartition::clear() { body_->clear(); }

}  // namespace kith
