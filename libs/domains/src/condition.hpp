#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kith/domains/domain.hpp"
#include "kith/domains/family_map.hpp"

namespace kith::detail {

enum class Action : std::uint8_t { kUp, kDown, kLeft, kRight, kPickup, kDropoff, kExit };

// All names, in canonical order: action_names()[static_cast<size_t>(a)].
[[nodiscard]] const std::vector<std::string>& all_action_names();

// One statement about a transition that a condition can be made of.
struct Atom {
  enum class Kind : std::uint8_t {
    kAnyAction,     // action
    kAction,        // action:NAME, exit; index = Action
    kLeaveTerrain,  // leave:X; index into terrain_names
    kLeaveStation,  // index into station_names
    kEnterTerrain,  // enter:X
    kEnterStation,
    kCarrying,  // carrying:X; index into items
    kDeliver,   // deliver:X; index into items
    kGoal,      // goal:X; index into goal_names
    kAnyGoal,   // goal
    kNever,     // of a thing that is declared absent
  };
  Kind kind = Kind::kAnyAction;
  std::size_t index = 0;
  friend bool operator==(const Atom&, const Atom&) = default;
};

// Bit i of a mask: atom i of the table holds for a transition.
using AtomMask = std::uint64_t;
inline constexpr std::size_t kMaxAtoms = 64;

// A boolean expression over atoms, in postfix order.
class Condition {
 public:
  [[nodiscard]] bool holds(AtomMask mask) const;

  enum class Op : std::uint8_t { kAtom, kAnd, kOr, kNot };
  struct Step {
    Op op = Op::kAtom;
    std::size_t atom = 0;
  };
  std::vector<Step> steps;
  bool names_absent_things = false;
};

// What has to be there for the condition to hold, in its order.
[[nodiscard]] std::vector<FeatureThing> things_of(const Condition& condition, const std::vector<Atom>& atoms,
                                                  const FamilyMap& family_map);

// What conditions may name.
struct Vocabulary {
  const FamilyMap& family_map;
  const std::vector<Action>& actions;
};

// Reads conditions and numbers the atoms that they use.
class ConditionReader {
 public:
  ConditionReader(Vocabulary vocabulary, TomlReport& report) : vocabulary_{vocabulary}, report_{report} {}

  // Reports syntax errors and unknown names at their column within the string.
  [[nodiscard]] std::optional<Condition> read(const TomlValue& value);

  [[nodiscard]] const std::vector<Atom>& atoms() const { return atoms_; }

 private:
  Vocabulary vocabulary_;
  TomlReport& report_;
  std::vector<Atom> atoms_;
};

}  // namespace kith::detail
