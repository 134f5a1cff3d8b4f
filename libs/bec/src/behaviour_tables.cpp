#include "kith/bec/behaviour_tables.hpp"

#include <algorithm>

namespace kith {

std::vector<IntegerVector> BehaviourTables::coverage_set(StartIndex start_index) const {
  const auto& start = starts_[start_index.value()];
  std::vector<IntegerVector> vertices;
  for (const auto& loss : hull(start.hull).losses) vertices.push_back(start.robot_counts - loss);
  std::sort(vertices.begin(), vertices.end());
  return vertices;
}

std::optional<IntegerVector> BehaviourTables::answer(StartIndex start_index, PolicyCellIndex cell) const {
  const auto& start = starts_[start_index.value()];
  const auto choice = cells_.choice(cell, start.hull);
  if (choice == PolicyCells::kNone) return std::nullopt;
  return start.robot_counts - hull(start.hull).losses[choice];
}

void BehaviourTables::add_conveyed(StartClassIndex start_class, ConstraintSet& set) const {
  for (const auto h : hulls_of_class_[start_class.value()]) {
    for (const auto c : constraints_[h.value()]) {
      if (c >= 0) set.insert(ConstraintIndex{static_cast<std::size_t>(c)});
    }
  }
}

void BehaviourTables::add_conveyed(HullIndex h, std::span<const PolicyCellIndex> cells,
                                   std::span<std::uint64_t> row) const {
  const auto& constraint_of = constraints_[h.value()];
  for (const auto cell : cells) {
    const auto choice = cells_.choice(cell, h);
    if (choice == PolicyCells::kNone || constraint_of[choice] < 0) continue;
    const auto c = static_cast<std::size_t>(constraint_of[choice]);
    row[c / 64] |= std::uint64_t{1} << (c % 64);
  }
}

std::vector<std::uint64_t> BehaviourTables::conveyed_by_class(std::span<const PolicyCellIndex> cells) const {
  const auto words = (num_constraints_ + 63) / 64;
  std::vector<std::uint64_t> by_hull(hulls_.size() * words, 0);
  for (std::size_t h = 0; h < hulls_.size(); ++h) {
    add_conveyed(HullIndex{h}, cells, std::span{by_hull}.subspan(h * words, words));
  }
  std::vector<std::uint64_t> by_class(hulls_of_class_.size() * words, 0);
  for (std::size_t c = 0; c < hulls_of_class_.size(); ++c) {
    for (const auto h : hulls_of_class_[c]) {
      for (std::size_t i = 0; i < words; ++i) by_class[c * words + i] |= by_hull[h.value() * words + i];
    }
  }
  return by_class;
}

ConstraintSet BehaviourTables::conveyed(StartClassIndex start_class, std::span<const PolicyCellIndex> cells) const {
  ConstraintSet set{num_constraints_};
  for (const auto h : hulls_of_class_[start_class.value()]) add_conveyed(h, cells, set.words());
  return set;
}

}  // namespace kith
