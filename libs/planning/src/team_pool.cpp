#include <stdexcept>

#include "kith/planning/power.hpp"

namespace kith {
namespace {

constexpr std::size_t kNumQuantities = 4;

}  // namespace

TeamPool::TeamPool(const StudySpec& spec, std::span<const TeamRecord> teams)
    : compositions_{spec.compositions}, replicates_{spec.replicates} {
  for (const auto& strategy : spec.strategies) strategies_.push_back(strategy.name);
  if (teams.size() != strategies_.size() * compositions_.size() * replicates_)
    throw std::invalid_argument{"TeamPool: not all teams of the study"};
  values_.assign(kNumQuantities, {});
  std::size_t i = 0;
  for (const auto& strategy : strategies_) {
    for (const auto& composition : compositions_) {
      for (std::size_t r = 1; r <= replicates_; ++r, ++i) {
        const auto& address = teams[i].address;
        if (address.strategy != strategy || address.composition != composition || address.replicate != r)
          throw std::invalid_argument{"TeamPool: teams are not in the order of the tables"};
        for (std::size_t q = 0; q < kNumQuantities; ++q)
          values_[q].push_back(value_of(teams[i], static_cast<Quantity>(q)));
      }
    }
  }
}

TeamPool::TeamPool(std::vector<std::string> strategies, std::vector<std::string> compositions,
                   std::vector<std::vector<std::vector<double>>> values)
    : strategies_{std::move(strategies)}, compositions_{std::move(compositions)} {
  if (values.size() != strategies_.size() || values.empty() || values.front().empty())
    throw std::invalid_argument{"TeamPool: one table of outcomes per strategy"};
  replicates_ = values.front().front().size();
  std::vector<double> all;
  for (const auto& by_composition : values) {
    if (by_composition.size() != compositions_.size())
      throw std::invalid_argument{"TeamPool: one row of outcomes per composition"};
    for (const auto& cell : by_composition) {
      if (cell.size() != replicates_) throw std::invalid_argument{"TeamPool: as many outcomes in every cell"};
      all.insert(all.end(), cell.begin(), cell.end());
    }
  }
  values_.assign(kNumQuantities, all);
}

std::span<const double> TeamPool::cell(Quantity quantity, std::size_t strategy, std::size_t composition) const {
  const auto& all = values_[static_cast<std::size_t>(quantity)];
  return std::span{all}.subspan((strategy * compositions_.size() + composition) * replicates_, replicates_);
}

}  // namespace kith
