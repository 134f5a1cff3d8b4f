#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kith/bec/atlas.hpp"

namespace kith {

/// A demonstration that shows part of an answer.
struct Example {
  StartIndex start;
  Trajectory path;                        ///< The robot's.
  std::string text;                       ///< One sentence: what it shows, and why.
  std::optional<Trajectory> alternative;  ///< The path that the sentence compares with.
  std::optional<std::size_t> decisive;    ///< The step from which both differ, or at which it happens.
};

/// What the robot replies to a question.
struct Reply {
  std::string question;           ///< As it was understood: "When does it stop at the charger?".
  std::string text;               ///< The answer in a sentence or two.
  std::vector<Example> examples;  ///< Pairs where it does and where it does not stand together.
};

/// Answers a question about the robot's behaviour with demonstrations that show it.
///
///   when [not] HAPPENING [if [no] THING] [at CELL] [carrying ITEM] [in world N]   worlds that differ in little
///   where [not] HAPPENING [if [no] THING] [in world N]       cells
///   why [HAPPENING] [not HAPPENING] [at CELL] [...]          the comparison that decides
///   what if [no] THING [at CELL] [and ...] [in world N]      what changes
///   what at CELL [carrying ITEM] [in world N]                what it does there
///   how much FEATURE                                         what its behaviour tells about the feature's weight
///   is X worse than 2 Y, does X cost less than 1.5 Y, ...    whether its behaviour shows it
///
/// "Does it HAPPENING" and "how often HAPPENING" ask as "when" does; "avoid" and "around" as "not" does. Synonyms such
/// as "north", "charge", "deliver" stand for the domain's own word. Every other word, number and sign is read, or the
/// question is refused, as it is if it says something twice. A HAPPENING is an action or a feature: its name, or words
/// of [words] in any form ("recharges", "crossing rubble"). A CELL is "(2,1)" or "2,1": column and row from the top
/// left; in models without a map the name of a state in quotes or behind the word "state", or a part of it that no
/// other has. Words such as "does it" may be left out or put in. Where a robot whose weights were inferred was not
/// seen, nothing is answered. Without tables (Atlas::find_tables()) the robot's path is compared with those that differ
/// in one step, and with those of people to whom the feature means more or less; in stochastic domains paths are the
/// likeliest ones, and chances and expectations are given. Without a cell questions are about the path from the map's
/// start; without a world about all of them, or the one with everything (`why`, `what`).
/// @throws kith::Error (kInvalidInput) with diagnostics E1102 to E1108 that point into the question.
[[nodiscard]] Reply answer_question(const Atlas& atlas, const std::string& question);

}  // namespace kith
