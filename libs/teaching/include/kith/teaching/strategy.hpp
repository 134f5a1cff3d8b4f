#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "kith/belief/team_belief.hpp"

namespace kith {

/// How a team is taught: whose belief the demonstrations are chosen for.
enum class Strategy {
  kBaseline,        ///< Everybody alone, one after the other: a sequence of one-person sessions.
  kIndividualLow,   ///< For the member with the lowest knowledge of the current component.
  kIndividualHigh,  ///< For the member with the highest.
  kCommon,          ///< For what all members know.
  kJoint,           ///< For what somebody knows.
};

/// The belief that a lesson was chosen for.
struct SourceBelief {
  enum class Kind { kMember, kCommon, kJoint };
  Kind kind = Kind::kCommon;
  std::size_t member = 0;  ///< Seat, if kind is kMember.
  friend bool operator==(const SourceBelief&, const SourceBelief&) = default;
};

/// What a strategy may look at.
struct TeamView {
  std::span<const double>
      knowledge;  ///< Per member: mass of the teacher's belief in the current region, at the end of the last period.
  std::span<const std::uint64_t> tie_breaks;  ///< Per member: a hash of the person's stream address.
};

/// One row of the registry. Adding a strategy = one function, one row, one golden transcript.
struct StrategyEntry {
  Strategy strategy;
  std::string_view name;  ///< As in files and on the command line.
  std::string_view description;
  TeamBeliefParts reads;  ///< The beliefs that choose() may return.
  SourceBelief (*choose)(const TeamView& team);
};

/// All strategies, in the order of the enumeration.
[[nodiscard]] std::span<const StrategyEntry> strategies() noexcept;
[[nodiscard]] const StrategyEntry& entry_of(Strategy strategy);
[[nodiscard]] std::string_view name_of(Strategy strategy);
[[nodiscard]] std::optional<Strategy> find_strategy(std::string_view name);

}  // namespace kith
