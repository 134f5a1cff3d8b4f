#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kith/belief/team_belief.hpp"
#include "kith/core/parameter.hpp"
#include "kith/teaching/learner_hypothesis.hpp"
#include "kith/teaching/lesson.hpp"
#include "kith/teaching/past_periods.hpp"
#include "kith/teaching/visited_starts.hpp"

namespace kith {

class TeamBank;
class UnitSelector;
struct TeachingOptions;

/// The strategy to compare with, by its name in study files and tables: everybody is taught alone, one after the other,
/// in sessions of one person each.
inline constexpr std::string_view kBaseline = "baseline";

/// A member as they are, which only simulations know: the bound of what knowing people can be worth.
struct MemberTruth {
  const ParticleBelief* belief = nullptr;  ///< The person's own; null if the learner model has none.
  double shown_ability = 0.8;              ///< beta with which the person learns from demonstrations.
  double feedback_ability = 0.8;           ///< The same from the feedback that follows, as expected.
};

/// What a strategy sees when it proposes a unit. It stays valid during the call only.
struct TeachingView {
  const Atlas& atlas;
  const TeachingOptions& options;
  const TeamBelief& belief;    ///< With the beliefs that StrategyKind::needs asked for; who is present is in it, too.
  const PastPeriods& history;  ///< All completed periods.
  const Lesson* last_of_component = nullptr;  ///< The last lesson of this component; null before its first.
  std::span<const HalfSpace> taught_region;   ///< R_n at the end of the last learned component; minimal, sorted.
  const VisitedStarts& visited;               ///< What was shown or asked before.
  std::span<const std::uint64_t> tie_breaks;  ///< Per member, a hash of the address of the person's stream.
  std::size_t period = 1;                     ///< The coming one: 1, 2, ...
  std::size_t component = 0;                  ///< What is to be taught: index into Atlas::knowledge_components().
  const TeamBank* bank = nullptr;             ///< If StrategyKind::needs asked for it.
  bool has_short_lessons = false;             ///< StrategyKind::teaches_whole
  std::span<const MemberTruth> truth{};       ///< Per member; empty unless they are simulated.
};

/// What a strategy proposes to show next.
struct UnitProposal {
  SourceBelief source;
  Unit unit;  ///< Without demonstrations if showing anything would be useless.
  /// Of a strategy that chooses its tests; without any the session chooses them, by what the lesson teaches.
  std::vector<Test> tests{};
};

/// How a team is taught: chooses what is shown next. It may have a state of its own and may look ahead.
///
/// Laws, which the tests check for every kind in the registry: a proposal depends on nothing but the state, the view
/// and the random stream, so that a session can be replayed; a clone proposes what the original would; members in other
/// seats, with their streams, get the same proposals.
class Strategy {
 public:
  Strategy() = default;
  Strategy(const Strategy&) = default;
  Strategy& operator=(const Strategy&) = default;
  virtual ~Strategy() = default;

  [[nodiscard]] virtual std::unique_ptr<Strategy> clone() const = 0;

  /// The next unit for the component. If it is empty the last unit of the component is shown again or, if there was
  /// none, one that UnitSelector::complete() makes; if that is empty, too, the component is skipped. Called on a clone,
  /// which takes this object's place once the lesson is complete: if anything throws, the session and its strategy stay
  /// as they were.
  /// @param select  chooses demonstrations for a belief. @param random  the root of all that the strategy draws here.
  [[nodiscard]] virtual UnitProposal propose(const TeachingView& view, UnitSelector& select, RandomStream random) = 0;
};

/// Which beliefs a strategy reads, so that others need not be kept.
struct TeamBeliefNeeds {
  bool members = false;
  std::vector<std::string> rules;  ///< Names of rules of aggregation.
  bool bank = false;               ///< Whether it reads TeachingView::bank.
};

/// A kind of strategy: one row of the registry, one file.
struct StrategyKind {
  std::string_view name;         ///< As in files and on the command line.
  std::string_view description;  ///< What it does: "teach for ...".
  std::function<TeamBeliefNeeds(const ParameterValues& parameters)> needs;
  std::function<std::unique_ptr<Strategy>(const ParameterValues& parameters)> make;
  std::span<const Parameter> parameters{};  ///< Keys of its table in a study file.
  bool needs_truth = false;  ///< Whether it reads TeachingView::truth, so that it can teach simulated people only.
  /// Whether it orders what it teaches itself, unless Scaffold::kFeatures is asked for, in short lessons.
  bool teaches_whole = false;
};

/// The built-in kinds, in the order of the documentation. Functions that look a strategy up take a list of kinds, so
/// that programs can add kinds of their own.
[[nodiscard]] std::span<const StrategyKind> strategy_kinds() noexcept;
/// The kind with this name; null if there is none.
[[nodiscard]] const StrategyKind* find_strategy_kind(std::string_view name,
                                                     std::span<const StrategyKind> kinds = strategy_kinds()) noexcept;

/// A strategy with its parameters, as a study or a session uses it.
struct StrategyChoice {
  std::string name;  ///< In tables: that of the kind or, with parameters of its own, what the study calls it.
  StrategyKind kind;
  ParameterValues parameters;

  [[nodiscard]] bool is_baseline() const noexcept { return kind.name == kBaseline; }
  /// The same strategy: equal names, kinds and parameters.
  friend bool operator==(const StrategyChoice& a, const StrategyChoice& b) {
    return a.name == b.name && a.kind.name == b.kind.name && a.parameters == b.parameters;
  }
};

/// A kind with its default parameters. @throws std::invalid_argument if there is no such kind.
[[nodiscard]] StrategyChoice strategy_named(std::string_view name,
                                            std::span<const StrategyKind> kinds = strategy_kinds());

}  // namespace kith
