#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kith/core/diagnostic.hpp"
#include "kith/domains/domain.hpp"

namespace kith {

/// What a robot was seen to do, or what its policy says that it does.
struct ObservedPolicy {
  /// Per MDP and choice, in the order of Mdp::first_choice(): how likely the robot takes it, or how often it was seen
  /// to. The choices of a state sum to 1, or to less where some actions of the robot are none of the MDP: those that
  /// never leave the state, or after which an end cannot be reached for certain.
  std::vector<std::vector<double>> probability;
  std::vector<std::vector<bool>> is_seen;  ///< Per MDP and state: whether anything is known.
};

/// What came of reading a policy: one unless there are errors, and everything worth saying.
struct PolicyReading {
  std::optional<ObservedPolicy> policy;
  std::vector<Diagnostic> diagnostics;
};

/// Reads a policy, a table (CSV) with a row for every state and action: `state` (a key or the name of a state, see
/// Domain::state_key()) and `action` (its name, or its number from 0), where there are several MDPs `world` (number or
/// name), and optionally `probability`. Without probabilities every row is an observation, and each of a state's rows
/// counts the same: a table of one row for each state is a deterministic policy, and the steps of recorded paths are
/// one as well. Other columns are ignored.
///
/// Terminal states and those that the domain leaves out are passed over. All errors are reported at once (at most 20).
/// @param name  how messages call the file.
[[nodiscard]] PolicyReading parse_policy(std::string_view text, const std::string& name, const Domain& domain);

}  // namespace kith
