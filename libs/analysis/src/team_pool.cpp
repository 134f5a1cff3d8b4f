#include <algorithm>
#include <stdexcept>

#include "kith/analysis/study_power.hpp"

namespace kith {
namespace {

// Those of exams come last.
std::size_t num_outcomes(const StudySpec& spec) {
  const auto without_exam = std::ranges::count(outcomes(), false, &StudyOutcome::needs_exam);
  return spec.exam == ExamLevel::kNone ? static_cast<std::size_t>(without_exam) : outcomes().size();
}

}  // namespace

TeamPool TeamPool::empty(const StudySpec& spec) {
  TeamPool pool;
  for (const auto& strategy : spec.strategies) pool.strategies_.push_back(strategy.name);
  pool.compositions_ = spec.compositions;
  pool.replicates_ = spec.replicates;
  const auto teams = pool.strategies_.size() * pool.compositions_.size() * pool.replicates_;
  pool.values_.assign(num_outcomes(spec), std::vector<double>(teams));
  return pool;
}

void TeamPool::set(std::size_t position, const TeamRecord& team) {
  for (std::size_t q = 0; q < values_.size(); ++q) values_[q].at(position) = outcomes()[q].of(team);
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
  values_.assign(outcomes().size(), all);
}

TeamPool TeamPool::joined(std::span<const TeamPool> pools) {
  if (pools.empty()) throw std::invalid_argument{"TeamPool: nothing to join"};
  TeamPool all;
  all.strategies_ = pools.front().strategies_;
  all.compositions_ = pools.front().compositions_;
  for (const auto& pool : pools) {
    if (pool.strategies_ != all.strategies_ || pool.compositions_ != all.compositions_ ||
        pool.values_.size() != pools.front().values_.size())
      throw std::invalid_argument{"TeamPool: pools of different designs"};
    all.replicates_ += pool.replicates_;
  }
  all.values_.assign(pools.front().values_.size(), {});
  for (std::size_t q = 0; q < all.values_.size(); ++q) {
    for (std::size_t s = 0; s < all.strategies_.size(); ++s) {
      for (std::size_t c = 0; c < all.compositions_.size(); ++c) {
        for (const auto& pool : pools) {
          const auto cell = pool.cell(outcomes()[q], s, c);
          all.values_[q].insert(all.values_[q].end(), cell.begin(), cell.end());
        }
      }
    }
  }
  return all;
}

std::span<const double> TeamPool::cell(const StudyOutcome& outcome, std::size_t strategy,
                                       std::size_t composition) const {
  const auto place = static_cast<std::size_t>(&outcome - outcomes().data());
  if (place >= values_.size()) throw std::invalid_argument{"TeamPool: the teams were not examined"};
  const auto& all = values_[place];
  return std::span{all}.subspan((strategy * compositions_.size() + composition) * replicates_, replicates_);
}

}  // namespace kith
