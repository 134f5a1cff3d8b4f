#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "kith/belief/aggregation.hpp"
#include "kith/belief/likelihood.hpp"
#include "kith/belief/particle_belief.hpp"
#include "kith/core/option_key.hpp"
#include "kith/geometry/cone.hpp"
#include "kith/teaching/demonstration_selection.hpp"
#include "kith/teaching/learner_hypothesis.hpp"
#include "kith/teaching/pace.hpp"
#include "kith/teaching/stop_rule.hpp"

namespace kith {

/// What the components are.
enum class Scaffold {
  kOfStrategy,  ///< As the strategy is made for: kNone if StrategyKind::teaches_whole, else kFeatures.
  kFeatures,    ///< Atlas::knowledge_components(), one after the other [jayaraman2024].
  kNone,        ///< The last of them alone, which has all features; the others count as skipped.
};

/// What strategies that look ahead lower, on the component's starts.
enum class TeachingObjective {
  kRegret,       ///< The regret of all members: the mean of its logarithm.
  kRight,        ///< The same of the share of starts that they predict wrongly.
  kWorstMember,  ///< The regret of the member who is expected to do worst.
};

/// What the hypotheses of a LearnerBank differ in.
enum class HypothesesAbout {
  kAbility,          ///< How well people learn: TeachingOptions::hypotheses.
  kKnownComponents,  ///< Which components they know beforehand: grid_of_known_components().
  kNothing,          ///< Nothing: everybody is taken for a person of average ability, one_hypothesis().
  kKinds,            ///< What kind of learner they are, and how well they learn: TeachingOptions::kinds.
};

/// How a group is taught; every field is a key of the study file.
struct TeachingOptions {
  FilterOptions filter{};           ///< particles, eta, resampling threshold of the teacher's beliefs
  std::size_t counterfactuals = 8;  ///< N
  CounterfactualSampling sampling = CounterfactualSampling::kSystematic;
  double assumed_ability = 0.80;  ///< the beta that the teacher ascribes to everybody; 1 is taken as 1 - 1e-9
  LikelihoodForm likelihood = LikelihoodForm::kDiscontinuous;
  double response_noise = 0.05;  ///< nu, radians
  bool reduce_before_update = false;
  /// Whether every component is taught as if nothing had been taught before it: the taught region starts from the
  /// prior. Otherwise what the components before conveyed has no gain and is not shown again, understood or not.
  bool review = false;
  Scaffold scaffold = Scaffold::kOfStrategy;
  std::size_t max_demonstrations = 0;  ///< per lesson; 0: as many as the strategy wants
  TeachingObjective objective = TeachingObjective::kRegret;

  StopChoice mastery = stop_rule_named("all-right");  ///< When a component has been taught enough.
  std::size_t max_periods = 50;                       ///< >= 1
  std::size_t consecutive_correct = 1;    ///< "all-right": periods in a row that everybody must answer all right, >= 1
  std::size_t periods_per_component = 3;  ///< "fixed": >= 1
  double probability = 0.9;               ///< "posterior", "exam" and "regret": in (0, 1)
  double share_right = 0.95;              ///< "exam": in (0, 1)
  std::size_t min_periods = 1;            ///< "posterior", "exam", "regret": periods of a component at least, >= 1
  /// Which members are done with a component before the team is; nothing: nobody [jayaraman2024]. They have no part in
  /// its remaining periods and return with the next component. Once nobody is left, it counts as learned, whatever
  /// `mastery` says.
  std::optional<StopChoice> release{};
  std::size_t duplicate_sets = 1;  ///< test sets per period, >= 1

  /// Whether a start is shown or asked about again only where no other serves. Sessions that began before kith did so
  /// are repeated without.
  bool avoids_repeats = true;
  /// Whether tests come first that people get wrong who only take the shortest path, as only real people do.
  bool avoids_shortest = false;

  /// The rules of aggregation that there are: their beliefs are kept where the strategy reads them.
  std::vector<AggregationRule> rules{aggregation_rules().begin(), aggregation_rules().end()};
  /// What members may be like, as the bank has it that strategies and stopping rules may ask for; see LearnerBank.
  std::vector<LearnerHypothesis> hypotheses = grid_of_hypotheses();
  HypothesesAbout hypotheses_about = HypothesesAbout::kAbility;
  /// The hypotheses of HypothesesAbout::kKinds, with which the bank is always kept.
  std::vector<LearnerHypothesis> kinds{};
  Pace pace{};  ///< for people who forget with time, and for all minutes that are assumed
  /// What members know of the robot as it was before: a region within the prior, in which beliefs about them begin
  /// (OlderRobot). Nothing: members know the prior only.
  std::optional<Cone> known{};
  bool shares_bank = true;  ///< Members to whom the same happens share what the bank has of them; not before kith did.
  bool keep_bank = false;   ///< the bank is kept even if nobody reads it
  bool keep_members = false;  ///< beliefs about members are kept even if the strategy does not read them
  bool keep_rules = false;    ///< the same for the beliefs of all rules
};

/// The keys of `[teacher]` and of `[stop]` that are fields of the options, in the order of written study files.
[[nodiscard]] std::span<const OptionKey<TeachingOptions>> teacher_keys();
[[nodiscard]] std::span<const OptionKey<TeachingOptions>> stop_keys();

}  // namespace kith
