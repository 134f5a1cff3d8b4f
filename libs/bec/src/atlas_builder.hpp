#pragma once

#include <memory>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "kith/bec/atlas.hpp"
#include "kith/bec/behaviours.hpp"
#include "kith/core/hash.hpp"
#include "kith/core/memory.hpp"
#include "kith/mdp/coverage_set.hpp"
#include "robot_plan.hpp"

namespace kith {

// Fills an Atlas whose domain is set, stage by stage. The table of constraints
// must be complete before the first ConstraintSet of its size is made, so the
// one-step constraints are reduced in a table of their own first.
class AtlasBuilder {
 public:
  AtlasBuilder(Atlas& atlas, BehaviourSource source) : atlas_{atlas}, raw_{atlas.domain().num_features()} {
    choose_source(source);
  }
  void build();

 private:
  void choose_source(BehaviourSource source);
  void plan();
  void order_features();
  void describe_paths(MdpIndex m, const RobotPlan& robot, const PathOrder& order);
  void append_look(MdpIndex m, StateIndex s, const RobotPlan& robot, std::vector<std::int64_t>& key);
  void collect_one_step(MdpIndex m, const RobotPlan& robot, const PathOrder& order);
  [[nodiscard]] std::vector<bool> on_candidates_paths(MdpIndex m, const RobotPlan& robot) const;
  [[nodiscard]] std::vector<ConstraintIndex> deviations(const Mdp& mdp, const RobotPlan& robot, StateIndex s);
  void find_indifference();
  [[nodiscard]] bool counts(const HalfSpace& half_space) const;
  void reduce_one_step();
  void find_hulls(MdpIndex m);
  void intern_hull(StartIndex here, const CoverageSets& coverage);
  void number_constraints();
  void make_one_step_sets();
  void compare_whole_paths();
  void show_more(Atlas::Start& start, const std::set<HalfSpace>& comparisons, const Cone& region);
  void make_policy_bec();
  void count_masks();
  void make_components();
  [[nodiscard]] KnowledgeComponent component(std::vector<std::size_t> features, std::size_t reference);
  [[nodiscard]] std::vector<std::vector<std::size_t>> trade_offs(const std::vector<std::size_t>& order,
                                                                 std::size_t reference) const;
  [[nodiscard]] std::vector<KnowledgeComponent> worth_most(std::vector<KnowledgeComponent> candidates);
  [[nodiscard]] bool is_of_use(const KnowledgeComponent& component) const;
  [[nodiscard]] std::shared_ptr<PartitionStore> partitions();
  void make_facets();
  void group_starts();
  void group_by_hulls();
  void index_tests();
  void average_dissimilarities();

  // Whether the file's feature a comes before b in an order that does not depend on the file's.
  [[nodiscard]] bool is_before(std::size_t a, std::size_t b) const { return rank_[a] < rank_[b]; }
  // The same for half-spaces: by their normals, entry by entry in that order.
  [[nodiscard]] bool is_before(const HalfSpace& a, const HalfSpace& b) const;
  // People who cover the region of a set of constraints evenly, shape [d, n], the same whatever the order of the file's
  // features. @pre the region has interior.
  [[nodiscard]] Eigen::MatrixXd people_within(const ConstraintSet& set, std::size_t n) const;

  // Positions of the demonstrations that may be shown or asked.
  [[nodiscard]] std::vector<std::size_t> candidates() const;
  [[nodiscard]] Atlas::Start& start(MdpIndex m, StateIndex s) {
    return atlas_.starts_[atlas_.first_start_[m.value()] + s.value()];
  }
  [[nodiscard]] std::uint32_t picture(MdpIndex m, StateIndex s);

  template <typename Value>
  using IntsMap = std::unordered_map<std::vector<std::int64_t>, Value, HashOfList>;

  Atlas& atlas_;
  std::shared_ptr<BehaviourTables> tables_;  // the atlas's; nothing where behaviours are planned
  std::vector<std::size_t> rank_;            // where each feature stands in it
  // What paths show grows with their length.
  MemoryGuard memory_{"going on to collect what the robot's paths show", "use a smaller map or fewer features"};
  // One-step constraints before numbering: raw ones, and the minimal set per demonstration.
  ConstraintTable raw_;
  std::shared_ptr<PartitionStore> partitions_;  // made by partitions(), once the demonstrations are known
  bool paths_meet_all_states_ = true;           // those of candidates
  bool indifferent_ = false;  // constraints that hold with equality at the robot's weights do not count
  std::vector<std::vector<ConstraintIndex>> raw_sets_;  // per state on candidates' paths: all along the path, sorted
  std::vector<std::vector<HalfSpace>> minimal_sets_;    // distinct minimal sets
  IntsMap<std::uint32_t> pictures_;
  std::unordered_map<std::string, std::size_t> state_names_;  // pictures of models without a map
  IntsMap<std::uint32_t> trajectory_classes_;
  IntsMap<std::size_t> hull_index_;
  std::vector<Cone> regions_;  // distinct finite regions
};

}  // namespace kith
