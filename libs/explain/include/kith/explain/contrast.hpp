#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kith/bec/behaviours.hpp"

namespace kith {

/// The robot's path beside one that somebody could expect in its place. Where chance has a part both are the likeliest.
struct Contrast {
  StartIndex start;
  Trajectory robot;
  Trajectory alternative;      ///< From the same start; as long together with the robot's path as it can be.
  IntegerVector robot_counts;  ///< Of the whole path, or expected; shape [d], in units of 1 / Domain::count_scale().
  /// The robot's, and what the other path counts more or less from the state on at which it was expected.
  IntegerVector alternative_counts;
  /// Both take the same actions before this one, and different ones here.
  std::size_t decisive = 0;
};

/// The contrast with a path that ends as some vertex of a coverage set says.
/// @param from  position on the robot's path at which the vertex was taken, 0: at its start.
/// @param vertex  one of the coverage set of that state; not the robot's own.
/// @throws std::invalid_argument if there is no such position, or the vertex is none of the coverage set, or the
/// robot's own.
[[nodiscard]] Contrast contrast_with(const Atlas& atlas, StartIndex start, std::size_t from,
                                     const IntegerVector& vertex);

/// The constraint that a contrast conveys: preference_of_robot() of what the robot's path counts beyond the other one.
/// Nothing if both are worth the same.
[[nodiscard]] std::optional<HalfSpace> conveyed_by(const Domain& domain, const Contrast& contrast);

/// Whether the other path has nothing in its favour: no cost is less and no gain is more than on the robot's. It tells
/// nothing about what the robot prefers to what.
[[nodiscard]] bool is_detour(const Domain& domain, const Contrast& contrast);

/// Counts of a path in a world where nothing is left to chance, as whole numbers, whatever Domain::count_scale() is.
[[nodiscard]] IntegerVector whole_counts(const Domain& domain, const IntegerVector& counts);

/// Why the robot takes its path and not another one, in a world without chance where later steps count less: what the
/// two paths that are drawn count differently, or which of them never ends.
[[nodiscard]] std::string choice_between(const Domain& domain, MdpIndex world, const Trajectory& robot,
                                         const Trajectory& other);

/// What the robot does, rather than what, because of what: reason() of both counts. In worlds where counts are
/// expectations, risk_in_words() or else on_average_in_words(), and told() of what is conveyed.
/// @param together  other constraints that are conveyed at the same time; see short_statement().
/// @throws std::invalid_argument if both paths count the same, or the alternative is worth more to the robot.
[[nodiscard]] std::string reason(const Atlas& atlas, const Contrast& contrast,
                                 std::span<const HalfSpace> together = {});

/// The contrast that conveys a constraint, at the earliest state of the robot's path where there is one: with a path
/// that somebody expects and that differs from the robot's by a multiple of the constraint's normal; where nobody
/// knows what people expect (Atlas::find_tables()), with the path that such a single other action begins, after which
/// the robot goes on as ever. Of several the smallest multiple. Nothing if there is none.
[[nodiscard]] std::optional<Contrast> contrast_for(const Atlas& atlas, StartIndex start, const HalfSpace& constraint);

/// The same for people: without tables, with the path that one of them expects, from the earliest state where theirs
/// conveys the constraint; failing that, with a single other action.
[[nodiscard]] std::optional<Contrast> contrast_for(Behaviours& behaviours, StartIndex start,
                                                   const HalfSpace& constraint,
                                                   std::span<const PolicyCellIndex> people);

/// Of the paths that somebody could expect from the start, the one that is best for the robot among those that `admits`
/// accepts; the robot's own is none of them. Nothing if none is accepted.
template <typename Predicate>
[[nodiscard]] std::optional<Contrast> best_contrast(const Atlas& atlas, StartIndex start, const Predicate& admits) {
  const auto& weights = atlas.domain().weights().integer;
  std::optional<Contrast> best;
  for (const auto& vertex : atlas.tables().coverage_set(start)) {
    if (vertex == atlas.feature_counts(start)) continue;
    if (best && dot(weights, vertex) <= dot(weights, best->alternative_counts)) continue;
    auto contrast = contrast_with(atlas, start, 0, vertex);
    if (admits(contrast)) best = std::move(contrast);
  }
  return best;
}

/// The start of a demonstration in another world: the robot and what it carries are the same, things that only one of
/// the worlds has are there or not. Nothing if that world has no such state.
[[nodiscard]] std::optional<StartIndex> same_start(const Atlas& atlas, StartIndex start, MdpIndex world);

/// How worlds differ: "without the rubble at (2,1)", "with the charger at (4,1) and without the rubble at (2,1)".
/// @param toggled  positions in Domain::optional_groups() at which `world` differs from another one.
[[nodiscard]] std::string difference_in_words(const Domain& domain, MdpIndex world,
                                              std::span<const std::size_t> toggled);

/// Positions in Domain::optional_groups() at which two worlds differ.
[[nodiscard]] std::vector<std::size_t> toggled_groups(const Domain& domain, MdpIndex a, MdpIndex b);

}  // namespace kith
