#include "kith/bec/behaviours.hpp"

#include <algorithm>
#include <bit>
#include <deque>

#include "kith/bec/comparison.hpp"
#include "kith/bec/memory_needs.hpp"
#include "kith/core/assert.hpp"
#include "kith/core/memory.hpp"
#include "kith/mdp/behaviour.hpp"
#include "robot_plan.hpp"

namespace kith {
namespace {

constexpr std::size_t kBits = 64;

}  // namespace

std::size_t Behaviours::DirectionHash::operator()(const Direction& weights) const noexcept {
  std::uint64_t hash = 0x9E3779B97F4A7C15ull;
  for (const double w : weights) {
    hash = (hash ^ std::bit_cast<std::uint64_t>(w)) * 0xBF58476D1CE4E5B9ull;
    hash ^= hash >> 29;
  }
  return static_cast<std::size_t>(hash);
}

std::size_t Behaviours::WordsHash::operator()(const std::vector<std::uint32_t>& words) const noexcept {
  std::uint64_t hash = 0x9E3779B97F4A7C15ull;
  for (const std::uint32_t word : words) {
    hash = (hash ^ word) * 0xBF58476D1CE4E5B9ull;
    hash ^= hash >> 29;
  }
  return static_cast<std::size_t>(hash);
}

ConstraintSet Behaviours::Conveyed::set(DemoClassIndex c) const {
  const auto row = rows.subspan(c.value() * words, words);
  if (numbering.empty()) return ConstraintSet{row};
  ConstraintSet result;
  for (std::size_t i = 0; i < numbering.size(); ++i) {
    if ((row[i / kBits] >> (i % kBits) & 1u) != 0) result.insert(numbering[i]);
  }
  return result;
}

class PartitionStore::Generation {
 public:
  Generation(std::size_t num_mdps, std::shared_ptr<std::atomic<std::size_t>> all_bytes)
      : made_(num_mdps), partitions_(num_mdps), all_bytes_{std::move(all_bytes)} {}
  Generation(const Generation&) = delete;
  Generation& operator=(const Generation&) = delete;
  ~Generation() { *all_bytes_ -= bytes_; }

  // The partition of an MDP, made when first asked for.
  [[nodiscard]] PolicyPartition& partition(const PartitionStore& store, MdpIndex m) {
    auto& partition = partitions_[m.value()];
    std::call_once(made_[m.value()], [&] {
      const auto& domain = store.atlas().domain();
      partition.emplace(domain.mdp(m), store.states(m), store.robot_weights_,
                        BehaveOptions{.scale = domain.count_scale()});
    });
    return *partition;
  }

  [[nodiscard]] std::size_t bytes() const noexcept { return bytes_; }
  void add(std::size_t bytes) {
    bytes_ += bytes;
    *all_bytes_ += bytes;
  }

 private:
  std::deque<std::once_flag> made_;                         // per MDP
  std::vector<std::optional<PolicyPartition>> partitions_;  // per MDP
  std::atomic<std::size_t> bytes_ = 0;
  std::shared_ptr<std::atomic<std::size_t>> all_bytes_;
};

PartitionStore::PartitionStore(const Atlas& atlas, std::size_t max_bytes)
    : atlas_{&atlas}, max_bytes_{max_bytes}, bytes_{std::make_shared<std::atomic<std::size_t>>(0)} {
  if (atlas.is_tabulated()) return;
  const Domain& domain = atlas.domain();
  for (const std::int64_t w : domain.weights().integer) robot_weights_.push_back(static_cast<double>(w));
  current_ = std::make_shared<Generation>(domain.num_mdps(), bytes_);
  places_.assign(atlas.num_demos(), -1);
  for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) {
    std::vector<bool> is_on_path(domain.mdp(m).num_states(), false);
    for (const StateIndex start : domain.starts(m)) {
      for (const DemoIndex demo : atlas.path(atlas.index({m, start}))) is_on_path[atlas.id(demo).start.value()] = true;
    }
    auto& states = states_.emplace_back();
    for (StateIndex s{0}; s.value() < is_on_path.size(); ++s) {
      if (!is_on_path[s.value()]) continue;
      places_[atlas.index({m, s}).value()] = static_cast<std::int32_t>(states.size());
      states.push_back(s);
    }
  }
}

std::shared_ptr<PartitionStore::Generation> PartitionStore::current() const {
  const std::lock_guard lock{mutex_};
  return current_;
}

std::shared_ptr<PartitionStore::Generation> PartitionStore::current_with_room() {
  const std::lock_guard lock{mutex_};
  if (current_ && current_->bytes() >= max_bytes_ / 2) {
    current_ = std::make_shared<Generation>(atlas_->domain().num_mdps(), bytes_);
  }
  return current_;
}

PolicyPartitions::PolicyPartitions(std::shared_ptr<PartitionStore> store)
    : store_{std::move(store)}, generation_{store_->current_with_room()} {}

std::optional<PolicyPartitions::Located> PolicyPartitions::locate(MdpIndex m, const Direction& weights) {
  if (!can_be_partitioned(store_->atlas().domain().mdp(m))) return std::nullopt;
  const bool may_grow = generation_->bytes() < store_->max_bytes_ / 2 && store_->memory() < store_->max_bytes_;
  const bool has_optimum = lookup_.locate(generation_->partition(*store_, m),
                                          {weights.data(), static_cast<std::size_t>(weights.size())}, may_grow);
  if (lookup_.grown_by() > 0) generation_->add(lookup_.grown_by());  // else it would only keep other threads waiting
  return Located{&lookup_, has_optimum};
}

bool PolicyPartitions::is_outdated() const {
  return generation_ && (generation_->bytes() >= store_->max_bytes_ / 2 || generation_ != store_->current());
}

void PolicyPartitions::renew() {
  generation_.reset();  // first, so that it can be freed
  generation_ = store_->current_with_room();
}

Behaviours::Behaviours(const Atlas& atlas, std::size_t max_cells, std::size_t max_row_bytes,
                       std::shared_ptr<PolicyPartitions> partitions)
    : atlas_{&atlas},
      max_cells_{std::max<std::size_t>(max_cells, 1)},
      constraints_{atlas.constraints()},
      partitions_{std::move(partitions)} {
  const std::size_t row_bytes = atlas.num_demo_classes() * atlas.words_per_set() * sizeof(std::uint64_t);
  max_cells_with_rows_ = std::max<std::size_t>(max_row_bytes / std::max<std::size_t>(row_bytes, 1), 1);
  const Domain& domain = atlas.domain();
  for (const std::int64_t w : domain.weights().integer) robot_weights_.push_back(static_cast<double>(w));
  if (atlas.is_tabulated()) return;
  require_memory(teaching_memory(domain), "choosing what to teach in domain '" + domain.id() + "'",
                 "use a smaller map, or teach from some starts only: [family] starts = 1000");
  if (!partitions_) partitions_ = std::make_shared<PolicyPartitions>(atlas);
  worlds_.resize(domain.num_mdps());
  std::size_t states = 0;
  for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) states += partitions_->states(m).size();
  max_behaviour_bytes_ = std::max(max_cells_ * states * sizeof(LossIndex), max_row_bytes);
}

PolicyCellIndex Behaviours::locate(const Direction& weights) {
  if (atlas_->is_tabulated()) return atlas_->cells().locate(Eigen::Vector3d{weights});
  const auto [place, is_new] = index_.try_emplace(weights, PolicyCellIndex{cells_.size()});
  if (is_new) cells_.push_back({weights, {}});
  return place->second;
}

std::optional<IntegerVector> Behaviours::answer(DemoIndex demo, PolicyCellIndex cell) {
  if (atlas_->is_tabulated()) return atlas_->answer(demo, cell);
  make_room();
  const MdpIndex m = atlas_->id(demo).mdp;
  const auto b = behaviour_of(cell, m);
  if (b == kNoOptimum) return std::nullopt;
  const std::int32_t place = partitions_->place(demo);
  KITH_ASSERT(place >= 0);
  const auto loss = worlds_[m.value()].behaviours[static_cast<std::size_t>(b)].losses[static_cast<std::size_t>(place)];
  return atlas_->feature_counts(demo) - losses_[static_cast<std::size_t>(loss)].counts;
}

// Forgets the behaviours if they take too much; only between two calls, so that numbers stay valid within one.
void Behaviours::make_room() {
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

Behaviours::BehaviourIndex Behaviours::behaviour_of(PolicyCellIndex cell, MdpIndex m) {
  if (cells_[cell.value()].behaviours.empty()) remember(cell);
  auto& behaviour = cells_[cell.value()].behaviours[m.value()];
  if (behaviour == kUnknown) behaviour = find_behaviour(cells_[cell.value()].weights, m);
  return behaviour;
}

// Makes room for what the cell's behaviours are; the cell remembered for longest gives way.
void Behaviours::remember(PolicyCellIndex cell) {
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

Behaviours::BehaviourIndex Behaviours::find_behaviour(const Direction& weights, MdpIndex m) {
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

Behaviours::BehaviourIndex Behaviours::number_of(World& world, const std::vector<LossIndex>& losses) {
  const auto [place, is_new] =
      world.by_losses.try_emplace({losses.begin(), losses.end()}, static_cast<BehaviourIndex>(world.behaviours.size()));
  if (is_new) {
    world.behaviours.push_back({losses, {}});
    behaviour_bytes_ += 2 * losses.size() * sizeof(LossIndex) + 100;
  }
  return place->second;
}

Behaviours::LossIndex Behaviours::number_of(const IntegerVector& loss) {
  const auto [place, is_new] = loss_index_.try_emplace(loss, static_cast<LossIndex>(losses_.size()));
  if (is_new) {
    Loss entry{loss, -1};
    const auto half_space = preference_of_robot(atlas_->domain(), loss);
    // Equally good behaviours tell nothing here: not all comparisons of such are known.
    if (half_space && sign_of_dot(half_space->normal(), atlas_->domain().weights().integer) > 0) {
      entry.constraint = static_cast<std::int32_t>(constraints_.add(*half_space).value());
    }
    losses_.push_back(entry);
  }
  return place->second;
}

std::optional<Trajectory> Behaviours::trajectory(DemoIndex demo, const Direction& weights) const {
  const auto [m, start] = atlas_->id(demo);
  const Mdp& mdp = atlas_->domain().mdp(m);
  const auto behaviour = behave_in_favour(mdp, {weights.data(), static_cast<std::size_t>(weights.size())},
                                          robot_weights_, {.scale = atlas_->domain().count_scale()});
  if (!behaviour) return std::nullopt;
  return shown_path(mdp, behaviour->choice, likeliest_next(mdp, behaviour->choice), start);
}

Behaviours::Conveyed Behaviours::conveyed_by_class(const KnowledgeComponent& component,
                                                   std::span<const PolicyCellIndex> cells) {
  return atlas_->is_tabulated() ? tabulated(cells) : planned(component, cells);
}

// Makes room for the rows of a cell; those kept for longest give way.
const std::vector<std::uint64_t>& Behaviours::rows_of(PolicyCellIndex cell) {
  auto& rows = rows_by_cell_[cell.value()];
  if (!rows.empty()) return rows;
  if (cells_with_rows_.size() < max_cells_with_rows_) {
    cells_with_rows_.push_back(cell);
  } else {
    std::vector<std::uint64_t>{}.swap(rows_by_cell_[cells_with_rows_[oldest_rows_].value()]);
    cells_with_rows_[oldest_rows_] = cell;
    oldest_rows_ = (oldest_rows_ + 1) % max_cells_with_rows_;
  }
  return rows = atlas_->conveyed_by_class({&cell, 1});
}

ConstraintSet Behaviours::numbers_of(std::span<const HalfSpace> half_spaces) {
  ConstraintSet numbers{constraints_.size()};
  for (const HalfSpace& half_space : half_spaces) numbers.insert(constraints_.add(half_space));
  return numbers;
}

// Hash tables keep a node of about two pointers and a bucket beside each entry.
std::size_t Behaviours::memory() const noexcept {
  constexpr std::size_t kNode = 3 * sizeof(void*);
  const std::size_t per_constraint = 2 * sizeof(HalfSpace) + kNode;
  const std::size_t row = atlas_->num_demo_classes() * atlas_->words_per_set() * sizeof(std::uint64_t);
  std::size_t bytes = constraints_.size() * per_constraint + cells_with_rows_.size() * row;
  bytes += cells_.size() * (sizeof(Cell) + sizeof(Direction) + kNode);
  bytes += losses_.size() * (2 * sizeof(Loss) + kNode);
  return bytes + remembered_.size() * worlds_.size() * sizeof(BehaviourIndex) + behaviour_bytes_;
}

// Each cell's rows are computed once; several are their union.
Behaviours::Conveyed Behaviours::tabulated(std::span<const PolicyCellIndex> cells) {
  rows_by_cell_.resize(atlas_->cells().size());
  rows_.assign(atlas_->num_demo_classes() * atlas_->words_per_set(), 0);
  for (const auto cell : cells) {
    const auto& rows = rows_of(cell);
    const std::uint64_t* const from = rows.data();  // unchecked, for speed
    std::uint64_t* const to = rows_.data();
    for (std::size_t i = 0; i < rows.size(); ++i) to[i] |= from[i];
  }
  return {atlas_->words_per_set(), rows_, {}};
}

Behaviours::SetIndex Behaviours::number_of_set(std::vector<std::uint32_t> set) {
  const std::size_t bytes = set.size() * sizeof(std::uint32_t) + 64;
  const auto [place, is_new] = set_index_.try_emplace(std::move(set), static_cast<SetIndex>(sets_.size()));
  if (is_new) {
    sets_.push_back(&place->first);
    behaviour_bytes_ += bytes;
  }
  return place->second;
}

// The set with one constraint more, or the same if that tells nothing.
Behaviours::SetIndex Behaviours::with(SetIndex set, std::int32_t constraint) {
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
void Behaviours::find_sets(MdpIndex m, Kept& behaviour) {
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
    for (std::optional<DemoIndex> at = atlas_->index({m, states[i]}); at; at = atlas_->next(*at)) {
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

Behaviours::SetIndex Behaviours::union_of(std::vector<SetIndex>& sets) {
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
std::vector<Behaviours::BehaviourIndex> Behaviours::behaviours_of(std::span<const PolicyCellIndex> cells, MdpIndex m) {
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

Behaviours::SetIndex Behaviours::conveyed_by(DemoIndex demo, std::span<const BehaviourIndex> behaviours) {
  const World& world = worlds_[atlas_->id(demo).mdp.value()];
  const auto place = static_cast<std::size_t>(partitions_->place(demo));
  std::vector<SetIndex> sets;
  for (const auto behaviour : behaviours) {
    sets.push_back(world.behaviours[static_cast<std::size_t>(behaviour)].sets[place]);
  }
  return union_of(sets);
}

// Rows over the constraints that occur here, which are few of all.
Behaviours::Conveyed Behaviours::planned(const KnowledgeComponent& component, std::span<const PolicyCellIndex> cells) {
  make_room();
  std::vector<SetIndex> by_class(atlas_->num_demo_classes(), kNoSet);
  std::vector<std::vector<BehaviourIndex>> by_mdp(worlds_.size());
  for (std::size_t m = 0; m < worlds_.size(); ++m) {
    if (component.uses_mdp[m]) by_mdp[m] = behaviours_of(cells, MdpIndex{m});
  }
  // Classes that follow each other mostly start in the same MDP, and many convey the same.
  std::vector<SetIndex> distinct, own, last;
  std::size_t last_mdp = worlds_.size();
  SetIndex last_set = kNoSet;
  for (const auto c : component.demo_classes) {
    const DemoIndex demo = atlas_->members(c).front();
    const std::size_t m = atlas_->id(demo).mdp.value();
    const auto place = static_cast<std::size_t>(partitions_->place(demo));
    own.clear();
    for (const auto behaviour : by_mdp[m]) {
      own.push_back(worlds_[m].behaviours[static_cast<std::size_t>(behaviour)].sets[place]);
    }
    if (m != last_mdp || own != last) {
      last = own;
      last_mdp = m;
      last_set = union_of(own);
      distinct.push_back(last_set);
    }
    by_class[c.value()] = last_set;
  }
  std::sort(distinct.begin(), distinct.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  numbering_.clear();
  for (const SetIndex set : distinct) {
    for (const std::uint32_t c : *sets_[set]) numbering_.emplace_back(c);
  }
  std::sort(numbering_.begin(), numbering_.end());
  numbering_.erase(std::unique(numbering_.begin(), numbering_.end()), numbering_.end());
  if (numbering_.empty()) numbering_.emplace_back(0);  // one bit that nobody sets, even if there are no constraints
  bit_of_.resize(std::max(constraints_.size(), std::size_t{1}));
  for (std::size_t i = 0; i < numbering_.size(); ++i) bit_of_[numbering_[i].value()] = static_cast<std::uint32_t>(i);

  const std::size_t words = (numbering_.size() + kBits - 1) / kBits;
  if (by_class.size() * words > rows_.capacity()) {
    require_memory(by_class.size() * words * sizeof(std::uint64_t),
                   "comparing what " + std::to_string(by_class.size()) + " starts tell",
                   "teach from some starts only: [family] starts = 1000");
  }
  rows_.assign(by_class.size() * words, 0);
  std::vector<std::uint64_t> row_of(distinct.size() * words, 0);  // of each set
  for (std::size_t i = 0; i < distinct.size(); ++i) {
    for (const std::uint32_t constraint : *sets_[distinct[i]]) {
      const std::size_t bit = bit_of_[constraint];
      row_of[i * words + bit / kBits] |= std::uint64_t{1} << (bit % kBits);
    }
  }
  for (std::size_t c = 0; c < by_class.size(); ++c) {
    if (by_class[c] == kNoSet) continue;
    const auto place = std::lower_bound(distinct.begin(), distinct.end(), by_class[c]) - distinct.begin();
    std::copy_n(&row_of[static_cast<std::size_t>(place) * words], words, &rows_[c * words]);
  }
  return {words, rows_, numbering_};
}

ConstraintSet Behaviours::conveyed(DemoIndex demo, std::span<const PolicyCellIndex> cells) {
  if (atlas_->is_tabulated()) return atlas_->conveyed(demo, cells);
  make_room();
  ConstraintSet result;
  const auto behaviours = behaviours_of(cells, atlas_->id(demo).mdp);
  for (const std::uint32_t c : *sets_[conveyed_by(demo, behaviours)]) result.insert(ConstraintIndex{c});
  return result;
}

}  // namespace kith
