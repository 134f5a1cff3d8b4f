#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "kith/analysis/factor.hpp"
#include "kith/analysis/study_power.hpp"

namespace kith {

// Which teams of a pool a study has: row s * compositions + c holds the replicates of that cell.
using Draw = std::vector<std::vector<std::uint32_t>>;

// The pool's outcomes with one effect put in place of what cells differ by, or as they are.
class EffectData {
 public:
  EffectData(const TeamPool& pool, const Effect& effect);
  [[nodiscard]] double at(std::size_t strategy, std::size_t composition, std::size_t replicate) const {
    const auto row = strategy * num_compositions_ + composition;
    return cells_[row][replicate] + shift_[row];
  }
  [[nodiscard]] double cell_mean(std::size_t strategy, std::size_t composition) const {
    const auto row = strategy * num_compositions_ + composition;
    return mean_[row] + shift_[row];
  }

 private:
  void impose(const TeamPool& pool, const Effect& effect);

  std::size_t num_compositions_;
  std::vector<std::span<const double>> cells_;
  std::vector<double> mean_, shift_;
};

// The tests of one size of study.
class StudyTests {
 public:
  StudyTests(const TeamPool& pool, std::size_t teams, bool paired);

  // The p-value, adjusted where a family of tests is; 1 if nothing can be estimated.
  [[nodiscard]] double p_value(const Effect& effect, const EffectData& data, const Draw& draw) const;
  // Those of the two-way analysis of variance: strategy, composition, interaction; missing terms are 1.
  [[nodiscard]] std::array<double, 3> two_way(const EffectData& data, const Draw& draw) const;
  // The same with the strategies within people: Greenhouse-Geisser for terms with the strategy.
  // @param compositions  positions of those that count.
  [[nodiscard]] std::array<double, 3> within_people(const std::vector<std::size_t>& compositions,
                                                    const EffectData& data, const Draw& draw) const;

  // Positions of the strategies that are not the baseline.
  [[nodiscard]] const std::vector<std::size_t>& groups() const { return groups_; }

 private:
  [[nodiscard]] double within(const Effect& effect, const EffectData& data, const Draw& draw) const;
  [[nodiscard]] double contrast(const Effect& effect, const EffectData& data, const Draw& draw) const;
  [[nodiscard]] std::vector<double> outcomes(const TeamSelection& teams, const EffectData& data,
                                             const Draw& draw) const;
  // Means over the selected strategies of each group of people, composition by composition.
  [[nodiscard]] std::vector<double> means_of_people(const TeamSelection& teams, const EffectData& data,
                                                    const Draw& draw) const;

  const TeamPool& pool_;
  std::size_t teams_;
  bool paired_;
  std::vector<std::size_t> groups_;
  std::vector<Factor> factors_;                  // of two_way: those with two levels at least
  std::vector<std::vector<std::size_t>> terms_;  // of two_way
  std::vector<std::size_t> term_kinds_;          // 0 strategy, 1 composition, 2 interaction
  Factor within_;
};

// The cells that a term of the analysis of variance is about: positions of group strategies and of compositions.
struct TermCells {
  std::vector<std::size_t> groups, compositions;
};
[[nodiscard]] TermCells cells_of(const TeamPool& pool, const Effect& effect);

// Whether a cell of the pool is selected.
[[nodiscard]] bool is_selected(const TeamPool& pool, const TeamSelection& teams, std::size_t strategy,
                               std::size_t composition);

// The effect's size in the pool: partial eta squared, corrected for bias, or the difference.
[[nodiscard]] double effect_size(const TeamPool& pool, const Effect& effect);

// Power by the non-central F distribution of that size at n teams per cell.
[[nodiscard]] std::optional<double> analytic_power(const TeamPool& pool, const Effect& effect, double size,
                                                   std::size_t teams, double alpha, bool paired);

}  // namespace kith
