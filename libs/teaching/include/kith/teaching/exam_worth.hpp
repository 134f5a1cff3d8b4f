#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kith/bec/behaviours.hpp"
#include "kith/bec/grade_table.hpp"
#include "kith/belief/prior_cover.hpp"
#include "kith/teaching/exam.hpp"

namespace kith {

/// What people with given weights get right on the starts of a component: what teachers go by who plan.
///
/// With tables exactly what the exam counts. Elsewhere an estimate on 40 starts of at most 8 MDPs, chosen by chance,
/// the same in every run, but others than the exam's: at each start people take the best of the paths that some people
/// take, 128 of them spread over the prior and, for each facet of the component's region, some who only just miss it.
/// Where many of these have no finite optimum, what people do is planned instead.
class ExamWorth {
 public:
  /// @param cover  of the prior.
  ExamWorth(Behaviours& behaviours, const Exam& exam, const PriorCover& cover, std::size_t component);

  /// The mean over the prior.
  [[nodiscard]] const Grade& before() const noexcept { return before_; }
  /// @param weights  shape [d], of length 1.
  [[nodiscard]] Grade of(Behaviours& behaviours, const Direction& weights) const;
  /// The same of many. @param axes  shape [d][n]. @return shape [n].
  [[nodiscard]] std::vector<Grade> of(Behaviours& behaviours, std::span<const std::vector<double>> axes) const;

 private:
  // The paths that people take from a start, each once.
  struct Paths {
    StartIndex start;
    std::vector<double> counts;    // shape [n, d]
    std::vector<Grade> grades;     // shape [n]
    Grade endless;                 // of people without a finite optimum
    std::vector<bool> is_endless;  // per person
  };
  void gather_paths(Behaviours& behaviours, const PriorCover& cover);
  [[nodiscard]] std::size_t nearest_person(const Direction& weights) const;

  const GradeTable* table_;
  std::size_t component_;
  std::vector<Paths> paths_;       // without tables
  std::vector<Direction> people_;  // the same
  Grade before_;
};

}  // namespace kith
