#include "kith/teaching/strategy.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace kith {
namespace {

// The member with the smallest `sign` * knowledge; ties by hash, never by seat.
std::size_t extreme_member(const TeamView& team, double sign) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < team.knowledge.size(); ++i) {
    const double here = sign * team.knowledge[i];
    const double there = sign * team.knowledge[best];
    if (here < there || (here == there && team.tie_breaks[i] < team.tie_breaks[best])) best = i;
  }
  return best;
}

SourceBelief lowest(const TeamView& team) { return {SourceBelief::Kind::kMember, extreme_member(team, 1.0)}; }
SourceBelief highest(const TeamView& team) { return {SourceBelief::Kind::kMember, extreme_member(team, -1.0)}; }
SourceBelief common(const TeamView&) { return {SourceBelief::Kind::kCommon, 0}; }
SourceBelief joint(const TeamView&) { return {SourceBelief::Kind::kJoint, 0}; }

constexpr TeamBeliefParts kMembers{.members = true, .common = false, .joint = false};
constexpr TeamBeliefParts kCommonOnly{.members = false, .common = true, .joint = false};
constexpr TeamBeliefParts kJointOnly{.members = false, .common = false, .joint = true};

constexpr std::array kStrategies{
    StrategyEntry{Strategy::kBaseline, "baseline", "teach every member alone, one after the other", kMembers, lowest},
    StrategyEntry{Strategy::kIndividualLow, "individual-low", "teach for the member who knows least", kMembers, lowest},
    StrategyEntry{Strategy::kIndividualHigh, "individual-high", "teach for the member who knows most", kMembers,
                  highest},
    StrategyEntry{Strategy::kCommon, "common", "teach for what all members know", kCommonOnly, common},
    StrategyEntry{Strategy::kJoint, "joint", "teach for what some member knows", kJointOnly, joint},
};

}  // namespace

std::span<const StrategyEntry> strategies() noexcept { return kStrategies; }

const StrategyEntry& entry_of(Strategy strategy) {
  const auto entry = std::find_if(kStrategies.begin(), kStrategies.end(),
                                  [&](const StrategyEntry& candidate) { return candidate.strategy == strategy; });
  if (entry == kStrategies.end()) throw std::invalid_argument{"entry_of: not a strategy"};
  return *entry;
}

std::string_view name_of(Strategy strategy) { return entry_of(strategy).name; }

std::optional<Strategy> find_strategy(std::string_view name) {
  for (const auto& entry : kStrategies) {
    if (entry.name == name) return entry.strategy;
  }
  return std::nullopt;
}

}  // namespace kith
