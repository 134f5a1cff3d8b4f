#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "kith/domains/domain.hpp"
#include "kith/mdp/planner.hpp"

namespace kith {

/// What a path costs the robot beside its own path from the same start.
struct PathJudgement {
  /// mu(robot) - mu(path) in units of 1 / Domain::count_scale(), shape [d].
  IntegerVector loss;
  /// w . loss in counts, with the weights at the domain's length 1. Exactly 0 if the two are as good as equal, < 0 only
  /// if the path is better.
  double regret = 0.0;
  /// The same with the weights as the domain file states them (RewardWeights::raw).
  double raw_regret = 0.0;
  /// Whether the path is as good as the robot's, or better.
  bool is_right = false;
  /// Whether it is better: no path can be, if the robot's is optimal.
  bool is_better = false;
};

/// Says whether a path is right. There is no other judge: tests, exams, screening, lessons and tables ask this one.
///
/// In exact domains (Domain::is_exact()) two paths are equally good if w . loss is 0, an integer. In all others feature
/// counts are expectations, known to 1 / count_scale() each, of policies that are optimal up to 1e-9 of the return in
/// every step (BehaveOptions::tolerance). There two paths are equally good if, with weights of Euclidean length 1,
///   |w . loss| <= max(1e-6 * max(1, |w . mu(robot)|), 2 sqrt(d) / count_scale()),
/// which is what a thousand steps and the rounding of both counts may add up to. It does not depend on how the weights
/// of the file are scaled nor on how returns are shown (WeightNorm).
/// @param robot, path  feature counts in units of 1 / count_scale(), shape [d]. Exact domains use their difference
/// only.
/// @throws std::invalid_argument unless both have d entries.
[[nodiscard]] PathJudgement judge_path(const Domain& domain, const IntegerVector& robot, const IntegerVector& path);

/// How a person's list of actions came to its end.
enum class ActionsOutcome {
  kFinished,      ///< A terminal state was reached.
  kStoppedShort,  ///< All actions were possible, but the end was not reached.
  kIllegal,       ///< Some action does not exist, or does nothing, in the state it was tried in.
};

/// "finished", "stopped-short" or "illegal".
[[nodiscard]] const char* name_of(ActionsOutcome outcome) noexcept;

/// What a list of actions is worth under the robot's weights.
struct ActionsJudgement {
  ActionsOutcome outcome = ActionsOutcome::kStoppedShort;
  /// Finished with the best return there is. Exact: equally good paths are equally right, whatever their actions.
  bool optimal = false;
  double earned = 0.0;  ///< Return of the actions that counted, with the weights at the domain's length 1.
  /// What the actions that counted cost against the best return: best(start) - earned - best(where they led), the best
  /// return from a terminal state being 0. >= 0, and exactly 0 iff nothing is lost yet.
  double regret = 0.0;
  IntegerVector feature_counts;  ///< Of the actions that counted, shape [d].
  std::size_t counted = 0;       ///< Actions that counted: those before the first illegal one and up to the end.
  std::size_t ignored = 0;       ///< The rest: an illegal action and all after it, or what came after the end.
  StateIndex last;               ///< Where the actions that counted led.
};

/// Judges answers to tests in one MDP, which is planned once.
///
/// An answer is judged by its return (judge_path), never by comparing actions. An action after the end is ignored, as
/// nothing can happen any more. An action that cannot change the state (a move into a wall, a pickup where nothing
/// lies) or that makes the end unreachable is not one of the MDP: judging stops there, and the answer is not optimal.
/// Nor is one that stops short of the end, however good it is so far. The domain must outlive the judge.
class ActionsJudge {
 public:
  /// @throws std::invalid_argument if there is no such MDP or the domain is discounted.
  /// @throws kith::Error (kInfeasible) if the weights have no finite optimum there.
  ActionsJudge(const Domain& domain, MdpIndex mdp);

  /// @param actions names, as in Domain::action_names().
  /// @throws std::invalid_argument if there is no state `start`.
  [[nodiscard]] ActionsJudgement judge(StateIndex start, std::span<const std::string> actions) const;

  /// The return of the robot's path from `start`, with the weights at the domain's length 1.
  /// @throws std::invalid_argument if there is no state `start`.
  [[nodiscard]] double best_return(StateIndex start) const;

 private:
  void check(StateIndex start) const;
  [[nodiscard]] std::optional<Outcome> outcome_of(StateIndex s, const std::string& action) const;

  const Domain* domain_;
  const Mdp* mdp_;
  ExactSolution solution_;
};

/// ActionsJudge in one call, from the map's start.
[[nodiscard]] ActionsJudgement judge_actions(const Domain& domain, MdpIndex mdp, std::span<const std::string> actions);

}  // namespace kith
