#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace kith::testing {

/// What can be chosen in one respect.
struct Factor {
  std::string name;
  std::vector<std::string> levels;
};

/// A level of a factor, by their numbers.
struct Level {
  std::size_t factor = 0;
  std::size_t level = 0;
  friend auto operator<=>(const Level&, const Level&) = default;
};

/// Whether two levels of different factors can be combined.
using CanCombine = std::function<bool(const Level&, const Level&)>;

/// Combinations of one level per factor in which every two levels that can be combined, in some whole combination, are
/// combined at least once. Each begins with a pair that is still missing; then factor by factor the level that adds
/// most pairs. Always the same. Put the factors that exclude most first.
class CoveringArray {
 public:
  CoveringArray(std::vector<Factor> factors, CanCombine can_combine)
      : factors_{std::move(factors)}, can_combine_{std::move(can_combine)} {
    for_each_level(0, [&](const Level& a) {
      for_each_level(a.factor + 1, [&](const Level& b) {
        if (can_combine_(a, b)) missing_.emplace(a, b);
      });
    });
    while (!missing_.empty()) add_row(*missing_.begin());
  }

  [[nodiscard]] const std::vector<Factor>& factors() const { return factors_; }
  /// Per row the number of the level of each factor.
  [[nodiscard]] const std::vector<std::vector<std::size_t>>& rows() const { return rows_; }
  [[nodiscard]] std::size_t num_pairs() const { return num_pairs_; }
  [[nodiscard]] bool can_combine(const Level& a, const Level& b) const { return can_combine_(a, b); }

 private:
  using Row = std::vector<std::optional<std::size_t>>;

  template <typename Action>
  void for_each_level(std::size_t first, const Action& action) const {
    for (std::size_t f = first; f < factors_.size(); ++f) {
      for (std::size_t l = 0; l < factors_[f].levels.size(); ++l) action(Level{f, l});
    }
  }

  // How many missing pairs the level adds to the row; nothing if it does not fit.
  [[nodiscard]] std::optional<std::size_t> gain(const Row& row, const Level& added) const {
    std::size_t pairs = 0;
    for (std::size_t f = 0; f < row.size(); ++f) {
      if (!row[f] || f == added.factor) continue;
      const auto [a, b] = std::minmax(Level{f, *row[f]}, added);
      if (!can_combine_(a, b)) return std::nullopt;
      pairs += missing_.count({a, b});
    }
    return pairs;
  }

  // The levels of a factor that fit, those that add most first; goes back where nothing fits any more.
  [[nodiscard]] bool fill(Row& row, std::size_t factor) const {
    if (factor == row.size()) return true;
    if (row[factor]) return fill(row, factor + 1);
    std::set<std::pair<std::size_t, std::size_t>> best;  // pairs that are not added, level
    for (std::size_t l = 0; l < factors_[factor].levels.size(); ++l) {
      if (const auto pairs = gain(row, {factor, l})) best.emplace(factors_.size() - *pairs, l);
    }
    for (const auto& [rest, level] : best) {
      row[factor] = level;
      if (fill(row, factor + 1)) return true;
    }
    row[factor].reset();
    return false;
  }

  void add_row(std::pair<Level, Level> pair) {
    Row row(factors_.size());
    row[pair.first.factor] = pair.first.level;
    row[pair.second.factor] = pair.second.level;
    if (!fill(row, 0)) {
      missing_.erase(pair);
      return;
    }
    auto& added = rows_.emplace_back();
    for (std::size_t f = 0; f < row.size(); ++f) {
      added.push_back(*row[f]);
      for (std::size_t g = 0; g < f; ++g) num_pairs_ += missing_.erase({Level{g, *row[g]}, Level{f, *row[f]}});
    }
  }

  std::vector<Factor> factors_;
  CanCombine can_combine_;
  std::set<std::pair<Level, Level>> missing_;
  std::size_t num_pairs_ = 0;
  std::vector<std::vector<std::size_t>> rows_;
};

}  // namespace kith::testing
