#include "kith/bec/behaviours.hpp"

#include <deque>

#include "expectations.hpp"
#include "kith/mdp/behaviour.hpp"
#include "robot_plan.hpp"

namespace kith {

ConstraintSet Behaviours::Conveyed::set(StartClassIndex c) const {
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
  if (atlas.find_tables()) return;
  const Domain& domain = atlas.domain();
  for (const std::int64_t w : domain.weights().integer) robot_weights_.push_back(static_cast<double>(w));
  current_ = std::make_shared<Generation>(domain.num_mdps(), bytes_);
  places_.assign(atlas.num_states(), -1);
  for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) {
    std::vector<bool> is_on_path(domain.mdp(m).num_states(), false);
    for (const StateIndex start : domain.starts(m)) {
      for (const StartIndex start_index : atlas.path(atlas.index({m, start})))
        is_on_path[atlas.id(start_index).start.value()] = true;
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
    : atlas_{&atlas}, constraints_{atlas.constraints()} {
  for (const std::int64_t w : atlas.domain().weights().integer) robot_weights_.push_back(static_cast<double>(w));
  people_ = atlas.find_tables() ? expect_by_tables(atlas, max_row_bytes)
                                : expect_by_plans(atlas, constraints_, max_cells, max_row_bytes, std::move(partitions));
}

Behaviours::~Behaviours() = default;

PolicyCellIndex Behaviours::locate(const Direction& weights) { return people_->locate(weights); }

std::optional<IntegerVector> Behaviours::answer(StartIndex start, PolicyCellIndex cell) {
  return people_->answer(start, cell);
}

const Direction& Behaviours::weights(PolicyCellIndex cell) const { return people_->weights(cell); }

Behaviours::Conveyed Behaviours::conveyed_by_class(const KnowledgeComponent& component,
                                                   std::span<const PolicyCellIndex> cells) {
  return people_->conveyed_by_class(component, cells);
}

ConstraintSet Behaviours::conveyed(StartIndex start, std::span<const PolicyCellIndex> cells) {
  return people_->conveyed(start, cells);
}

std::size_t Behaviours::memory() const noexcept {
  return constraints_.size() * (2 * sizeof(HalfSpace) + kBytesOfNode) + people_->memory();
}

std::optional<Trajectory> Behaviours::trajectory(StartIndex start_index, const Direction& weights) const {
  const auto [m, start] = atlas_->id(start_index);
  const Mdp& mdp = atlas_->domain().mdp(m);
  const auto behaviour = behave_in_favour(mdp, {weights.data(), static_cast<std::size_t>(weights.size())},
                                          robot_weights_, {.scale = atlas_->domain().count_scale()});
  if (!behaviour) return std::nullopt;
  return shown_path(mdp, behaviour->choice, likeliest_next(mdp, behaviour->choice), start);
}

ConstraintSet Behaviours::numbers_of(std::span<const HalfSpace> half_spaces) {
  ConstraintSet numbers{constraints_.size()};
  for (const HalfSpace& half_space : half_spaces) numbers.insert(constraints_.add(half_space));
  return numbers;
}

}  // namespace kith
