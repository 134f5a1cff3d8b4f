#include "kith/bec/behaviours.hpp"

#include <algorithm>
#include <bit>

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

ConstraintSet Behaviours::Conveyed::set(DemoClassIndex c) const {
  const auto row = rows.subspan(c.value() * words, words);
  if (numbering.empty()) return ConstraintSet{row};
  ConstraintSet result;
  for (std::size_t i = 0; i < numbering.size(); ++i) {
    if ((row[i / kBits] >> (i % kBits) & 1u) != 0) result.insert(numbering[i]);
  }
  return result;
}

Behaviours::Behaviours(const Atlas& atlas, std::size_t max_cells, std::size_t max_row_bytes)
    : atlas_{&atlas}, max_cells_{std::max<std::size_t>(max_cells, 1)}, constraints_{atlas.constraints()} {
  const std::size_t row_bytes = atlas.num_demo_classes() * atlas.words_per_set() * sizeof(std::uint64_t);
  max_cells_with_rows_ = std::max<std::size_t>(max_row_bytes / std::max<std::size_t>(row_bytes, 1), 1);
  const Domain& domain = atlas.domain();
  for (const std::int64_t w : domain.weights().integer) robot_weights_.push_back(static_cast<double>(w));
  if (atlas.is_tabulated()) return;
  require_memory(teaching_memory(domain), "choosing what to teach in domain '" + domain.id() + "'",
                 "use a smaller map, or teach from some starts only: [family] starts = 1000");
  place_on_paths_.assign(atlas.num_demos(), -1);
  for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) {
    std::vector<bool> is_on_path(domain.mdp(m).num_states(), false);
    for (const StateIndex start : domain.starts(m)) {
      for (const DemoIndex demo : atlas.path(atlas.index({m, start}))) is_on_path[atlas.id(demo).start.value()] = true;
    }
    auto& states = states_on_paths_.emplace_back();
    for (StateIndex s{0}; s.value() < is_on_path.size(); ++s) {
      if (!is_on_path[s.value()]) continue;
      place_on_paths_[atlas.index({m, s}).value()] = static_cast<std::int32_t>(states.size());
      states.push_back(s);
    }
  }
}

PolicyCellIndex Behaviours::locate(const Direction& weights) {
  if (atlas_->is_tabulated()) return atlas_->cells().locate(Eigen::Vector3d{weights});
  const auto [place, is_new] = index_.try_emplace(weights, PolicyCellIndex{cells_.size()});
  if (is_new) cells_.push_back({weights, {}});
  return place->second;
}

std::optional<IntegerVector> Behaviours::answer(DemoIndex demo, PolicyCellIndex cell) {
  if (atlas_->is_tabulated()) return atlas_->answer(demo, cell);
  const Plan& plan = plan_of(cell, atlas_->id(demo).mdp);
  if (!plan.has_optimum) return std::nullopt;
  return atlas_->feature_counts(demo) - losses_[static_cast<std::size_t>(loss_at(plan, demo))].counts;
}

Behaviours::LossIndex Behaviours::loss_at(const Plan& plan, DemoIndex demo) const {
  const std::int32_t place = place_on_paths_[demo.value()];
  KITH_ASSERT(place >= 0);
  return plan.losses[static_cast<std::size_t>(place)];
}

const Behaviours::Plan& Behaviours::plan_of(PolicyCellIndex cell, MdpIndex m) {
  if (cells_[cell.value()].plans.empty()) remember(cell);
  Plan& result = cells_[cell.value()].plans[m.value()];
  if (!result.is_known) plan(cells_[cell.value()].weights, m, result);
  return result;
}

// Makes room for the cell's plans; the cell remembered for longest gives way.
void Behaviours::remember(PolicyCellIndex cell) {
  if (remembered_.size() < max_cells_) {
    remembered_.push_back(cell);
  } else {
    auto& forgotten = cells_[remembered_[oldest_].value()].plans;
    forgotten.clear();
    forgotten.shrink_to_fit();
    remembered_[oldest_] = cell;
    oldest_ = (oldest_ + 1) % max_cells_;
  }
  cells_[cell.value()].plans.resize(atlas_->domain().num_mdps());
}

void Behaviours::plan(const Direction& weights, MdpIndex m, Plan& result) {
  const Domain& domain = atlas_->domain();
  const auto behaviour = behave_in_favour(domain.mdp(m), {weights.data(), static_cast<std::size_t>(weights.size())},
                                          robot_weights_, {.scale = domain.count_scale()});
  result.is_known = true;
  result.has_optimum = behaviour.has_value();
  if (!behaviour) return;
  for (const StateIndex s : states_on_paths_[m.value()]) {
    result.losses.push_back(number_of(atlas_->feature_counts(atlas_->index({m, s})) - behaviour->counts[s.value()]));
  }
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
  const auto next = likeliest_next(mdp, behaviour->choice);
  Trajectory path{{start}, {}};
  for (auto s = start; !mdp.is_terminal(s); s = path.states.back()) {
    if (next[s.value()] == RobotPlan::kEnd) break;
    path.actions.push_back(mdp.choices(s)[behaviour->choice[s.value()]].action);
    path.states.emplace_back(next[s.value()]);
  }
  return path;
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
  std::size_t states = 0;
  for (const auto& list : states_on_paths_) states += list.size();
  return bytes + remembered_.size() * (states * sizeof(LossIndex) + states_on_paths_.size() * sizeof(Plan));
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

void Behaviours::add_conveyed(DemoIndex demo, std::span<const PolicyCellIndex> cells,
                              std::vector<ConstraintIndex>& constraints) {
  const MdpIndex m = atlas_->id(demo).mdp;
  const auto path = atlas_->path(demo);
  for (const PolicyCellIndex cell : cells) {
    const Plan& plan = plan_of(cell, m);
    if (!plan.has_optimum) continue;
    for (const DemoIndex at : path) {
      const auto c = losses_[static_cast<std::size_t>(loss_at(plan, at))].constraint;
      if (c >= 0) constraints.emplace_back(static_cast<std::size_t>(c));
    }
  }
  std::sort(constraints.begin(), constraints.end());
  constraints.erase(std::unique(constraints.begin(), constraints.end()), constraints.end());
}

// Rows over the constraints that occur here, which are few of all.
Behaviours::Conveyed Behaviours::planned(const KnowledgeComponent& component, std::span<const PolicyCellIndex> cells) {
  std::vector<std::vector<ConstraintIndex>> by_class(atlas_->num_demo_classes());
  numbering_.clear();
  for (DemoClassIndex c{0}; c.value() < by_class.size(); ++c) {
    if (!atlas_->belongs_to(c, component)) continue;
    auto& constraints = by_class[c.value()];
    add_conveyed(atlas_->members(c).front(), cells, constraints);
    numbering_.insert(numbering_.end(), constraints.begin(), constraints.end());
  }
  std::sort(numbering_.begin(), numbering_.end());
  numbering_.erase(std::unique(numbering_.begin(), numbering_.end()), numbering_.end());
  if (numbering_.empty()) numbering_.emplace_back(0);  // one bit that nobody sets
  bit_of_.resize(constraints_.size());
  for (std::size_t i = 0; i < numbering_.size(); ++i) bit_of_[numbering_[i].value()] = static_cast<std::uint32_t>(i);

  const std::size_t words = (numbering_.size() + kBits - 1) / kBits;
  if (by_class.size() * words > rows_.capacity()) {
    require_memory(by_class.size() * words * sizeof(std::uint64_t),
                   "comparing what " + std::to_string(by_class.size()) + " starts tell",
                   "teach from some starts only: [family] starts = 1000");
  }
  rows_.assign(by_class.size() * words, 0);
  for (std::size_t c = 0; c < by_class.size(); ++c) {
    for (const ConstraintIndex constraint : by_class[c]) {
      const std::size_t bit = bit_of_[constraint.value()];
      rows_[c * words + bit / kBits] |= std::uint64_t{1} << (bit % kBits);
    }
  }
  return {words, rows_, numbering_};
}

ConstraintSet Behaviours::conveyed(DemoIndex demo, std::span<const PolicyCellIndex> cells) {
  if (atlas_->is_tabulated()) return atlas_->conveyed(demo, cells);
  std::vector<ConstraintIndex> constraints;
  add_conveyed(demo, cells, constraints);
  ConstraintSet result;
  for (const ConstraintIndex c : constraints) result.insert(c);
  return result;
}

}  // namespace kith
