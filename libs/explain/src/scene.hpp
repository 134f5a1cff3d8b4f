#pragma once

#include <optional>
#include <string>

#include "kith/explain/contrast.hpp"
#include "question_parser.hpp"

namespace kith::detail {

// Where a question is asked, and what happens there or could.
class Scene {
 public:
  Scene(const Atlas& atlas, const std::string& text, const Question& question)
      : atlas_{atlas}, domain_{atlas.domain()}, text_{text}, question_{question} {}

  [[nodiscard]] std::string name_of(const Happening& happening) const;
  [[nodiscard]] const std::string& action(ActionIndex a) const { return domain_.action_names()[a.value()]; }
  [[nodiscard]] std::string context() const;
  // Where the question is about, in one world: the map's start, or the robot at the cell and all things as at first;
  // failing that as they are when its path from the start comes by, or in the first state with the robot there.
  [[nodiscard]] std::optional<DemoIndex> start_in(MdpIndex world) const;
  [[nodiscard]] DemoIndex needed_start(MdpIndex world) const;
  [[nodiscard]] bool is_at(MdpIndex world, StateIndex s, ActionIndex a, const Happening& happening) const;
  // The step of a path at which it happens. With a cell only the first step counts.
  [[nodiscard]] std::optional<std::size_t> step_of(MdpIndex world, const Trajectory& path,
                                                   const Happening& happening) const;
  // The path that begins with another action and goes on as the robot would.
  [[nodiscard]] std::optional<Contrast> deviation(DemoIndex demo, ActionIndex a) const;
  // The best path on which it happens, or does not, in contrast to the robot's.
  [[nodiscard]] std::optional<Contrast> contrast_to(DemoIndex demo, const Happening& happening, bool happens) const;
  [[nodiscard]] std::string place_text(DemoIndex demo) const;
  void check_possible(DemoIndex demo, const Happening& happening) const;
  [[nodiscard]] std::optional<Contrast> best_deviation(DemoIndex demo) const;

 private:
  const Atlas& atlas_;
  const Domain& domain_;
  const std::string& text_;
  const Question& question_;
};

}  // namespace kith::detail
