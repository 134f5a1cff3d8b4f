#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "kith/bec/behaviour_tables.hpp"
#include "kith/bec/constraint_table.hpp"
#include "kith/bec/knowledge_component.hpp"
#include "kith/bec/regions.hpp"
#include "kith/domains/domain.hpp"
#include "kith/geometry/eigen.hpp"
#include "kith/mdp/planner.hpp"

namespace kith {

/// How an Atlas knows what learners would do.
enum class BehaviourSource {
  kAutomatic,  ///< kTabulated where that is possible and cheap, else kOnDemand.
  kTabulated,  ///< BehaviourTables, found once.
  kOnDemand,   ///< Planned when a weight is met: Behaviours remembers them.
};

/// Everything about a domain that does not depend on who is taught: what the robot shows, that is, its trajectories,
/// one-step constraints and knowledge components. What people expect of it is Behaviours' to say, by tables where the
/// atlas has them (all MDPs exact, small and of three features), else by plans.
///
/// Comparisons of equally good paths with different feature counts hold with
/// equality at the robot's weights. If all of them together leave a region they
/// count like any other constraint; if the robot's choices contradict each
/// other, it is indifferent and none of them counts. Without tables none of them ever counts.
///
/// Feature counts are in units of 1 / Domain::count_scale(); for stochastic and discounted MDPs they are
/// expectations. What is shown of the robot is then the likeliest path under its policy.
///
/// Immutable after construction and safe to share between threads.
class Atlas {
 public:
  /// Plans everything; item delivery takes tens of milliseconds.
  /// @throws kith::Error (kInfeasible) if the domain has a single feature or the robot has no finite optimum in some
  /// MDP; or if tables are asked for where there can be none.
  explicit Atlas(Domain domain, BehaviourSource source = BehaviourSource::kAutomatic);

  [[nodiscard]] const Domain& domain() const noexcept { return domain_; }
  /// What people would do, where that is tabulated; nothing where it is planned on demand.
  [[nodiscard]] const BehaviourTables* find_tables() const noexcept { return tables_.get(); }
  /// The same. @throws kith::Error (kInfeasible) if there are none.
  [[nodiscard]] const BehaviourTables& tables() const {
    if (!tables_) refuse_tables();
    return *tables_;
  }
  [[nodiscard]] const ConstraintTable& constraints() const noexcept { return constraints_; }
  /// The prior's half-spaces as constraints and as a cone.
  [[nodiscard]] const ConstraintSet& prior() const noexcept { return prior_; }
  [[nodiscard]] const Cone& prior_cone() const noexcept { return prior_cone_; }
  /// The features in an order that follows from the robot, not from the file: those that some world lacks first, then
  /// the costliest. For cover(), so that what is sampled does not depend on the file either.
  [[nodiscard]] const std::vector<std::size_t>& feature_order() const noexcept { return feature_order_; }

  // --- demonstrations -------------------------------------------------------
  /// Of all non-terminal states; not all need be candidates.
  [[nodiscard]] std::size_t num_states() const noexcept { return starts_.size(); }
  /// Whether demonstrations and tests may start there (Domain::starts()).
  [[nodiscard]] bool is_candidate(StartIndex start) const { return starts_[start.value()].start_class != kNoClass; }
  [[nodiscard]] StartId id(StartIndex start) const { return starts_[start.value()].id; }
  [[nodiscard]] StartIndex index(StartId id) const {
    return StartIndex{first_start_[id.mdp.value()] + id.start.value()};
  }
  /// The robot's canonical path, of at least one action; the likeliest where chance has a part. A robot that never ends
  /// goes round in a cycle.
  [[nodiscard]] Trajectory trajectory(StartIndex start) const;
  /// The states of that path that are not terminal, as demonstrations of their own, in order; those of a cycle once.
  [[nodiscard]] std::vector<StartIndex> path(StartIndex start) const;
  /// What the robot does in the start state.
  [[nodiscard]] ActionIndex action(StartIndex start) const;
  /// The next state on that path, as a demonstration of its own; nothing where the path ends. Following it never ends
  /// where the path does not.
  [[nodiscard]] std::optional<StartIndex> next(StartIndex start) const {
    const auto at = starts_[start.value()].next;
    return at == kTerminal ? std::nullopt : std::optional{StartIndex{at}};
  }
  /// The number of actions of the cycle that the start state lies on, where the path never ends; 0: on none.
  [[nodiscard]] std::size_t cycle_length(StartIndex start) const { return starts_[start.value()].cycle_length; }
  /// mu of the robot's path, or its expectation, shape [d].
  [[nodiscard]] const IntegerVector& feature_counts(StartIndex start) const { return counts_[start.value()]; }
  /// mu(s, b): what one action at the start counts when the robot goes on from there, or its expectation, shape [d].
  /// @param choice  position in Mdp::choices() of the start.
  /// @throws std::invalid_argument if there is no such choice.
  [[nodiscard]] IntegerVector deviation_counts(StartIndex start, std::size_t choice) const;
  /// Whether the robot's optimal path is unique (ties in features or not).
  [[nodiscard]] bool is_unique(StartIndex start) const { return starts_[start.value()].unique; }
  /// Whether some optimal action besides the canonical one exists in the start state itself.
  [[nodiscard]] bool has_tie(StartIndex start) const { return starts_[start.value()].tie; }
  /// Minimal set of what the path shows: the one-step deviation constraints, mu_robot(s_t) - mu(s_t, b) for every state
  /// s_t of the path and every action b, and, where behaviours are not tabulated and candidates' paths do not meet
  /// every state, comparisons of the path with whole paths of people who would satisfy all of these. @pre
  /// is_candidate(start).
  [[nodiscard]] const ConstraintSet& one_step(StartIndex start) const {
    return one_step_sets_[starts_[start.value()].one_step];
  }
  /// Equal for demonstrations that look the same: same pictures, same actions.
  [[nodiscard]] std::uint32_t trajectory_class(StartIndex start) const {
    return starts_[start.value()].trajectory_class;
  }
  /// Domain::complexity() of the start picture.
  [[nodiscard]] int complexity(StartIndex start) const { return starts_[start.value()].complexity; }
  /// Mean dissimilarity of the start picture to all others of the same MDP, rounded.
  [[nodiscard]] int mean_dissimilarity(StartIndex start) const { return starts_[start.value()].mean_dissimilarity; }

  // --- the robot's policy ---------------------------------------------------
  /// Minimal set of all one_step(): the behaviour equivalence class of the policy.
  [[nodiscard]] const ConstraintSet& policy_bec() const noexcept { return policy_bec_; }
  [[nodiscard]] const std::vector<HalfSpace>& policy_bec_half_spaces() const noexcept {
    return policy_bec_half_spaces_;
  }
  /// Area of the policy's BEC with the prior on the unit sphere, steradian for d = 3.
  [[nodiscard]] double policy_bec_area_sr() const noexcept { return policy_bec_area_.value; }
  /// The same with its standard error.
  [[nodiscard]] const SolidAngle& policy_bec_area() const noexcept { return policy_bec_area_; }
  /// Where the policy's BEC is an estimate, because candidates' paths do not meet every state and whole paths had to be
  /// compared: the regret that 32 people keep who satisfy it and had no part in finding it, as a share of that of
  /// people who know the prior only. Nothing where the BEC is exact.
  [[nodiscard]] std::optional<double> regret_left() const noexcept { return regret_left_; }
  [[nodiscard]] const std::vector<KnowledgeComponent>& knowledge_components() const noexcept { return components_; }
  /// z_k: how many rows of all demonstrations' one-step minimal sets have a non-zero k-th entry, shape [d].
  [[nodiscard]] const std::vector<std::size_t>& mask_counters() const noexcept { return mask_counters_; }

  // --- classes that convey the same -----------------------------------------
  [[nodiscard]] std::size_t num_start_classes() const noexcept { return classes_.size(); }
  [[nodiscard]] StartClassIndex start_class(StartIndex start) const { return starts_[start.value()].start_class; }
  /// In ascending order; all are candidates.
  [[nodiscard]] std::span<const StartIndex> members(StartClassIndex c) const { return classes_[c.value()]; }
  [[nodiscard]] std::size_t words_per_set() const noexcept { return (constraints_.size() + 63) / 64; }

  // --- tests ----------------------------------------------------------------
  /// Constraints that a right answer shows: BehaviourTables::robot_cell_facets() where behaviours are tabulated, else
  /// one_step(), of which they are some. @pre is_candidate(start).
  [[nodiscard]] const ConstraintSet& tested_constraints(StartIndex start) const {
    return tables_ ? tables_->robot_cell_facets(start) : one_step(start);
  }
  /// Demonstrations whose one-step set contains c and, where behaviours are tabulated, whose start discriminates c (it
  /// is a facet of the robot's cell there): what can test c. Ascending; none for constraints that are not in
  /// constraints().
  [[nodiscard]] std::span<const StartIndex> tests_for(ConstraintIndex c) const {
    if (c.value() >= tests_for_.size()) return {};
    return tests_for_[c.value()];
  }

  /// The same atlas without some tests: tests_for() lists only demonstrations of which `is_usable` is true.
  /// @param is_usable  shape [num_states]. @throws std::invalid_argument for another shape.
  [[nodiscard]] Atlas with_tests(const std::vector<bool>& is_usable) const;

  /// The set of all constraints in the table that are empty: a fresh set of the right size.
  [[nodiscard]] ConstraintSet no_constraints() const { return ConstraintSet{constraints_.size()}; }

 private:
  friend class AtlasBuilder;
  static constexpr std::uint32_t kTerminal = 0xFFFFFFFF;
  static constexpr StartClassIndex kNoClass{0xFFFFFFFF};

  // What selections look up again and again: as many of them in a cache line as possible.
  struct Start {
    StartId id;
    bool unique = true;
    bool tie = false;
    std::uint32_t one_step = 0;  // row of one_step_sets_
    std::uint32_t trajectory_class = 0;
    int complexity = 0;
    int mean_dissimilarity = 0;
    StartClassIndex start_class = kNoClass;
    std::uint32_t next = kTerminal;  // index of the next state on the path
    std::uint32_t cycle_length = 0;  // of the cycle that the start state lies on; 0: on none
  };

  [[noreturn]] void refuse_tables() const;

  Domain domain_;
  std::shared_ptr<const BehaviourTables> tables_;
  ConstraintTable constraints_;
  ConstraintSet prior_;
  Cone prior_cone_;
  std::vector<std::size_t> feature_order_;
  std::vector<std::size_t> first_start_;
  std::vector<Start> starts_;
  std::vector<IntegerVector> counts_;                          // per demonstration
  std::vector<std::vector<std::uint32_t>> canonical_choices_;  // per MDP, shape [num_states]
  std::vector<std::vector<std::uint32_t>> shown_next_;         // the same: the state after s on the shown path
  std::vector<ConstraintSet> one_step_sets_;
  ConstraintSet policy_bec_;
  std::vector<HalfSpace> policy_bec_half_spaces_;
  SolidAngle policy_bec_area_;
  std::optional<double> regret_left_;
  std::vector<KnowledgeComponent> components_;
  std::vector<std::size_t> mask_counters_;
  std::vector<std::vector<StartIndex>> classes_;
  std::vector<std::vector<StartIndex>> tests_for_;
};

}  // namespace kith
