#pragma once

#include <cstddef>
#include <span>
#include <unordered_map>
#include <vector>

#include "kith/belief/likelihood.hpp"
#include "kith/core/stream.hpp"
#include "kith/teaching/cache.hpp"
#include "kith/teaching/learner_hypothesis.hpp"
#include "kith/teaching/teaching_options.hpp"

namespace kith {

// What is left to learn after a lesson, as a logarithm:
//
//   loss(D, F) = (1/m) sum_i sum_h w_ih log(R_ih + floor)
//   R_ih = (1 - q_h) sum_x B_ih(x) L(x | D; beta_h) L(x | F; beta'_h) R(x) / (the same sum without R)  +  q_h C
//
// i runs over the m members, h over what a member may be like, with probability w_ih, x over points drawn from the
// belief B_ih. D is what the demonstrations convey, F what the feedback about the tests repeats. R(x) is what people
// with weights x get wrong in the exam of the component: the regret or, with TeachingObjective::kRight, the share of
// its starts. q_h is the share of answers that imitate a demonstration, and C what these lose. With kWorstMember the
// mean over members is their maximum. floor is a thousandth of R before teaching: halving what is left counts the same
// at every stage, down to there.
class LessonLoss {
 public:
  struct Options {
    TeachingObjective objective = TeachingObjective::kRegret;
    LikelihoodForm likelihood = LikelihoodForm::kDiscontinuous;
    std::size_t points = 250;  // per member, >= 1; hypotheses get their share of them
    double ignored = 0.01;     // hypotheses of a smaller probability are left out, unless they are the likeliest
  };
  // Likelihoods of all points so far, shape [points].
  using Product = std::vector<double>;

  // @param members  per member the hypotheses, of which at least one has a weight above 0; members without any do not
  // count. @param tie_breaks  per member; see TeachingView. @param random  what is drawn from the beliefs; by member.
  LessonLoss(TeachingCache& cache, std::size_t component, std::span<const std::vector<MemberHypothesis>> members,
             std::span<const std::uint64_t> tie_breaks, const Options& options, RandomStream random);

  [[nodiscard]] TeachingObjective objective() const noexcept { return options_.objective; }
  // How many of the answers of all members together are imitations, and the mean temperature of these.
  [[nodiscard]] Imitation imitation() const;

  [[nodiscard]] const Product& before() const noexcept { return mass_; }
  // People are shown what a demonstration conveys, or hear it again as feedback.
  void show(Product& product, const ConstraintSet& conveyed);
  void repeat(Product& product, const ConstraintSet& feedback);
  // @param of_imitating  C.
  [[nodiscard]] double of(const Product& product, double of_imitating = 0.0) const;

 private:
  // The points of one hypothesis about one member: a range of all.
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
  [[nodiscard]] HalfSpaceLikelihood likelihood_with(double ability);
  const Factors& factors(ConstraintIndex c);

  Options options_;
  const ConstraintTable* constraints_;
  std::size_t dimension_;
  std::size_t num_members_ = 0;
  std::vector<Part> parts_;
  std::vector<std::vector<double>> axes_;  // shape [d][points]
  std::vector<double> mass_;               // how often each point was drawn
  std::vector<double> wrong_;              // R
  double floor_ = 0.0;
  std::unordered_map<double, HalfSpaceLikelihood> likelihoods_;
  std::unordered_map<std::size_t, Factors> factors_;
};

}  // namespace kith
