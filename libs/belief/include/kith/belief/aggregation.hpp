#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "kith/belief/particle_belief.hpp"

namespace kith {

/// The test responses of a team, as a rule of aggregation sees them. All lists are in the order of the seats of the
/// members who took part.
struct TeamResponses {
  std::span<const std::vector<HalfSpace>> lists;   ///< Per member, what the answers show.
  std::span<const std::uint64_t> addresses;        ///< Per member, the address of the person's stream: breaks ties, so
                                                   ///< that seats never matter.
  std::span<const ParticleBelief* const> members;  ///< Per member, after the update; empty if they are not kept.
  const Cone& prior;
  const HalfSpaceLikelihood& likelihood;
  bool reduce_before_update = false;  ///< TeamBelief::Options::reduce_before_update.
};

/// A rule by which a team's test responses update a belief about the team: one row of the registry, one file.
/// Demonstrations and feedback reach everybody alike and need no rule.
///
/// Laws, which the tests check for every row: equal arguments give equal beliefs, bit for bit; so do members in other
/// seats; a single list updates the belief as that member's own belief, up to what `reduce_before_update` changes.
struct AggregationRule {
  std::string_view name;         ///< As in files and tables: "common".
  std::string_view description;  ///< Completes "the belief about ...".
  /// Updates the belief. @return members who were left out of it, as positions in the lists, ascending.
  std::vector<std::size_t> (*observe)(ParticleBelief& belief, const TeamResponses& responses, RandomStream random);
  /// Whether the belief is about what everybody knows, so that somebody new, who knows nothing, takes it back to the
  /// prior.
  bool needs_everybody = false;
};

/// The built-in rules: common and joint [jayaraman2024, section III-C].
[[nodiscard]] std::span<const AggregationRule> aggregation_rules() noexcept;
/// The built-in rule with this name; null if there is none.
[[nodiscard]] const AggregationRule* find_aggregation_rule(std::string_view name) noexcept;

}  // namespace kith
