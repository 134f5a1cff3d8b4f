#include <algorithm>
#include <bit>
#include <unordered_map>

#include "expectations.hpp"
#include "kith/bec/comparison.hpp"
#include "kith/bec/memory_needs.hpp"
#include "kith/core/assert.hpp"
#include "kith/core/hash.hpp"
#include "kith/core/memory.hpp"
#include "kith/mdp/behaviour.hpp"

namespace kith {
namespace {

class PlannedExpectations : public Expectations {
 public:
  PlannedExpectations(const Atlas& atlas, ConstraintTable& constraints, std::size_t max_cells,
                      std::size_t max_row_bytes, std::shared_ptr<PolicyPartitions> partitions);

  PolicyCellIndex locate(const Direction& weights) override;
  std::optional<IntegerVector> answer(StartIndex start, PolicyCellIndex cell) override;
  [[nodiscard]] const Direction& weights(PolicyCellIndex cell) const override { return cells_[cell.value()].weights; }
  Behaviours::Conveyed conveyed_by_class(const KnowledgeComponent& component,
                                         std::span<const PolicyCellIndex> cells) override;
  ConstraintSet conveyed(StartIndex start, std::span<const PolicyCellIndex> cells) override;
  [[nodiscard]] std::size_t memory() const noexcept override;

 private:
  using LossIndex = std::int32_t;
  using BehaviourIndex = std::int32_t;
  using SetIndex = std::uint32_t;
  static constexpr BehaviourIndex kUnknown = -1;
  static constexpr BehaviourIndex kNoOptimum = -2;
  static constexpr SetIndex kNoSet = 0xFFFFFFFF;
  struct Loss {
    IntegerVector counts;
    std::int32_t constraint = -1;  // -1: it tells nothing
  };
  // What people who act alike do in one MDP.
  struct Kept {
    std::vector<LossIndex> losses;  // per state on candidates' paths
    std::vector<SetIndex> sets;     // per such state: what going on from there conveys; empty where not asked for yet
  };
  struct World {
    std::vector<Kept> behaviours;
    std::unordered_map<std::vector<std::uint32_t>, BehaviourIndex, HashOfList> by_key;  // of the partition
    std::unordered_map<std::vector<std::uint32_t>, BehaviourIndex, HashOfList> by_losses;
  };
  struct Cell {
    Direction weights;
    std::vector<BehaviourIndex> behaviours;  // per MDP; empty where forgotten
  };
  struct DirectionHash {
    std::size_t operator()(const Direction& weights) const noexcept;
  };

  void remember(PolicyCellIndex cell);
  void make_room();
  BehaviourIndex behaviour_of(PolicyCellIndex cell, MdpIndex m);
  BehaviourIndex find_behaviour(const Direction& weights, MdpIndex m);
  BehaviourIndex number_of(World& world, const std::vector<LossIndex>& losses);
  LossIndex number_of(const IntegerVector& loss);
  SetIndex number_of_set(std::vector<std::uint32_t> set);
  SetIndex with(SetIndex set, std::int32_t constraint);
  SetIndex union_of(std::vector<SetIndex>& sets);
  void find_sets(MdpIndex m, Kept& behaviour);
  std::vector<BehaviourIndex> behaviours_of(std::span<const PolicyCellIndex> cells, MdpIndex m);
  SetIndex conveyed_by(StartIndex start, std::span<const BehaviourIndex> behaviours);
  std::vector<SetIndex> sets_by_class(const KnowledgeComponent& component, std::span<const PolicyCellIndex> cells);
  void number_constraints_of(std::span<const SetIndex> sets);

  const Atlas* atlas_;
  ConstraintTable* constraints_;
  std::size_t max_cells_;
  std::shared_ptr<PolicyPartitions> partitions_;
  std::unordered_map<Direction, PolicyCellIndex, DirectionHash> index_;
  std::vector<Cell> cells_;
  std::vector<PolicyCellIndex> remembered_;  // a ring of max_cells_
  std::size_t oldest_ = 0;
  std::vector<Loss> losses_;
  std::unordered_map<IntegerVector, LossIndex> loss_index_;
  std::vector<World> worlds_;        // per MDP
  std::size_t behaviour_bytes_ = 0;  // of worlds_ and sets
  std::size_t max_behaviour_bytes_ = 0;
  std::vector<const std::vector<std::uint32_t>*> sets_;  // constraints, ascending
  std::unordered_map<std::vector<std::uint32_t>, SetIndex, HashOfList> set_index_;
  std::unordered_map<std::uint64_t, SetIndex> with_;                             // set and constraint
  std::unordered_map<std::vector<std::uint32_t>, SetIndex, HashOfList> unions_;  // several sets
  std::vector<double> robot_weights_;
  std::vector<std::uint64_t> rows_;
  std::vector<ConstraintIndex> numbering_;
  std::vector<std::uint32_t> bit_of_;  // per constraint
};

std::size_t PlannedExpectations::DirectionHash::operator()(const Direction& weights) const noexcept {
  ListHash hash;
  for (const double w : weights) hash.add(std::bit_cast<std::uint64_t>(w));
  return hash.value();
}

PlannedExpectations::PlannedExpectations(const Atlas& atlas, ConstraintTable& constraints, std::size_t max_cells,
                                         std::size_t max_row_bytes, std::shared_ptr<PolicyPartitions> partitions)
    : atlas_{&atlas},
      constraints_{&constraints},
      max_cells_{std::max<std::size_t>(max_cells, 1)},
      partitions_{std::move(partitions)} {
  const Domain& domain = atlas.domain();
  require_memory(teaching_memory(domain), "choosing what to teach in domain '" + domain.id() + "'",
                 "use a smaller map, or teach from some starts only: [family] starts = 1000");
  for (const std::int64_t w : domain.weights().integer) robot_weights_.push_back(static_cast<double>(w));
  if (!partitions_) partitions_ = std::make_shared<PolicyPartitions>(atlas);
  worlds_.resize(domain.num_mdps());
  std::size_t states = 0;
  for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) states += partitions_->states(m).size();
  max_behaviour_bytes_ = std::max(max_cells_ * states * sizeof(LossIndex), max_row_bytes);
}

PolicyCellIndex PlannedExpectations::locate(const Direction& weights) {
  const auto [place, is_new] = index_.try_emplace(weights, PolicyCellIndex{cells_.size()});
  if (is_new) cells_.push_back({weights, {}});
  return place->second;
}

std::optional<IntegerVector> PlannedExpectations::answer(StartIndex start, PolicyCellIndex cell) {
  make_room();
  const MdpIndex m = atlas_->id(start).mdp;
  const auto b = behaviour_of(cell, m);
  if (b == kNoOptimum) return std::nullopt;
  const std::int32_t place = partitions_->place(start);
  KITH_ASSERT(place >= 0);
  const auto loss = worlds_[m.value()].behaviours[static_cast<std::size_t>(b)].losses[static_cast<std::size_t>(place)];
  return atlas_->feature_counts(start) - losses_[static_cast<std::size_t>(loss)].counts;
}

// Forgets the behaviours if they take too much; only between two calls, so that numbers stay valid within one.
void PlannedExpectations::make_room() {
  if (behaviour_bytes_ <= max_behaviour_bytes_) return;
  for (World& world : worlds_) world = {};
  for (const PolicyCellIndex cell : remembered_) {
    auto& behaviours = cells_[cell.value()].behaviours;
    std::fill(behaviours.begin(), behaviours.end(), kUnknown);
  }
  sets_.clear();
  set_index_.clear();
  with_.clear();
  unions_.clear();
  behaviour_bytes_ = 0;
}

PlannedExpectations::BehaviourIndex PlannedExpectations::behaviour_of(PolicyCellIndex cell, MdpIndex m) {
  if (cells_[cell.value()].behaviours.empty()) remember(cell);
  auto& behaviour = cells_[cell.value()].behaviours[m.value()];
  if (behaviour == kUnknown) behaviour = find_behaviour(cells_[cell.value()].weights, m);
  return behaviour;
}

// Makes room for what the cell's behaviours are; the cell remembered for longest gives way.
void PlannedExpectations::remember(PolicyCellIndex cell) {
  if (remembered_.size() < max_cells_) {
    remembered_.push_back(cell);
  } else {
    auto& forgotten = cells_[remembered_[oldest_].value()].behaviours;
    forgotten.clear();
    forgotten.shrink_to_fit();
    remembered_[oldest_] = cell;
    oldest_ = (oldest_ + 1) % max_cells_;
  }
  cells_[cell.value()].behaviours.assign(atlas_->domain().num_mdps(), kUnknown);
}

PlannedExpectations::BehaviourIndex PlannedExpectations::find_behaviour(const Direction& weights, MdpIndex m) {
  World& world = worlds_[m.value()];
  const auto states = partitions_->states(m);
  std::vector<LossIndex> losses;
  losses.reserve(states.size());
  const auto lost = [&](StateIndex s, const IntegerVector& counts) {
    return number_of(atlas_->feature_counts(atlas_->index({m, s})) - counts);
  };
  if (const auto located = partitions_->locate(m, weights)) {
    if (!located->has_optimum) return kNoOptimum;
    const auto key = located->found->key();
    BehaviourIndex* known = nullptr;
    if (!key.empty()) {
      known = &world.by_key.try_emplace({key.begin(), key.end()}, kUnknown).first->second;
      if (*known != kUnknown) return *known;
      behaviour_bytes_ += (key.size() + 12) * sizeof(std::uint32_t);
    }
    for (std::size_t i = 0; i < states.size(); ++i) losses.push_back(lost(states[i], located->found->counts(i)));
    const auto behaviour = number_of(world, losses);
    if (known != nullptr) *known = behaviour;
    return behaviour;
  }

  const auto behaviour =
      behave_in_favour(atlas_->domain().mdp(m), {weights.data(), static_cast<std::size_t>(weights.size())},
                       robot_weights_, {.scale = atlas_->domain().count_scale()});
  if (!behaviour) return kNoOptimum;
  for (const StateIndex s : states) losses.push_back(lost(s, behaviour->counts[s.value()]));
  return number_of(world, losses);
}

PlannedExpectations::BehaviourIndex PlannedExpectations::number_of(World& world, const std::vector<LossIndex>& losses) {
  const auto [place, is_new] =
      world.by_losses.try_emplace({losses.begin(), losses.end()}, static_cast<BehaviourIndex>(world.behaviours.size()));
  if (is_new) {
    world.behaviours.push_back({losses, {}});
    behaviour_bytes_ += 2 * losses.size() * sizeof(LossIndex) + 100;
  }
  return place->second;
}

PlannedExpectations::LossIndex PlannedExpectations::number_of(const IntegerVector& loss) {
  const auto [place, is_new] = loss_index_.try_emplace(loss, static_cast<LossIndex>(losses_.size()));
  if (is_new) {
    Loss entry{loss, -1};
    const auto half_space = preference_of_robot(atlas_->domain(), loss);
    // Equally good behaviours tell nothing here: not all comparisons of such are known.
    if (half_space && sign_of_dot(half_space->normal(), atlas_->domain().weights().integer) > 0) {
      entry.constraint = static_cast<std::int32_t>(constraints_->add(*half_space).value());
    }
    losses_.push_back(entry);
  }
  return place->second;
}

std::size_t PlannedExpectations::memory() const noexcept {
  return cells_.size() * (sizeof(Cell) + sizeof(Direction) + kBytesOfNode) +
         losses_.size() * (2 * sizeof(Loss) + kBytesOfNode) +
         remembered_.size() * worlds_.size() * sizeof(BehaviourIndex) + behaviour_bytes_;
}

PlannedExpectations::SetIndex PlannedExpectations::number_of_set(std::vector<std::uint32_t> set) {
  const std::size_t bytes = set.size() * sizeof(std::uint32_t) + 64;
  const auto [place, is_new] = set_index_.try_emplace(std::move(set), static_cast<SetIndex>(sets_.size()));
  if (is_new) {
    sets_.push_back(&place->first);
    behaviour_bytes_ += bytes;
  }
  return place->second;
}

// The set with one constraint more, or the same if that tells nothing.
PlannedExpectations::SetIndex PlannedExpectations::with(SetIndex set, std::int32_t constraint) {
  if (constraint < 0) return set;
  const auto c = static_cast<std::uint32_t>(constraint);
  const auto [place, is_new] = with_.try_emplace((std::uint64_t{set} << 32u) | c, kNoSet);
  if (!is_new) return place->second;
  behaviour_bytes_ += 4 * sizeof(std::uint64_t);
  auto members = *sets_[set];
  const auto at = std::lower_bound(members.begin(), members.end(), c);
  if (at == members.end() || *at != c) members.insert(at, c);
  return place->second = number_of_set(std::move(members));
}

// What a behaviour conveys from every state on candidates' paths: what follows, and the loss there. All states of a
// cycle convey the same.
void PlannedExpectations::find_sets(MdpIndex m, Kept& behaviour) {
  const auto states = partitions_->states(m);
  const SetIndex nothing = number_of_set({});
  behaviour.sets.assign(states.size(), kNoSet);
  behaviour_bytes_ += states.size() * sizeof(SetIndex);
  const auto with_loss_at = [&](SetIndex set, std::size_t place) {
    return with(set, losses_[static_cast<std::size_t>(behaviour.losses[place])].constraint);
  };
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < states.size(); ++i) {
    SetIndex set = nothing;
    open.clear();
    for (std::optional<StartIndex> at = atlas_->index({m, states[i]}); at; at = atlas_->next(*at)) {
      const auto place = static_cast<std::size_t>(partitions_->place(*at));
      if (behaviour.sets[place] != kNoSet) {
        set = behaviour.sets[place];
        break;
      }
      if (const auto cycle = atlas_->cycle_length(*at); cycle > 0) {
        std::vector<std::size_t> round;
        for (auto on = *at; round.size() < cycle; on = *atlas_->next(on)) {
          round.push_back(static_cast<std::size_t>(partitions_->place(on)));
          set = with_loss_at(set, round.back());
        }
        for (const std::size_t on : round) behaviour.sets[on] = set;
        break;
      }
      open.push_back(place);
    }
    for (auto place = open.rbegin(); place != open.rend(); ++place) {
      set = with_loss_at(set, *place);
      behaviour.sets[*place] = set;
    }
  }
}

PlannedExpectations::SetIndex PlannedExpectations::union_of(std::vector<SetIndex>& sets) {
  std::sort(sets.begin(), sets.end());
  sets.erase(std::unique(sets.begin(), sets.end()), sets.end());
  if (sets.empty()) return number_of_set({});
  if (sets.size() == 1) return sets.front();
  const auto [place, is_new] = unions_.try_emplace(sets, kNoSet);
  if (!is_new) return place->second;
  behaviour_bytes_ += (sets.size() + 16) * sizeof(SetIndex);
  std::vector<std::uint32_t> members;
  for (const SetIndex set : sets) members.insert(members.end(), sets_[set]->begin(), sets_[set]->end());
  std::sort(members.begin(), members.end());
  members.erase(std::unique(members.begin(), members.end()), members.end());
  return place->second = number_of_set(std::move(members));
}

// What people of these cells do in an MDP, each behaviour once; not that there is no optimum.
std::vector<PlannedExpectations::BehaviourIndex> PlannedExpectations::behaviours_of(
    std::span<const PolicyCellIndex> cells, MdpIndex m) {
  std::vector<BehaviourIndex> found;
  for (const PolicyCellIndex cell : cells) {
    const auto behaviour = behaviour_of(cell, m);
    if (behaviour != kNoOptimum) found.push_back(behaviour);
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  for (const auto behaviour : found) {
    auto& kept = worlds_[m.value()].behaviours[static_cast<std::size_t>(behaviour)];
    if (kept.sets.empty()) find_sets(m, kept);
  }
  return found;
}

PlannedExpectations::SetIndex PlannedExpectations::conveyed_by(StartIndex start,
                                                               std::span<const BehaviourIndex> behaviours) {
  const World& world = worlds_[atlas_->id(start).mdp.value()];
  const auto place = static_cast<std::size_t>(partitions_->place(start));
  std::vector<SetIndex> sets;
  for (const auto behaviour : behaviours) {
    sets.push_back(world.behaviours[static_cast<std::size_t>(behaviour)].sets[place]);
  }
  return union_of(sets);
}

// What people of these cells are told by the demonstrations of the component's classes: a set for each class, and
// kNoSet for those of other components.
std::vector<PlannedExpectations::SetIndex> PlannedExpectations::sets_by_class(const KnowledgeComponent& component,
                                                                              std::span<const PolicyCellIndex> cells) {
  std::vector<std::vector<BehaviourIndex>> by_mdp(worlds_.size());
  for (std::size_t m = 0; m < worlds_.size(); ++m) {
    if (component.uses_mdp[m]) by_mdp[m] = behaviours_of(cells, MdpIndex{m});
  }

  std::vector<SetIndex> by_class(atlas_->num_start_classes(), kNoSet);
  // Classes that follow each other mostly start in the same MDP, and many convey the same: then the last union is it.
  std::vector<SetIndex> own, last;
  std::size_t last_mdp = worlds_.size();
  SetIndex last_set = kNoSet;
  for (const auto c : component.start_classes) {
    const StartIndex start = atlas_->members(c).front();
    const std::size_t m = atlas_->id(start).mdp.value();
    const auto place = static_cast<std::size_t>(partitions_->place(start));
    own.clear();
    for (const auto behaviour : by_mdp[m]) {
      own.push_back(worlds_[m].behaviours[static_cast<std::size_t>(behaviour)].sets[place]);
    }

    if (m != last_mdp || own != last) {
      last = own;
      last_mdp = m;
      last_set = union_of(own);
    }
    by_class[c.value()] = last_set;
  }
  return by_class;
}

// Numbers the constraints that occur in any of the sets: few of all, so that rows are short.
void PlannedExpectations::number_constraints_of(std::span<const SetIndex> sets) {
  numbering_.clear();
  for (const SetIndex set : sets) {
    for (const std::uint32_t c : *sets_[set]) numbering_.emplace_back(c);
  }
  std::sort(numbering_.begin(), numbering_.end());
  numbering_.erase(std::unique(numbering_.begin(), numbering_.end()), numbering_.end());
  if (numbering_.empty()) numbering_.emplace_back(0);  // one bit that nobody sets, even if there are no constraints

  bit_of_.resize(std::max(constraints_->size(), std::size_t{1}));
  for (std::size_t i = 0; i < numbering_.size(); ++i) bit_of_[numbering_[i].value()] = static_cast<std::uint32_t>(i);
}

Behaviours::Conveyed PlannedExpectations::conveyed_by_class(const KnowledgeComponent& component,
                                                            std::span<const PolicyCellIndex> cells) {
  make_room();
  const auto by_class = sets_by_class(component, cells);
  auto distinct = by_class;
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());  // neighbours mostly convey the same
  std::sort(distinct.begin(), distinct.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  if (!distinct.empty() && distinct.back() == kNoSet) distinct.pop_back();
  number_constraints_of(distinct);

  const std::size_t words = (numbering_.size() + kBits - 1) / kBits;
  if (by_class.size() * words > rows_.capacity()) {
    require_memory(by_class.size() * words * sizeof(std::uint64_t),
                   "comparing what " + std::to_string(by_class.size()) + " starts tell",
                   "teach from some starts only: [family] starts = 1000");
  }

  // A row for each different set, then a copy for each class.
  std::vector<std::uint64_t> row_of(distinct.size() * words, 0);
  for (std::size_t i = 0; i < distinct.size(); ++i) {
    for (const std::uint32_t constraint : *sets_[distinct[i]]) {
      const std::size_t bit = bit_of_[constraint];
      row_of[i * words + bit / kBits] |= std::uint64_t{1} << (bit % kBits);
    }
  }
  rows_.assign(by_class.size() * words, 0);
  for (std::size_t c = 0; c < by_class.size(); ++c) {
    if (by_class[c] == kNoSet) continue;
    const auto place = std::lower_bound(distinct.begin(), distinct.end(), by_class[c]) - distinct.begin();
    std::copy_n(&row_of[static_cast<std::size_t>(place) * words], words, &rows_[c * words]);
  }
  return {words, rows_, numbering_};
}

ConstraintSet PlannedExpectations::conveyed(StartIndex start, std::span<const PolicyCellIndex> cells) {
  make_room();
  ConstraintSet result;
  const auto behaviours = behaviours_of(cells, atlas_->id(start).mdp);
  for (const std::uint32_t c : *sets_[conveyed_by(start, behaviours)]) result.insert(ConstraintIndex{c});
  return result;
}

}  // namespace

std::unique_ptr<Expectations> expect_by_plans(const Atlas& atlas, ConstraintTable& constraints, std::size_t max_cells,
                                              std::size_t max_row_bytes, std::shared_ptr<PolicyPartitions> partitions) {
  return std::make_unique<PlannedExpectations>(atlas, constraints, max_cells, max_row_bytes, std::move(partitions));
}

}  // namespace kith
