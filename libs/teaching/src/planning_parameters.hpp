#pragma once

#include <memory>
#include <span>
#include <vector>

#include "kith/core/parameter.hpp"
#include "kith/teaching/unit_value.hpp"
#include "plan_unit.hpp"

namespace kith {

// How strategies that look ahead do so; parameters of each of them.
struct Lookahead {
  explicit Lookahead(const ParameterValues& values);

  std::size_t people;    // imagined people from the prior, and as many from the beliefs
  std::size_t points;    // drawn from every belief
  double expected_gain;  // of ability, by the feedback
  PlanOptions plan;      // max_demonstrations unless the session limits them

  [[nodiscard]] static std::span<const Parameter> parameters();

  [[nodiscard]] PlanOptions plan_for(const TeachingView& view) const;
  // The members present with what the teacher believes about them, all of the assumed ability.
  [[nodiscard]] std::vector<std::vector<MemberHypothesis>> believed(const TeachingView& view) const;
  // The members present with the hypotheses of the bank and, with the weight `answers`, the belief that knows the
  // answers. @pre the view has a bank
  enum class Weighing { kPosterior, kBeforehand };
  [[nodiscard]] static std::vector<std::vector<MemberHypothesis>> mixed(const TeachingView& view, double answers,
                                                                        Weighing weighing);
  [[nodiscard]] UnitValue value(TeachingCache& cache, const TeachingView& view,
                                std::span<const std::vector<MemberHypothesis>> members, RandomStream random) const;
  // The best unit that can be put together for these members.
  [[nodiscard]] Unit best_unit(TeachingCache& cache, const TeachingView& view,
                               std::span<const std::vector<MemberHypothesis>> members, RandomStream random) const;
};

}  // namespace kith
