#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "kith/core/integer_vector.hpp"
#include "kith/mdp/behaviour.hpp"
#include "kith/mdp/mdp.hpp"

namespace kith {

/// Whether PolicyPartition can answer a process: it is exact (is_exact()), or deterministic and discounted.
[[nodiscard]] inline bool can_be_partitioned(const Mdp& mdp) noexcept {
  return is_exact(mdp) || (mdp.is_deterministic() && mdp.discount() < 1.0);
}

/// What people with any reward weights do in one process: a partition of weight space by policy, which grows where
/// weights are met, so that weights that behave like earlier ones cost a look-up.
///
/// The process is answered one strongly connected component after the other. What is best within a component depends
/// on the differences between the counts of the states that it leads to, and on the weights. For each such list of
/// differences that occurs, the parts of weight space that were met are kept: the counts of one behaviour, and all
/// half-spaces n . w > 0 that it follows from, n being the counts of the behaviour minus those of one different
/// choice. Weights that lie inside all of them, by more than any tolerance of behave_in_favour(), behave that way. All
/// other weights are planned, within the component alone. Cycles that earn are kept as well: weights for which one of
/// them does have no optimum.
///
/// In a discounted process what is best within a component depends on the counts themselves, not on differences, and
/// there is always an optimum. Where some choice is neither clearly worse than another nor counts the same, the whole
/// process is planned.
///
/// A cache in front of a pure function: what PolicyLookup finds never depends on what was asked before, nor on the
/// order in which threads ask, and equals the result of behave_in_favour() (of a discounted process up to rounding:
/// where sums along paths differ in the last bits, so may the last unit). Threads may share a partition. What is
/// known stays until the partition is destroyed. The process must outlive it.
class PolicyPartition {
 public:
  /// @param states  the states whose counts will be asked for, ascending. @param robot_weights  shape [d]; see
  /// behave_in_favour(). @throws std::invalid_argument unless can_be_partitioned() and there is one weight per feature.
  PolicyPartition(const Mdp& mdp, std::span<const StateIndex> states, std::vector<double> robot_weights,
                  const BehaveOptions& options = {});
  PolicyPartition(const PolicyPartition&) = delete;
  PolicyPartition& operator=(const PolicyPartition&) = delete;
  PolicyPartition(PolicyPartition&&) noexcept;
  PolicyPartition& operator=(PolicyPartition&&) noexcept;
  ~PolicyPartition();

  /// Parts of components that are kept.
  [[nodiscard]] std::size_t num_parts() const noexcept;
  /// About how much is kept, in bytes.
  [[nodiscard]] std::size_t memory() const noexcept;

 private:
  friend class PolicyLookup;
  class Body;
  std::unique_ptr<Body> body_;
};

/// Looks weights up in policy partitions, one after the other. Not thread-safe; give each thread its own. A partition
/// must outlive what was found in it.
class PolicyLookup {
 public:
  PolicyLookup();
  PolicyLookup(const PolicyLookup&) = delete;
  PolicyLookup& operator=(const PolicyLookup&) = delete;
  PolicyLookup(PolicyLookup&&) noexcept;
  PolicyLookup& operator=(PolicyLookup&&) noexcept;
  ~PolicyLookup();

  /// Finds out what people with these weights do. False if they have no optimum.
  /// @param may_grow  whether the partition keeps what is new. @throws std::invalid_argument unless there is one finite
  /// weight per feature.
  bool locate(PolicyPartition& partition, std::span<const double> weights, bool may_grow = true);

  /// After locate() was true: feature counts in units of 1 / scale of the i-th of the partition's states, shape [d].
  [[nodiscard]] IntegerVector counts(std::size_t i) const;
  /// Where the weights lie, one number per component: equal keys mean equal counts at all states of the partition.
  /// Empty where the behaviour was not kept. Which numbers these are depends on the order of the look-ups.
  [[nodiscard]] std::span<const std::uint32_t> key() const noexcept;
  /// By how much the last locate() has increased PolicyPartition::memory().
  [[nodiscard]] std::size_t grown_by() const noexcept;

 private:
  class Body;
  std::unique_ptr<Body> body_;
};

}  // namespace kith
