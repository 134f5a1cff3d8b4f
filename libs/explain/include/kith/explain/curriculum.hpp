#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kith/explain/bracket.hpp"
#include "kith/explain/contrast.hpp"
#include "kith/explain/runs.hpp"
#include "kith/explain/update.hpp"
#include "kith/teaching/session.hpp"

namespace kith {

/// A demonstration as people see it.
struct CurriculumDemonstration {
  StartIndex start;
  std::vector<HalfSpace> conveys;  ///< What it conveys, minimal, sorted; without what is known beforehand.
  HalfSpace main;                  ///< The one that narrows most what was taught before; the reason's.
  Contrast contrast;               ///< With the path that a person who does not know `main` would expect.
  std::string reason;              ///< One sentence; see reason().
  std::vector<PolicyRun> runs;     ///< As outcomes fell; nothing if chance has no part in what the robot does.
  /// Of the component's features, by the prior and all that was shown up to here: first the boards that are first.
  std::vector<Bracket> brackets{};
  bool is_first = false;  ///< One of those that a lesson begins with; see Curriculum::kMostFirst.
};

enum class Difficulty { kEasy, kMedium, kHard };

/// "easy", "medium" or "hard".
[[nodiscard]] const char* name_of(Difficulty difficulty) noexcept;

/// A test, and how hard it is for those who have not been taught its component.
struct CurriculumTest {
  StartIndex start;
  std::vector<HalfSpace> covers;   ///< Taught constraints that the robot's path is about.
  bool is_shortest_wrong = false;  ///< Test::is_shortest_wrong
  bool is_first = false;           ///< As of a demonstration.
  /// Share of the beliefs that answer right, in [0, 1]: beliefs are uniform over what was known before the component.
  double share_right = 0.0;
  Difficulty difficulty = Difficulty::kMedium;  ///< Easy from two thirds on, hard below one third.
  std::vector<PolicyRun> runs;                  ///< As of a demonstration.
};

/// A knowledge component with all that is shown and asked.
struct CurriculumComponent {
  std::size_t component = 0;           ///< Index into Atlas::knowledge_components().
  std::string name;                    ///< "crossing rubble against steps".
  std::vector<HalfSpace> constraints;  ///< Sorted, without what is known beforehand or follows from nothing shown.
  double area_sr = 0.0;                ///< Solid angle of the constraints with the prior.
  std::vector<CurriculumDemonstration> demonstrations;
  std::vector<CurriculumTest> tests;  ///< Easy ones first.
};

/// A component that is not taught, and why.
struct SkippedComponent {
  std::string name, why;
};

/// What would be taught to one attentive person, who answers every test right.
struct Curriculum {
  /// How many boards a lesson begins with at most: of every component the first ones, which tell most, without tests
  /// that the shortest path answers. The others are offered afterwards.
  static constexpr std::size_t kMostFirst = 12;

  std::vector<CurriculumComponent> components;
  std::vector<SkippedComponent> skipped;
  /// For those who have learned everything: tests in worlds that they have not seen, which about half of the beliefs
  /// of the prior answer right.
  std::vector<CurriculumTest> fresh;
  /// With TeachingOptions::known, for people who know the robot as it was: then all the rest is about what is new, and
  /// there is nothing of it if nothing is.
  std::optional<UpdateInWords> update;
  std::optional<StartIndex> endless;  ///< The simplest start from which the robot never arrives, if there is one.
};

struct CurriculumOptions {
  TeachingOptions teaching{};
  std::uint64_t seed = 1;      ///< Root of all that the teacher draws.
  std::size_t runs = 10;       ///< How many runs are drawn where chance has a part.
  std::size_t fresh = 3;       ///< How many fresh tests there are at most.
  std::size_t beliefs = 4000;  ///< Points of the regular cover by which share_right is measured, >= 1.
};

/// Refuses domains about which nobody can be taught anything.
/// @throws kith::Error (kInfeasible, E1101) with the reason: the prior implies the whole policy, everybody who expects
/// an end expects the same, or no demonstration tells anybody anything else (complete_unit()).
void require_something_to_teach(const Atlas& atlas);

/// Teaches one person all components by the baseline strategy and keeps what was shown. A pure function.
/// @param atlas  of any domain; without tables share_right is measured with at most 200 beliefs.
/// @throws kith::Error (kInfeasible, E1101) if nothing can be taught, with the reason.
/// @throws std::invalid_argument if an option is out of range.
[[nodiscard]] Curriculum make_curriculum(const Atlas& atlas, const CurriculumOptions& options = {});

/// A component's name in words: "crossing rubble and stopping at the charger against steps".
[[nodiscard]] std::string component_in_words(const Atlas& atlas, std::size_t component);

}  // namespace kith
