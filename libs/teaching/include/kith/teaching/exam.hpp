#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "kith/bec/behaviours.hpp"
#include "kith/bec/grade_table.hpp"
#include "kith/belief/particle_belief.hpp"
#include "kith/belief/prior_cover.hpp"
#include "kith/core/stream.hpp"

namespace kith {

/// What a belief is worth on starts that no teacher chose.
struct ExamGrades {
  Grade all;                      ///< Over all candidate starts.
  std::vector<Grade> components;  ///< Over those in the MDPs of every knowledge component.
  friend bool operator==(const ExamGrades&, const ExamGrades&) = default;
};

/// How hard a start is: its third among all starts, by the share of the prior that predicts the robot right there.
enum class ExamDifficulty { kLow, kMedium, kHigh };

/// An exam over a whole domain, outside all lessons.
///
/// With tables a belief is graded exactly: the mean of GradeTable over its particles, in one pass. Elsewhere it is
/// graded by 16 systematic draws from it on 30 starts, a third of every difficulty, taken from at most 6 MDPs; the
/// same starts in every study of a domain. There, a start without a finite optimum counts as wrong with the regret of
/// the worst single deviation.
class Exam {
 public:
  /// @param cover  of the prior. @param behaviours  of the calling thread; influences nothing.
  Exam(Behaviours& behaviours, const PriorCover& cover);

  /// Expected grades under a belief.
  [[nodiscard]] ExamGrades grade(const ParticleBelief& belief, Behaviours& behaviours) const;

  /// Starts of this difficulty, ascending: all candidates, or the sample where there are no tables.
  [[nodiscard]] std::span<const StartIndex> starts(ExamDifficulty difficulty) const {
    return by_difficulty_[static_cast<std::size_t>(difficulty)];
  }
  /// Questions for people: `n` starts, as many of each difficulty as possible (the first of them of low difficulty),
  /// none of `seen` as long as there are others, none twice.
  [[nodiscard]] std::vector<StartIndex> questions(std::size_t n, std::span<const StartIndex> seen,
                                                  RandomStream random) const;

  /// What cells get right; nothing where there are no tables.
  [[nodiscard]] const GradeTable* table() const { return table_ ? &*table_ : nullptr; }

 private:
  [[nodiscard]] ExamGrades grade_sample(const ParticleBelief& belief, Behaviours& behaviours) const;
  [[nodiscard]] std::vector<StartIndex> sampled_starts(const Atlas& atlas) const;
  void sort_by_difficulty(std::vector<StartIndex> starts, const std::vector<double>& share_right);

  std::optional<GradeTable> table_;
  std::array<std::vector<StartIndex>, 3> by_difficulty_;
};

/// Whether a path with these feature counts is as good as the robot's from this start, and what it loses.
[[nodiscard]] Grade grade_answer(const Atlas& atlas, StartIndex start, const std::optional<IntegerVector>& answer);

}  // namespace kith
