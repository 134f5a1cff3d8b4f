#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "kith/bec/constraint_set.hpp"
#include "kith/belief/likelihood.hpp"
#include "kith/belief/particle_belief.hpp"
#include "kith/teaching/cache.hpp"
#include "kith/teaching/learner_hypothesis.hpp"
#include "kith/teaching/teaching_options.hpp"

namespace kith {

/// What showing a unit of demonstrations is expected to come to, for the whole team.
///
///   U(u) = (1/m) sum_i sum_h w_ih sum_x B'_ih(x) f(x),   B'_ih proportional to B_ih L(D; beta_h) L(T; beta'_h),
///
/// where i are the members, h what they may be like, D what the unit's demonstrations convey, T the minimal set of D,
/// which the feedback to the tests repeats, and f(x) what somebody with weights x gets out of the component: the share
/// of its tests answered right (GradeTable::tests_right; the objective `right`), minus the regret on its starts
/// (`regret`); for `worst-member` the smallest value of a member counts instead of the mean over the m members. Where
/// behaviours are not tabulated, tests are those of StartSample::spread_over_facets(), and `regret` is taken for
/// `right`.
///
/// Of people who imitate with some probability, only the other answers count here; see imitation().
///
/// Beliefs are represented by `points` systematic draws from each, the same for all units that are compared.
/// The order of the members changes nothing: sums are taken in the order of their tie breaks.
class UnitValue {
 public:
  struct Options {
    TeachingObjective objective = TeachingObjective::kRight;
    LikelihoodForm likelihood = LikelihoodForm::kDiscontinuous;
    std::size_t points = 250;  ///< Per member, >= 1; hypotheses get their share of them.
    double ignored = 0.01;     ///< Hypotheses of a smaller probability are left out, unless they are the likeliest.
  };

  /// @param members  per member the hypotheses, of which at least one has a weight above 0; members without any do not
  /// count. @param tie_breaks  per member; see TeachingView. @param random  what is drawn from the beliefs; by member.
  UnitValue(TeachingCache& cache, std::size_t component, std::span<const std::vector<MemberHypothesis>> members,
            std::span<const std::uint64_t> tie_breaks, const Options& options, RandomStream random);

  /// How many of the answers of all members together are imitations, and the mean temperature of these.
  [[nodiscard]] Imitation imitation() const;
  [[nodiscard]] TeachingObjective objective() const noexcept { return options_.objective; }

  /// U of showing nothing.
  [[nodiscard]] double of_nothing() { return of({}, {}); }
  /// U of a unit. @param shown  per demonstration what it conveys. @param taught  the minimal set of all of them.
  [[nodiscard]] double of(std::span<const ConstraintSet> shown, const ConstraintSet& taught);

 private:
  // The particles of one hypothesis about one member: a range of the points.
  struct Part {
    std::size_t member = 0;
    double weight = 1.0;
    Imitation imitation;
    std::size_t begin = 0;
    std::size_t end = 0;
    HalfSpaceLikelihood shown;
    HalfSpaceLikelihood feedback;
  };
  // Relative likelihoods of one constraint at all points.
  struct Factors {
    std::vector<double> shown;
    std::vector<double> feedback;
  };

  void add_part(std::size_t member, const MemberHypothesis& hypothesis, std::size_t points, RandomStream random);
  void grade_points(TeachingCache& cache, std::size_t component);
  const Factors& factors(ConstraintIndex c);
  void multiply_shown(const ConstraintSet& conveyed);

  Options options_;
  const ConstraintTable* constraints_;
  std::size_t dimension_;
  std::size_t num_members_ = 0;
  std::vector<Part> parts_;
  std::vector<std::vector<double>> axes_;  // shape [d][points]
  std::vector<double> mass_;               // how often each point was drawn
  std::vector<double> worth_;              // f
  std::unordered_map<std::size_t, Factors> factors_;
  std::vector<double> product_;
  // Units are compared that differ in the last demonstration only: the other ones of the last unit, and their product.
  std::vector<ConstraintSet> before_;
  std::vector<double> product_before_;
};

}  // namespace kith
