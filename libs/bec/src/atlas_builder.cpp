#include "atlas_builder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "behaviour_source.hpp"
#include "kith/bec/comparison.hpp"
#include "kith/bec/memory_needs.hpp"
#include "kith/core/assert.hpp"
#include "kith/core/error.hpp"
#include "kith/geometry/cover.hpp"

namespace kith {
namespace {

// Of how many start pictures each is compared with all others; of more, with as many of them.
constexpr std::size_t kMostPicturesCompared = 1'000;

}  // namespace

void AtlasBuilder::build() {
  require_planning_memory(atlas_.domain_);
  plan();
  order_features();
  find_indifference();
  reduce_one_step();
  number_constraints();
  make_one_step_sets();
  compare_whole_paths();
  make_policy_bec();
  count_masks();
  make_components();
  if (tables_) {
    make_facets();
    tables_->cells_ = PolicyCells{tables_->hulls_};
  }
  group_starts();
  index_tests();
  average_dissimilarities();
}

void AtlasBuilder::choose_source(BehaviourSource source) {
  const auto& domain = atlas_.domain_;
  if (domain.num_features() < 2) {
    throw Error{ErrorKind::kInfeasible, "domain '" + domain.id() + "' has a single feature: there is nothing to weigh"};
  }
  if (source == BehaviourSource::kTabulated && !can_be_tabulated(domain)) {
    throw Error{
        ErrorKind::kInfeasible,
        "behaviours in domain '" + domain.id() +
            "' cannot be precomputed: that needs three features, exact counts below 2^31 and all states as starts"};
  }
  if (source == BehaviourSource::kTabulated ||
      (source == BehaviourSource::kAutomatic && is_cheap_to_tabulate(domain))) {
    atlas_.tables_ = tables_ = std::make_shared<BehaviourTables>();
  }
}

void AtlasBuilder::plan() {
  const auto& domain = atlas_.domain_;
  for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) {
    const auto& mdp = domain.mdp(m);
    auto plan = plan_robot(domain, m);
    if (!plan) {
      throw Error{ErrorKind::kInfeasible, "the robot has no finite optimum in world " + std::to_string(m.value()) +
                                              " of domain '" + domain.id() + "'"};
    }
    atlas_.first_start_.push_back(atlas_.starts_.size());
    for (StateIndex s{0}; s.value() < mdp.num_states(); ++s) {
      Atlas::Start start;
      start.id = {m, s};
      start.complexity = domain.complexity(start.id);
      atlas_.starts_.push_back(start);
      atlas_.counts_.push_back(plan->counts[s.value()]);
    }
    const auto order = successors_first(mdp, *plan);
    describe_paths(m, *plan, order);
    collect_one_step(m, *plan, order);
    if (tables_) find_hulls(m);
    atlas_.canonical_choices_.push_back(std::move(plan->choice));
    atlas_.shown_next_.push_back(std::move(plan->next));
  }
}

// By what a feature is, whatever place the file gives it: those that some world lacks first, then the costliest, then
// those that the robot meets most often. The step is mostly last.
void AtlasBuilder::order_features() {
  const auto& domain = atlas_.domain_;
  const auto& weights = domain.weights().integer;
  using Key = std::array<std::int64_t, 3>;
  std::vector<Key> keys;
  for (std::size_t k = 0; k < domain.num_features(); ++k) {
    bool is_everywhere = true;
    for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) is_everywhere &= domain.mdp(m).has_feature(k);
    std::int64_t met = 0;
    for (const std::size_t i : candidates()) met += atlas_.counts_[i][k];
    keys.push_back({is_everywhere ? 1 : 0, weights[k], -met});
  }
  auto& order = atlas_.feature_order_;
  order.resize(keys.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return keys[a] < keys[b]; });
  rank_.resize(keys.size());
  for (std::size_t place = 0; place < order.size(); ++place) rank_[order[place]] = place;
}

bool AtlasBuilder::is_before(const HalfSpace& a, const HalfSpace& b) const {
  const auto& order = atlas_.feature_order_;
  const auto differs =
      std::find_if(order.begin(), order.end(), [&](std::size_t k) { return a.normal()[k] != b.normal()[k]; });
  return differs != order.end() && a.normal()[*differs] < b.normal()[*differs];
}

Eigen::MatrixXd AtlasBuilder::people_within(const ConstraintSet& set, std::size_t n) const {
  auto half_spaces = atlas_.constraints_.half_spaces(set);
  std::sort(half_spaces.begin(), half_spaces.end(), [this](const auto& a, const auto& b) { return is_before(a, b); });
  Cone region{atlas_.domain_.num_features()};  // the whole sphere, if there is no prior and nothing is known
  const bool has_room = region.clip(half_spaces);
  KITH_ASSERT(has_room);
  return cover(region, n, atlas_.feature_order_);
}

// What people do is planned once for all who ask.
std::shared_ptr<PartitionStore> AtlasBuilder::partitions() {
  if (!partitions_) partitions_ = std::make_shared<PartitionStore>(atlas_);
  return partitions_;
}

std::uint32_t AtlasBuilder::picture(MdpIndex m, StateIndex s) {
  const auto map = atlas_.domain_.map();
  if (!map) {
    const auto number = state_names_.try_emplace(atlas_.domain_.state_name(m, s), state_names_.size()).first->second;
    return static_cast<std::uint32_t>(number);
  }
  const auto state = map->state(m, s);
  std::vector<std::int64_t> key{state.robot.x, state.robot.y, state.exited ? 1 : 0};
  for (const auto& item : state.items) key.insert(key.end(), {item.x, item.y});
  for (const bool carried : state.carried) key.push_back(carried ? 1 : 0);
  for (const auto& station : state.stations) key.insert(key.end(), {station.x, station.y});
  return pictures_.try_emplace(std::move(key), static_cast<std::uint32_t>(pictures_.size())).first->second;
}

// Ties, uniqueness and trajectory classes, from the end of the paths backwards.
void AtlasBuilder::describe_paths(MdpIndex m, const RobotPlan& robot, const PathOrder& order) {
  const auto& mdp = atlas_.domain_.mdp(m);
  for (const auto s : order.states) {
    auto& here = start(m, s);
    const StateIndex next{robot.next[s.value()]};
    here.tie = robot.optimal_choices[s.value()] > 1;
    here.cycle_length = order.cycle_length[s.value()];
    if (!mdp.is_terminal(next)) here.next = static_cast<std::uint32_t>(atlas_.first_start_[m.value()] + next.value());
  }

  for (const auto s : order.states) {
    auto& here = start(m, s);
    const StateIndex next{robot.next[s.value()]};
    here.unique = !here.tie;
    std::vector<std::int64_t> key;
    if (here.cycle_length > 0) {  // the whole round, which no path that ends is named by
      key.push_back(-1);
      for (const StartIndex on : atlas_.path(atlas_.index({m, s}))) {
        here.unique = here.unique && !atlas_.starts_[on.value()].tie;
        append_look(m, atlas_.id(on).start, robot, key);
      }
    } else {
      append_look(m, s, robot, key);
      // What follows: a negative number names the picture of a terminal state.
      if (mdp.is_terminal(next)) {
        key.push_back(-2 - static_cast<std::int64_t>(picture(m, next)));
      } else {
        here.unique = here.unique && start(m, next).unique;
        key.push_back(static_cast<std::int64_t>(start(m, next).trajectory_class));
      }
    }
    here.trajectory_class =
        trajectory_classes_.try_emplace(std::move(key), static_cast<std::uint32_t>(trajectory_classes_.size()))
            .first->second;
  }
}

// What there is to see of one step.
void AtlasBuilder::append_look(MdpIndex m, StateIndex s, const RobotPlan& robot, std::vector<std::int64_t>& key) {
  const auto action = atlas_.domain_.mdp(m).choices(s)[robot.choice[s.value()]].action;
  key.push_back(picture(m, s));
  key.push_back(static_cast<std::int64_t>(action.value()));
}

std::vector<bool> AtlasBuilder::on_candidates_paths(MdpIndex m, const RobotPlan& robot) const {
  const auto n = atlas_.domain_.mdp(m).num_states();
  std::vector<bool> is_on(n, false);
  for (const StateIndex start : atlas_.domain_.starts(m)) {
    for (std::size_t s = start.value(); s < n && !is_on[s]; s = robot.next[s]) is_on[s] = true;
  }
  return is_on;
}

std::vector<ConstraintIndex> AtlasBuilder::deviations(const Mdp& mdp, const RobotPlan& robot, StateIndex s) {
  const auto& domain = atlas_.domain_;
  const auto robots = [&](StateIndex next) -> const IntegerVector& { return robot.counts[next.value()]; };
  std::vector<ConstraintIndex> result;
  for (const auto& choice : mdp.choices(s)) {
    const auto loss = robot.counts[s.value()] - counts_of(mdp, choice, domain.count_scale(), robots);
    if (const auto half_space = preference_of_robot(domain, loss)) result.push_back(raw_.add(*half_space));
  }
  return result;
}

void AtlasBuilder::collect_one_step(MdpIndex m, const RobotPlan& robot, const PathOrder& order) {
  const auto& mdp = atlas_.domain_.mdp(m);
  const auto is_on_path = on_candidates_paths(m, robot);
  raw_sets_.resize(atlas_.starts_.size());
  for (std::size_t i = 0; i < order.states.size(); ++i) {
    const auto s = order.states[i];
    if (!is_on_path[s.value()]) {
      paths_meet_all_states_ = false;
      continue;
    }
    // All states of a cycle show the same.
    const auto length = std::max<std::size_t>(order.cycle_length[s.value()], 1);
    std::vector<ConstraintIndex> set;
    for (std::size_t j = 0; j < length; ++j) {
      const auto more = deviations(mdp, robot, order.states[i + j]);
      set.insert(set.end(), more.begin(), more.end());
    }
    const auto next = start(m, s).next;
    if (order.cycle_length[s.value()] == 0 && next != Atlas::kTerminal)
      set.insert(set.end(), raw_sets_[next].begin(), raw_sets_[next].end());
    std::sort(set.begin(), set.end());
    set.erase(std::unique(set.begin(), set.end()), set.end());
    memory_.take(length * set.size() * sizeof(ConstraintIndex));
    for (std::size_t j = 0; j < length; ++j)
      raw_sets_[atlas_.first_start_[m.value()] + order.states[i + j].value()] = set;
    i += length - 1;
  }
}

// Where paths with different feature counts are equally good, the comparison of
// the two holds with equality at the robot's weights. As long as such
// half-spaces leave a region they are taken as shown. When the robot's choices
// among equals contradict each other, it is indifferent: these comparisons say
// nothing about its reward, and none of them counts. Without tables not all of
// them are known, and none counts.
void AtlasBuilder::find_indifference() {
  if (!tables_) {
    indifferent_ = true;
    return;
  }
  const auto& weights = atlas_.domain_.weights().integer;
  std::vector<HalfSpace> ties;
  const auto collect = [&](const HalfSpace& half_space) {
    if (sign_of_dot(half_space.normal(), weights) == 0) ties.push_back(half_space);
  };
  for (ConstraintIndex c{0}; c.value() < raw_.size(); ++c) collect(raw_[c]);
  for (const auto& hull : tables_->hulls_) {
    for (const auto& loss : hull.losses) {
      if (!loss.is_zero()) collect(HalfSpace{loss});
    }
  }
  // Nobody believes what the prior excludes: with a tie on its other side it leaves no region either.
  ties.insert(ties.end(), atlas_.domain_.prior().begin(), atlas_.domain_.prior().end());
  indifferent_ = !has_interior(ties);
}

bool AtlasBuilder::counts(const HalfSpace& half_space) const {
  return !indifferent_ || sign_of_dot(half_space.normal(), atlas_.domain_.weights().integer) != 0;
}

std::vector<std::size_t> AtlasBuilder::candidates() const {
  std::vector<std::size_t> result;
  for (MdpIndex m{0}; m.value() < atlas_.domain_.num_mdps(); ++m) {
    for (const StateIndex s : atlas_.domain_.starts(m)) result.push_back(atlas_.first_start_[m.value()] + s.value());
  }
  return result;
}

void AtlasBuilder::reduce_one_step() {
  IntsMap<std::uint32_t> known;
  for (const std::size_t i : candidates()) {
    std::vector<std::int64_t> key;
    for (const auto c : raw_sets_[i]) key.push_back(static_cast<std::int64_t>(c.value()));
    const auto [place, is_new] = known.try_emplace(std::move(key), static_cast<std::uint32_t>(minimal_sets_.size()));
    if (is_new) {
      std::vector<HalfSpace> half_spaces;
      for (const auto c : raw_sets_[i]) {
        if (counts(raw_[c])) half_spaces.push_back(raw_[c]);
      }
      auto reduced = minimal_set(half_spaces);
      KITH_ASSERT(reduced.has_value());  // weights beside the robot's satisfy all that counts
      minimal_sets_.push_back(std::move(*reduced));
    }
    atlas_.starts_[i].one_step = place->second;
  }
}

// Prior first, then the one-step sets, then what counterfactuals can convey.
void AtlasBuilder::number_constraints() {
  auto& table = atlas_.constraints_;
  table = ConstraintTable{atlas_.domain_.num_features()};
  for (const auto& half_space : atlas_.domain_.prior()) table.add(half_space);
  for (const auto& set : minimal_sets_) {
    for (const auto& half_space : set) table.add(half_space);
  }
  if (!tables_) return;
  for (const auto& hull : tables_->hulls_) {
    auto& row = tables_->constraints_.emplace_back();
    for (const auto& loss : hull.losses) {
      const bool tells = !loss.is_zero() && counts(HalfSpace{loss});
      row.push_back(tells ? static_cast<std::int32_t>(table.add(HalfSpace{loss}).value()) : -1);
    }
  }
}

void AtlasBuilder::make_one_step_sets() {
  for (const auto& set : minimal_sets_) atlas_.one_step_sets_.push_back(atlas_.constraints_.set_of(set));
  atlas_.prior_ = atlas_.constraints_.set_of(atlas_.domain_.prior());
  std::optional<Cone> cone{std::in_place, atlas_.domain_.num_features()};
  if (!cone->clip(atlas_.domain_.prior()))
    throw Error{ErrorKind::kInfeasible,
                "the prior of domain '" + atlas_.domain_.id() + "' leaves no region of weights"};
  atlas_.prior_cone_ = *cone;
}

// Demonstrations that convey the same to everybody: where that is known, those whose paths meet the same hulls; else
// each one is a class of its own.
void AtlasBuilder::group_starts() {
  if (tables_) {
    group_by_hulls();
  } else {
    for (const std::size_t i : candidates()) {
      atlas_.starts_[i].start_class = StartClassIndex{atlas_.classes_.size()};
      atlas_.classes_.emplace_back().emplace_back(i);
    }
  }
  Regions regions{atlas_.constraints_};
  for (auto& component : atlas_.components_) {
    auto conveyed = atlas_.no_constraints();
    for (StartClassIndex c{0}; c.value() < atlas_.num_start_classes(); ++c) {
      if (!component.uses_mdp[atlas_.id(atlas_.members(c).front()).mdp.value()]) continue;
      component.start_classes.push_back(c);
      if (tables_) tables_->add_conveyed(c, conveyed);
    }
    if (tables_) component.conveyed = regions.minimal(conveyed);
  }
}

void AtlasBuilder::index_tests() {
  atlas_.tests_for_.resize(atlas_.constraints_.size());
  for (const std::size_t i : candidates()) {
    const StartIndex start{i};
    for (const auto c : atlas_.one_step(start).members()) {
      const bool discriminates = !tables_ || tables_->robot_cell_facets(start).contains(c);
      if (discriminates) atlas_.tests_for_[c.value()].push_back(start);
    }
  }
}

void AtlasBuilder::average_dissimilarities() {
  const auto& domain = atlas_.domain_;
  for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) {
    const auto& starts = domain.starts(m);
    const std::size_t n = starts.size();
    // All with all, or with every so many-th.
    const std::size_t stride = (n + kMostPicturesCompared - 1) / kMostPicturesCompared;
    std::vector<std::int64_t> sums(n, 0);
    std::vector<std::int64_t> others(n, 0);
    for (std::size_t i = 0; i < n; i += std::max<std::size_t>(stride, 1)) {
      for (std::size_t j = stride == 1 ? i + 1 : 0; j < n; ++j) {
        if (j == i) continue;
        const int difference = domain.dissimilarity({m, starts[i]}, {m, starts[j]});
        sums[j] += difference;
        ++others[j];
        if (stride > 1) continue;
        sums[i] += difference;
        ++others[i];
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      const double mean = others[i] > 0 ? static_cast<double>(sums[i]) / static_cast<double>(others[i]) : 0.0;
      start(m, starts[i]).mean_dissimilarity = static_cast<int>(std::lround(mean));
    }
  }
}

}  // namespace kith
