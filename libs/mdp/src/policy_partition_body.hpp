#pragma once

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "checks.hpp"
#include "kith/core/hash.hpp"
#include "kith/mdp/policy_partition.hpp"
#include "normal_set.hpp"
#include "path_values.hpp"

namespace kith {

// The process, its components, and what is known about them. What is known is guarded by a mutex and never removed.
class PolicyPartition::Body {
 public:
  // The weights inside all half-spaces do the same within a component.
  struct Part {
    std::vector<double> normals;       // row-major, shape [n, d]: primitive
    std::vector<double> reach;         // the largest |counts_k| of any state, shape [d]
    std::vector<std::int64_t> counts;  // of the kept states, less those of the first exit; row-major, shape [kept, d]
    std::vector<double> expected;      // the same of a discounted process, less nothing
    std::uint32_t number = 0;          // within the component
  };

  Body(const Mdp& mdp, std::span<const StateIndex> states, std::vector<double> robot_weights,
       const BehaveOptions& options)
      : mdp_{mdp}, states_{states.begin(), states.end()}, robot_{std::move(robot_weights)}, options_{options} {
    detail::require(robot_.size() == mdp.num_features(), "PolicyPartition", "there must be one weight per feature");
    detail::require(can_be_partitioned(mdp), "PolicyPartition",
                    "the process must be exact, or deterministic and discounted");
    find_components();
    if (is_exact(mdp)) {
      has_optima_ = mdp.by_distance().size() == mdp.num_states();
      return;
    }
    for (StateIndex s{0}; s.value() < mdp.num_states(); ++s) has_optima_ = has_optima_ && !mdp.choices(s).empty();
    steps_ = detail::steps_of_choices(mdp);
    for (const std::uint32_t s : detail::states_by_distance(mdp)) by_distance_[component_of_[s]].push_back(s);
  }

  [[nodiscard]] const Mdp& mdp() const noexcept { return mdp_; }
  [[nodiscard]] std::span<const StateIndex> states() const noexcept { return states_; }
  [[nodiscard]] std::span<const double> robot() const noexcept { return robot_; }
  [[nodiscard]] const BehaveOptions& options() const noexcept { return options_; }
  [[nodiscard]] bool is_discounted() const noexcept { return mdp_.discount() < 1.0; }
  [[nodiscard]] bool has_optima() const noexcept { return has_optima_; }
  [[nodiscard]] std::size_t num_components() const noexcept { return components_.size(); }
  [[nodiscard]] bool is_alone(std::size_t c) const { return components_[c].is_alone; }
  [[nodiscard]] std::span<const std::uint32_t> exits(std::size_t c) const { return components_[c].exits; }
  [[nodiscard]] std::span<const std::uint32_t> kept(std::size_t c) const { return components_[c].kept; }
  [[nodiscard]] std::uint32_t component_of(std::size_t s) const { return component_of_[s]; }
  [[nodiscard]] std::uint32_t kept_place(std::size_t s) const { return kept_place_[s]; }
  [[nodiscard]] std::span<const StateIndex> members(std::size_t c) const {
    const auto starts = mdp_.component_starts();
    return mdp_.by_component().subspan(starts[c], starts[c + 1] - starts[c]);
  }

  // Of a discounted process: what its choices do, and the states of a component, nearest to an end first.
  [[nodiscard]] const detail::PathSteps& steps() const noexcept { return steps_; }
  [[nodiscard]] std::span<const std::uint32_t> by_distance(std::size_t c) const { return by_distance_[c]; }

  [[nodiscard]] std::size_t num_parts() const noexcept { return num_parts_; }
  [[nodiscard]] std::size_t memory() const noexcept { return bytes_; }

  // Whether a cycle that is known earns more than this.
  [[nodiscard]] bool gains(std::span<const double> weights, double more_than) const {
    const std::shared_lock lock{mutex_};
    for (std::size_t i = 0; i < gains_.size(); i += weights.size()) {
      if (detail::dot_of(&gains_[i], weights) > more_than) return true;
    }
    return false;
  }

  // Adds a cycle that earns. @returns the bytes that it takes; 0 if it is known.
  std::size_t add_gain(const IntegerVector& cycle) {
    const std::unique_lock lock{mutex_};
    if (!known_gains_.insert(cycle).second) return 0;
    for (const std::int64_t x : cycle) gains_.push_back(static_cast<double>(x));
    const std::size_t bytes = cycle.size() * sizeof(double) + 2 * sizeof(IntegerVector);
    bytes_ += bytes;
    return bytes;
  }

  // The only part of a component that can hold the weights, if any is known for these differences. It stays valid.
  [[nodiscard]] const Part* candidate(std::size_t c, const std::vector<std::int64_t>& differences,
                                      std::span<const double> weights) const {
    const std::shared_lock lock{mutex_};
    const auto known = components_[c].cases.find(differences);
    return known == components_[c].cases.end() ? nullptr : best_of(known->second, weights);
  }

  // Adds a part that holds the weights, unless another thread has added one meanwhile, as `holds` tells. @returns the
  // part that is known now, and the bytes that were added.
  template <typename Holds>
  std::pair<const Part*, std::size_t> add(std::size_t c, const std::vector<std::int64_t>& differences,
                                          std::span<const double> weights, std::unique_ptr<Part> part,
                                          std::span<const double> sum, const Holds& holds) {
    const std::unique_lock lock{mutex_};
    auto& known = components_[c].cases[differences];
    if (!known.parts.empty()) {
      const Part* const other = best_of(known, weights);
      if (holds(*other)) return {other, 0};
    }
    const std::size_t d = weights.size();
    const std::size_t bytes = sizeof(Part) + (known.parts.empty() ? sizeof(Case) + differences.size() * 8 + 64 : 0) +
                              (part->normals.size() + 2 * d) * sizeof(double) +
                              part->counts.size() * sizeof(std::int64_t) + part->expected.size() * sizeof(double);
    known.sums.insert(known.sums.end(), sum.begin(), sum.end());
    part->number = components_[c].num_parts++;
    bytes_ += bytes;
    ++num_parts_;
    return {known.parts.emplace_back(std::move(part)).get(), bytes};
  }

 private:
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
    std::unordered_map<std::vector<std::int64_t>, Case, HashOfList> cases;
  };

  // Of two behaviours the better one is better or equal everywhere, so the best in sum is the only candidate.
  [[nodiscard]] static const Part* best_of(const Case& known, std::span<const double> weights) {
    const std::size_t d = weights.size();
    std::size_t best = 0;
    double most = 0.0;
    for (std::size_t i = 0; i * d < known.sums.size(); ++i) {
      const double sum = detail::dot_of(&known.sums[i * d], weights);
      if (i > 0 && sum <= most) continue;
      most = sum;
      best = i;
    }
    return known.parts[best].get();
  }

  void find_components() {
    const auto starts = mdp_.component_starts();
    const auto by_component = mdp_.by_component();
    components_.resize(starts.empty() ? 0 : starts.size() - 1);
    by_distance_.resize(components_.size());
    component_of_.assign(mdp_.num_states(), 0);
    kept_place_.assign(mdp_.num_states(), kNone);

    // The states whose counts somebody asks for: on candidates' paths, and where another component is left to.
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

  static constexpr std::uint32_t kNone = 0xFFFFFFFFu;

  const Mdp& mdp_;
  std::vector<StateIndex> states_;
  std::vector<double> robot_;
  BehaveOptions options_;
  bool has_optima_ = true;                   // every state can finish
  std::vector<std::uint32_t> component_of_;  // shape [num_states]
  std::vector<std::uint32_t> kept_place_;    // shape [num_states]: position in Component::kept

  detail::PathSteps steps_;                              // of a discounted process, shape [num_choices]
  std::vector<std::vector<std::uint32_t>> by_distance_;  // the same, per component

  mutable std::shared_mutex mutex_;    // of the cases of components, and of gains
  std::vector<Component> components_;  // all but the cases never changes
  std::vector<double> gains_;          // cycles that earn for some weights, row-major, shape [n, d]: primitive
  std::unordered_set<IntegerVector> known_gains_;
  std::atomic<std::size_t> num_parts_ = 0;
  std::atomic<std::size_t> bytes_ = 0;
};

}  // namespace kith
