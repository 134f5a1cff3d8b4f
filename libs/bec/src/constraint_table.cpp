#include "kith/bec/constraint_table.hpp"

#include <algorithm>
#include <stdexcept>

namespace kith {

ConstraintIndex ConstraintTable::add(const HalfSpace& half_space) {
  const auto [place, is_new] = index_.try_emplace(half_space, half_spaces_.size());
  if (is_new) half_spaces_.push_back(half_space);
  return place->second;
}

std::optional<ConstraintIndex> ConstraintTable::find(const HalfSpace& half_space) const {
  const auto place = index_.find(half_space);
  if (place == index_.end()) return std::nullopt;
  return place->second;
}

std::vector<HalfSpace> ConstraintTable::half_spaces(const ConstraintSet& set) const {
  std::vector<HalfSpace> result;
  for (const auto c : set.members()) result.push_back((*this)[c]);
  std::sort(result.begin(), result.end());
  return result;
}

ConstraintSet ConstraintTable::set_of(std::span<const HalfSpace> half_spaces) const {
  ConstraintSet set{size()};
  for (const auto& half_space : half_spaces) {
    const auto c = find(half_space);
    if (!c)
      throw std::invalid_argument{"ConstraintTable::set_of: " + to_string(half_space.normal()) +
                                  " is not in the table"};
    set.insert(*c);
  }
  return set;
}

}  // namespace kith
