#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "kith/bec/atlas.hpp"

namespace kith {

/// What a world is wanted for.
enum class Purpose {
  kTeach,  ///< The one-step comparisons along the robot's path convey the constraint and nothing else.
  kTest    ///< The expected paths from the start discriminate the constraint and nothing else.
};

/// Whether some paths of the robot are as good as others that count differently, and this does not count
/// (docs/model.md): then with other weights of the policy's class it may take another path that is as good.
[[nodiscard]] bool leaves_out_ties(const Atlas& atlas);

/// The simplest demonstration that isolates the constraint, which conveys exactly that to those who know the prior:
/// with it, the one-step set of the path (kTeach) or the facets of the robot's cell in the coverage set of the start
/// (kTest) leave the same weights as the constraint does. The least to look at (Domain::complexity), then the shortest
/// path, then the lowest index. Nothing if there is none.
[[nodiscard]] std::optional<StartIndex> simplest_isolating(const Atlas& atlas, const HalfSpace& constraint,
                                                           Purpose purpose);

/// Why no demonstration isolates a constraint.
struct NotIsolated {
  std::size_t conveying = 0;            ///< Starts that teach (or test) it among other things.
  std::optional<StartIndex> nearest;    ///< Of those the one with the fewest other things.
  std::vector<HalfSpace> besides = {};  ///< What that one conveys besides, without what is known beforehand.
};
[[nodiscard]] NotIsolated why_not_isolated(const Atlas& atlas, const HalfSpace& constraint, Purpose purpose);

/// How many demonstrations isolate a constraint.
struct Isolated {
  HalfSpace constraint;
  std::size_t teaching = 0;  ///< Purpose::kTeach.
  std::size_t testing = 0;   ///< Purpose::kTest.
};

/// Every constraint of the policy's behaviour equivalence class, and every other that some demonstration isolates;
/// sorted. Without what is known beforehand.
[[nodiscard]] std::vector<Isolated> isolated_constraints(const Atlas& atlas);

/// The constraint that people mean: its normal ("(-1,0,2)", "-1 0 2"), any sentence that in_words() makes, in any case
/// and with or without the full stop, or a comparison in other words ("rubble is worse than two steps"). Of a sentence
/// with a condition a constraint of the robot's from which it follows.
/// @throws kith::Error (kInvalidInput, E1109) if it is neither, (kInfeasible, E1110) if the robot's weights contradict
/// it or everybody knows it beforehand.
[[nodiscard]] HalfSpace parse_constraint(const Atlas& atlas, const std::string& text);

}  // namespace kith
