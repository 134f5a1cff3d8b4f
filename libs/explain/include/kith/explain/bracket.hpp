#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kith/bec/knowledge_component.hpp"
#include "kith/domains/domain.hpp"
#include "kith/geometry/half_space.hpp"

namespace kith {

/// A rational number in lowest terms.
struct Ratio {
  std::int64_t numerator = 0;
  std::int64_t denominator = 1;  ///< > 0
  [[nodiscard]] double value() const { return static_cast<double>(numerator) / static_cast<double>(denominator); }
  friend bool operator==(const Ratio&, const Ratio&) = default;
};

/// Between which bounds a feature's weight lies, in units of what the reference feature weighs, w_feature /
/// |w_reference|: costs are negative.
struct Bracket {
  std::size_t feature = 0;
  std::size_t reference = 0;
  std::optional<Ratio> low;   ///< The greatest lower bound; nothing: there is none.
  std::optional<Ratio> high;  ///< The least upper bound; nothing: there is none.
  friend bool operator==(const Bracket&, const Bracket&) = default;
};

/// What half-spaces together say about each of some features. The ends are exact: those of the projection of the region
/// { w : every half-space holds }, by its generators. Nothing about features of which neither end is known, nor about
/// any of them unless the region tells whether the reference is a cost or a gain.
/// @param features  none of them the reference.
/// @throws std::invalid_argument if the region has no interior.
[[nodiscard]] std::vector<Bracket> brackets(const Domain& domain, std::span<const HalfSpace> known,
                                            std::span<const std::size_t> features, std::size_t reference);

/// Between which bounds the weight of one feature may lie so that all half-spaces hold, while all other weights are the
/// robot's own: with those of its behaviour equivalence class, how far it may change without any change of the policy.
/// Ends are exact. Without one where there is none, or where it cannot be written as a ratio of 64-bit numbers.
/// @param k  not the reference.
[[nodiscard]] Bracket while_others_stay(const Domain& domain, std::span<const HalfSpace> known, std::size_t k,
                                        std::size_t reference);

/// The ends of a bracket as numbers without a sign, empty where there is none: of a cost its least and its most, else
/// those of `low` and `high`. In whole numbers, rounded so that no more is said than is known, and where counts are not
/// exact to what people keep in mind (round_number()); one number for two ends that are within 0.1 of it.
struct BracketEnds {
  std::string from, to;
};
[[nodiscard]] BracketEnds ends_of(const Domain& domain, const Bracket& bracket);

/// "crossing rubble costs 2 to 4 steps", "stopping at the charger is worth more than 2 steps", "crossing rubble costs
/// less than 4 steps", with ends as ends_of() writes them.
[[nodiscard]] std::string bracket_in_words(const Domain& domain, const Bracket& bracket);

}  // namespace kith
