#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kith/bec/atlas.hpp"
#include "kith/core/diagnostic.hpp"

namespace kith::detail {

// A stretch of the question, for messages: columns from 1.
struct Place {
  std::size_t column = 1;
  std::size_t length = 1;
};

// Something the robot does: an action, or a feature that counts.
struct Happening {
  std::optional<ActionIndex> action;
  std::size_t feature = 0;  // unless it is an action
  Place place;
};

// A thing that the map may have or lack.
struct WorldCondition {
  bool present = true;
  std::string thing;
  std::optional<Cell> cell;
  Place place;
};

struct Question {
  enum class Kind { kWhen, kWhere, kWhy, kWhatIf, kWhat, kHowMuch, kWhether };
  Kind kind = Kind::kWhen;
  std::optional<Happening> happening, instead;
  bool negated = false;  // of kWhen and kWhere: that the happening does not happen
  std::vector<WorldCondition> conditions;
  std::optional<Cell> cell;            // where the robot is, in domains with a map
  std::optional<std::string> state;    // what the robot's state is called, in domains without one
  Place spot;                          // of either in the text
  std::optional<std::size_t> carried;  // index into GridMap::item_names()
  std::optional<MdpIndex> world;
  std::optional<HalfSpace> said, condition;  // of kWhether: a statement about the robot's reward, and where it is made

  [[nodiscard]] bool is_about_a_step() const { return cell || state; }
};

// @throws kith::Error: the question with a caret under the place.
[[noreturn]] void fail(const std::string& question, const Place& place, const std::string& id,
                       const std::string& message, const Advice& advice = {});

// Understands a question. @throws kith::Error (E1102 to E1106).
[[nodiscard]] Question parse_question(const Domain& domain, const std::string& text);

}  // namespace kith::detail
