#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "kith/belief/particle_belief.hpp"
#include "kith/core/stream.hpp"
#include "kith/teaching/answer_fit.hpp"
#include "kith/teaching/cache.hpp"
#include "kith/teaching/learner_hypothesis.hpp"
#include "kith/teaching/observed_period.hpp"

namespace kith {

/// A belief, and what was asked about it.
class KnownBelief {
 public:
  explicit KnownBelief(ParticleBelief belief) : belief_{std::move(belief)}, cells_{std::make_shared<PointCells>()} {}
  /// What becomes of a belief by an update: the cells of its points stay known if nothing was resampled.
  KnownBelief(ParticleBelief belief, const KnownBelief& before)
      : belief_{std::move(belief)},
        cells_{belief_.num_resamplings() == before.belief_.num_resamplings() ? before.cells_
                                                                             : std::make_shared<PointCells>()} {}
  [[nodiscard]] const ParticleBelief& belief() const noexcept { return belief_; }
  /// See ParticleBelief::mass_in().
  [[nodiscard]] double mass_in(std::span<const HalfSpace> half_spaces);
  /// Of every policy cell. @pre behaviours are tabulated.
  [[nodiscard]] std::span<const double> cell_masses(const Atlas& atlas);
  /// See AnswerFit::of().
  [[nodiscard]] AnswerFit::Rating rating(const Atlas& atlas, const AnswerFit& fit);

 private:
  ParticleBelief belief_;
  std::shared_ptr<PointCells> cells_;  // also of other beliefs with the same points
  std::vector<double> cell_masses_;
  std::vector<std::pair<std::vector<HalfSpace>, double>> masses_;
};

/// What people would believe after some lessons, under hypotheses about them. Everybody who had the same lessons shares
/// these beliefs, because they do not depend on anybody's answers: abilities grow by the mean of confirm_gain and
/// correct_gain in every period. A belief is computed when it is first asked for.
class LessonBeliefs {
 public:
  struct Options {
    FilterOptions filter{};
    LikelihoodForm likelihood = LikelihoodForm::kDiscontinuous;
    std::vector<LearnerHypothesis> hypotheses = grid_of_hypotheses();
    std::optional<Cone> known{};  ///< TeachingOptions::known
  };
  /// @param cache  of the domain; only its covers are used, now.
  /// @param priors  what people know at first: one per state of mind, the first of them that of everybody.
  /// @param random  moves the beliefs' points.
  LessonBeliefs(TeachingCache& cache, Options options, std::span<const Cone> priors, const RandomStream& random);

  /// What everybody has in common of two people's periods: all that beliefs depend on.
  [[nodiscard]] static bool are_same(const ObservedPeriod& a, const ObservedPeriod& b);
  /// The lesson of period number t (0, 1, ...) of somebody; kept if it is the next.
  /// @throws std::invalid_argument if it is another lesson than was given before.
  void take(std::size_t t, const ObservedPeriod& period);

  [[nodiscard]] std::size_t num_states() const noexcept { return starts_.size(); }
  [[nodiscard]] const std::vector<LearnerHypothesis>& hypotheses() const noexcept { return options_.hypotheses; }
  /// The belief after the demonstrations of period t, in state s under hypothesis h; valid until the next call.
  /// @pre t was taken.
  [[nodiscard]] KnownBelief& answering(std::size_t s, std::size_t h, std::size_t t);
  /// The belief after t periods; valid until the next call. @pre t of them were taken.
  [[nodiscard]] KnownBelief& after(std::size_t s, std::size_t h, std::size_t t);

 private:
  struct Lesson {
    ObservedPeriod period;  // without tests
    std::vector<HalfSpace> conveyed;
  };
  struct Chain {
    std::vector<KnownBelief> answering, after;  // after[0] is that of period 1
    double ability = 0.0;
  };
  void extend(std::size_t s, std::size_t h, std::size_t periods);

  Options options_;
  RandomStream random_;
  std::vector<KnownBelief> starts_;         // per state
  std::vector<std::vector<Chain>> chains_;  // per state and hypothesis
  std::vector<Lesson> lessons_;
};

}  // namespace kith
