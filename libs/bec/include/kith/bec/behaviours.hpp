#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "kith/bec/atlas.hpp"
#include "kith/mdp/policy_partition.hpp"

namespace kith {

/// The policy partitions of the MDPs of an atlas without tables, which threads share: what is known about what people
/// with any weights do.
///
/// They grow up to a bound. At half of it they are full: a thread that has nothing open begins anew with empty ones,
/// and the full ones are freed when the last thread has left them. A thread that has to go on with full ones plans what
/// they do not know. So all partitions together take at most `max_bytes`, and what one look-up of each thread adds.
///
/// A cache in front of pure functions: results never depend on what was asked before, nor by which thread. The atlas
/// must outlive it.
class PartitionStore {
 public:
  static constexpr std::size_t kDefaultBytes = std::size_t{128} << 20u;

  /// @param max_bytes  of all partitions.
  explicit PartitionStore(const Atlas& atlas, std::size_t max_bytes = kDefaultBytes);

  [[nodiscard]] const Atlas& atlas() const noexcept { return *atlas_; }
  /// The states of an MDP on candidates' paths, ascending: those whose counts are known.
  [[nodiscard]] std::span<const StateIndex> states(MdpIndex m) const { return states_[m.value()]; }
  /// A demonstration's position among those of its MDP, or -1.
  [[nodiscard]] std::int32_t place(StartIndex start) const { return places_[start.value()]; }

  /// About how much all partitions take, in bytes.
  [[nodiscard]] std::size_t memory() const noexcept { return *bytes_; }

 private:
  friend class PolicyPartitions;
  // Partitions that began together.
  class Generation;
  [[nodiscard]] std::shared_ptr<Generation> current() const;
  [[nodiscard]] std::shared_ptr<Generation> current_with_room();

  const Atlas* atlas_;
  std::size_t max_bytes_;
  std::vector<double> robot_weights_;
  std::vector<std::vector<StateIndex>> states_;      // per MDP
  std::vector<std::int32_t> places_;                 // per demonstration
  std::shared_ptr<std::atomic<std::size_t>> bytes_;  // of all generations, which may outlive this object
  mutable std::mutex mutex_;                         // of current_
  std::shared_ptr<Generation> current_;
};

/// One thread's view of a PartitionStore. Not thread-safe. Its numbers say nothing about how Behaviours numbers its
/// constraints, so it may outlive Behaviours; but it must not be renewed while Behaviours is in use.
class PolicyPartitions {
 public:
  /// With a store of its own.
  explicit PolicyPartitions(const Atlas& atlas) : PolicyPartitions{std::make_shared<PartitionStore>(atlas)} {}
  explicit PolicyPartitions(std::shared_ptr<PartitionStore> store);

  /// See PartitionStore.
  [[nodiscard]] std::span<const StateIndex> states(MdpIndex m) const { return store_->states(m); }
  [[nodiscard]] std::int32_t place(StartIndex start) const { return store_->place(start); }

  /// Finds out what people with these weights do in an MDP; nothing unless can_be_partitioned(), else what was found,
  /// which is valid until the next call, and whether they have an optimum.
  struct Located {
    const PolicyLookup* found = nullptr;
    bool has_optimum = false;
  };
  [[nodiscard]] std::optional<Located> locate(MdpIndex m, const Direction& weights);

  /// Whether other partitions should be used from now on, because these are full or another thread has begun new ones.
  [[nodiscard]] bool is_outdated() const;
  /// Changes to those that other threads use, or to new ones if they are full. Keys of PolicyLookup change their
  /// meaning.
  void renew();

 private:
  std::shared_ptr<PartitionStore> store_;
  std::shared_ptr<PartitionStore::Generation> generation_;
  PolicyLookup lookup_;
};

class Expectations;

/// What people who hold given reward weights do, and what demonstrations tell
/// them: a look-up where the Atlas has tables, planned and remembered where not.
///
/// Without tables every weight that is met is a policy cell of its own, numbered in
/// order. For a cell and an MDP the behaviour is found when it is first asked for (behave_in_favour(): the benefit of
/// the doubt): by the MDP's PolicyPartition if it can have one, else by planning. Of it only the losses on candidates'
/// paths are kept, four bytes each, once for all weights that behave alike in the MDP; they are shown to as one person.
/// For at most `max_cells` cells it is known which behaviour is theirs; then the oldest are forgotten. When the
/// behaviours take more than `max_row_bytes` and more than max_cells * 4 bytes * states on candidates' paths, all are
/// forgotten. What is forgotten is found again when asked for.
///
/// With tables, one row of what is conveyed is kept per policy cell and demonstration class; when they take more than
/// `max_row_bytes` the oldest are forgotten and, if asked for again, computed again.
///
/// A cache in front of pure functions: results never depend on what was asked
/// before. Not thread-safe; give each thread its own. The atlas must outlive it.
class Behaviours {
 public:
  static constexpr std::size_t kDefaultCells = 256;
  static constexpr std::size_t kDefaultRowBytes = std::size_t{32} << 20u;

  /// @param partitions  a view for this object alone, of the same atlas; nothing: with a store of its own.
  explicit Behaviours(const Atlas& atlas, std::size_t max_cells = kDefaultCells,
                      std::size_t max_row_bytes = kDefaultRowBytes,
                      std::shared_ptr<PolicyPartitions> partitions = nullptr);
  Behaviours(const Behaviours&) = delete;
  Behaviours& operator=(const Behaviours&) = delete;
  ~Behaviours();

  [[nodiscard]] const Atlas& atlas() const noexcept { return *atlas_; }
  /// The atlas's constraints and, after them, those met on the way. It grows; references to it stay valid.
  [[nodiscard]] const ConstraintTable& constraints() const noexcept { return constraints_; }

  /// The half-spaces as a set of constraints(); those met for the first time are added.
  [[nodiscard]] ConstraintSet numbers_of(std::span<const HalfSpace> half_spaces);
  /// About how much is remembered, in bytes.
  [[nodiscard]] std::size_t memory() const noexcept;

  /// The cell of the weights, shape [d].
  PolicyCellIndex locate(const Direction& weights);

  /// Feature counts of what people of this cell do from a candidate start or a state on the robot's path from one, or
  /// nothing if they have no optimum there.
  std::optional<IntegerVector> answer(StartIndex start, PolicyCellIndex cell);

  /// The weights of a cell that locate() gave. @pre the atlas has no tables: then each cell is of one person's weights.
  [[nodiscard]] const Direction& weights(PolicyCellIndex cell) const;
  /// The path that people with these weights take from there, or the likeliest one; nothing if they have no optimum.
  /// Planned anew at every call.
  [[nodiscard]] std::optional<Trajectory> trajectory(StartIndex start, const Direction& weights) const;

  /// What demonstrations convey, by demonstration class.
  struct Conveyed {
    std::size_t words = 0;                       ///< Per row.
    std::span<const std::uint64_t> rows;         ///< Shape [num_start_classes, words]; bit i stands for numbering[i].
    std::span<const ConstraintIndex> numbering;  ///< Empty: bit i stands for constraint i.

    /// The constraints of a row.
    [[nodiscard]] ConstraintSet set(StartClassIndex c) const;
  };
  /// What the component's demonstrations convey to people of the given cells: the union over cells and over the states
  /// s_t of the path of mu_robot(s_t) - mu_learner(s_t). Cells without an optimum contribute nothing; rows of other
  /// components' classes may be empty. The result stays valid until the next call.
  Conveyed conveyed_by_class(const KnowledgeComponent& component, std::span<const PolicyCellIndex> cells);
  /// The same for one candidate, not reduced.
  ConstraintSet conveyed(StartIndex start, std::span<const PolicyCellIndex> cells);

 private:
  const Atlas* atlas_;
  ConstraintTable constraints_;
  std::vector<double> robot_weights_;
  std::unique_ptr<Expectations> people_;
};

}  // namespace kith
