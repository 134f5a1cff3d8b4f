#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "kith/teaching/exam.hpp"
#include "kith/teaching/learner_bank.hpp"

namespace kith {

/// A LearnerBank about every member of a team.
class TeamBank {
 public:
  /// @param persons  one stream per member. @param response_noise  radians, >= 0.
  /// @param everybody  of what moves the points of the hypotheses' beliefs, the same for all members, so that those to
  /// whom the same happens share them; nothing: each has points of their own.
  /// @param components  as for LearnerBank.
  TeamBank(const PriorCover& cover, const FilterOptions& filter, LikelihoodForm likelihood,
           const std::vector<LearnerHypothesis>& hypotheses, std::span<const RandomStream> persons,
           const std::optional<RandomStream>& everybody, double response_noise,
           std::span<const std::vector<HalfSpace>> components = {});

  [[nodiscard]] std::size_t size() const noexcept { return members_.size(); }
  [[nodiscard]] const LearnerBank& member(std::size_t i) const { return members_[i]; }
  /// What a member believes who learns with the expected ability: as the beliefs of the hypotheses, but the member's
  /// answers are evidence, too, blurred by `response_noise`.
  [[nodiscard]] const ParticleBelief& informed(std::size_t i) const { return informed_[i]; }
  /// Whether the component of the coming lesson begins with it.
  [[nodiscard]] bool begins(std::size_t component) const noexcept { return component != component_; }

  /// Somebody new takes the place of a member: what is known about the member is what it was at first.
  /// @param person  the member's stream; the other arguments are those of the constructor.
  void restart(std::size_t i, const PriorCover& cover, const FilterOptions& filter,
               const std::vector<LearnerHypothesis>& hypotheses, const RandomStream& person,
               std::span<const std::vector<HalfSpace>> components = {});

  /// The members present watched a lesson. @param minutes  that the period before took; 0 before the first.
  void watch(const Atlas& atlas, const Lesson& lesson, const std::vector<bool>& present, double minutes = 0.0);
  /// The tests were closed; the feedback that follows is taken in, too.
  /// @param answers  per member; empty for those who gave none.
  void close_tests(const Atlas& atlas, const Lesson& lesson, std::span<const std::vector<Answer>> answers,
                   const Feedback& feedback, const std::vector<bool>& present);

  /// The probability that all members present answer a random test of the component correctly,
  ///   E_t prod_i sum_h w_ih P_ih(right on t);
  /// see RandomTest.
  [[nodiscard]] double probability_of_mastery(const Atlas& atlas, const Exam& exam, std::size_t component,
                                              const std::vector<bool>& present);

  /// Whether the answers of all members present tell them from people whom lessons do not reach: at most a share
  /// `wrongly` of these ever gives such answers (LearnerBank::odds_of_learning).
  [[nodiscard]] bool shows_learning(const std::vector<bool>& present, double wrongly) const;

  friend bool operator==(const TeamBank& a, const TeamBank& b) {
    return a.members_ == b.members_ && a.informed_ == b.informed_ && a.component_ == b.component_;
  }

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  void take_answers(std::size_t i, std::span<const Verdict> verdicts, std::size_t period);
  void inform(std::size_t i, std::span<const HalfSpace> half_spaces, const RandomStream& random);

  LikelihoodForm likelihood_;
  std::optional<RandomStream> everybody_;
  double response_noise_;
  std::vector<LearnerBank> members_;
  std::vector<ParticleBelief> informed_;
  std::vector<RandomStream> random_;  // of what moves the points of informed_
  std::size_t component_ = kNone;     // of the last lesson
};

}  // namespace kith
