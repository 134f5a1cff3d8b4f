#pragma once

#include <limits>
#include <optional>
#include <string>

#include "deviation.hpp"
#include "kith/explain/contrast.hpp"
#include "question_parser.hpp"

namespace kith::detail {

// Where a question is asked, and what happens there or could.
class Scene {
 public:
  Scene(const Atlas& atlas, const std::string& text, const Question& question)
      : atlas_{atlas}, domain_{atlas.domain()}, map_{domain_.map()}, text_{text}, question_{question} {}

  [[nodiscard]] std::string name_of(const Happening& happening) const;
  [[nodiscard]] const std::string& action(ActionIndex a) const { return domain_.action_names()[a.value()]; }
  [[nodiscard]] std::string context() const;
  // " without the charger", where the question is about such worlds only.
  [[nodiscard]] std::string condition() const;
  // Whether a world has and lacks what the question says of the worlds that it is about.
  [[nodiscard]] bool is_asked_about(MdpIndex world) const;
  // " at (2,1)", " in state 'on the ice'", or nothing.
  [[nodiscard]] std::string spot() const;
  // Where the question is about, in one world: the map's start, or the robot at the cell and all things as at first;
  // failing that as they are when its path from the start comes by, or in the first state with the robot there. Nothing
  // if it cannot be there, or if nobody knows what it does then.
  [[nodiscard]] std::optional<StartIndex> start_in(MdpIndex world) const;
  [[nodiscard]] StartIndex needed_start(MdpIndex world) const;
  // Whether the robot was seen all along its way, and inferred weights explain it; true if nothing was inferred.
  [[nodiscard]] bool was_seen(StartIndex start) const;
  [[nodiscard]] bool is_at(MdpIndex world, StateIndex s, ActionIndex a, const Happening& happening) const;
  // The step of a path at which it happens. With a cell only the first step counts.
  [[nodiscard]] std::optional<std::size_t> step_of(MdpIndex world, const Trajectory& path,
                                                   const Happening& happening) const;
  // The chance that it happens at all from there on (with a cell: with the next step) under the robot's policy, in [0,
  // 1]; 0 or 1 where chance has no part in it. Nothing where that takes too long.
  [[nodiscard]] std::optional<double> chance_of(StartIndex start, const Happening& happening) const;
  // The best path on which it happens, or does not (where chance has a part: on average more or less often), in
  // contrast to the robot's; one that is no detour if there is any.
  [[nodiscard]] std::optional<Contrast> contrast_to(StartIndex start, const Happening& happening, bool happens) const;
  // "world 3", or "world 3 (visiting hours)" where it has a name.
  [[nodiscard]] std::string name_of(MdpIndex world) const;
  // "at (2,1)", "in state 'on the ice'".
  [[nodiscard]] std::string spot_text(MdpIndex world, StateIndex s) const;
  [[nodiscard]] std::string place_text(StartIndex start) const;
  void check_possible(StartIndex start, const Happening& happening) const;
  // The best other step, followed by what the robot would do.
  [[nodiscard]] std::optional<Contrast> best_step(StartIndex start) const;
  // The best other way among those that `admits` accepts: what somebody could expect, or without tables one other step
  // anywhere on the robot's path.
  template <typename Predicate>
  [[nodiscard]] std::optional<Contrast> any_best_way(StartIndex start, const Predicate& admits) const {
    constexpr auto kAnywhere = std::numeric_limits<std::size_t>::max();
    return atlas_.find_tables() ? best_contrast(atlas_, start, admits)
                                : best_deviation(atlas_, start, 0, kAnywhere, admits);
  }
  // The same among those that are no detour.
  template <typename Predicate>
  [[nodiscard]] std::optional<Contrast> best_way(StartIndex start, const Predicate& admits) const {
    return any_best_way(start, [&](const Contrast& other) { return !is_detour(domain_, other) && admits(other); });
  }

 private:
  // Without tables: the way of people who are like the robot, except that the feature means just so much more (or less)
  // to them that it happens more often (or less).
  [[nodiscard]] std::optional<Contrast> way_of_others(StartIndex start, const Happening& happening, bool happens) const;
  [[nodiscard]] std::optional<StartIndex> place_in(MdpIndex world) const;
  [[nodiscard]] std::optional<StartIndex> state_called(MdpIndex world, const std::string& name) const;

  const Atlas& atlas_;
  const Domain& domain_;
  std::optional<GridMap> map_;  // there is one if the question names a cell or an item
  const std::string& text_;
  const Question& question_;
};

}  // namespace kith::detail
