#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kith/core/parameter.hpp"
#include "kith/teaching/strategy.hpp"

namespace kith {

class TeachingCache;

/// What a stop rule sees once the tests of a period are closed. It stays valid during the call only.
struct ClosedTests {
  const TeachingView& view;           ///< `history` has the periods before this one.
  const Lesson& lesson;               ///< Of this period.
  const Feedback& feedback;           ///< What is about to be told: verdicts, all_correct.
  const std::vector<bool>& counted;   ///< Members who take part, or had answered before they left.
  std::span<const std::size_t> rows;  ///< Per member, periods in a row with all answers right; this one is the last.
  TeamBank* bank = nullptr;           ///< If StopNeeds::bank; changed in what it caches only.
  /// If StopNeeds::beliefs: what members are expected to believe after the feedback. These beliefs are not blurred
  /// after answers: in many dimensions a region is narrower than `response_noise`, so that blurred mass never gathers
  /// in it.
  const TeamBelief* expected = nullptr;

  /// Periods of the component, with this one.
  [[nodiscard]] std::size_t periods_of_component() const;
};

/// What a rule says of a component.
struct StopVerdict {
  bool is_enough = false;
  double level = 0.0;  ///< What it went by, in [0, 1], such as a probability; 0 or 1 if that is no number.
};

/// When a component has been taught enough, and which members are done with it before the team is. Without state of its
/// own: verdicts depend on nothing but what is seen, and seats do not matter.
class StopRule {
 public:
  StopRule() = default;
  StopRule(const StopRule&) = delete;
  StopRule& operator=(const StopRule&) = delete;
  virtual ~StopRule() = default;

  /// Whether the team leaves the component after this period.
  [[nodiscard]] virtual StopVerdict judge_team(const ClosedTests& closed) const = 0;
  /// Whether a member who counts is done with it; asked only of kinds that can release.
  [[nodiscard]] virtual bool is_done(const ClosedTests& closed, std::size_t member) const;
};

/// What a rule reads, so that other things need not be kept.
struct StopNeeds {
  bool bank = false;
  bool beliefs = false;
};

/// A kind of stop rule: one row of the registry, one file.
struct StopRuleKind {
  std::string_view name;         ///< As in `stop.mastery` and `stop.release`.
  std::string_view description;  ///< When it is enough: "when everybody ...".
  std::unique_ptr<const StopRule> (*make)(const ParameterValues& parameters, TeachingCache& cache);
  /// How long a component was taught, for the methods of a report: "until every member ...".
  std::string (*until)(const TeachingOptions& options, const ParameterValues& parameters);
  /// Who was released, for the same: "had answered ...", after "Members who". Null: it releases nobody, and
  /// `stop.release` cannot name it.
  std::string (*released)(const TeachingOptions& options, const ParameterValues& parameters) = nullptr;
  StopNeeds (*needs)(const Atlas& atlas) = nullptr;  ///< Null: nothing.
  std::span<const Parameter> parameters{};  ///< Keys of `[stop]` beside those that every rule can read, stop_keys().
};

/// The built-in kinds, in the order of the documentation. Studies take a list of kinds, so that programs can add kinds
/// of their own.
[[nodiscard]] std::span<const StopRuleKind> stop_rule_kinds() noexcept;

/// A stop rule with its parameters, as a study or a session uses it.
struct StopChoice {
  StopRuleKind kind;
  ParameterValues parameters{kind.parameters};
  /// The same rule: equal names and parameters.
  friend bool operator==(const StopChoice& a, const StopChoice& b) {
    return a.kind.name == b.kind.name && a.parameters == b.parameters;
  }
};

/// A built-in kind. @throws std::invalid_argument if there is no such kind.
[[nodiscard]] StopChoice stop_rule_named(std::string_view name);

}  // namespace kith
