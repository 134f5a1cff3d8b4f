#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "outcomes.hpp"

namespace kith::detail {

// What the study says about one question and one outcome.
struct Answer {
  std::string question;
  std::string outcome;
  int digits = 1;
  std::string finding{};   // its id
  std::string means{};     // what is compared, in numbers
  std::string compared{};  // "joint - common"
  std::optional<double> estimate{}, low{}, high{};
  std::optional<double> bound{};  // any two levels differ by less
  std::optional<double> p{};
  std::string answer{};
  std::size_t teams = 0;  // the fewest that are compared, of a level
  // Half of the (widest) interval, in standard deviations of teams of a cell; infinite without an interval.
  double width = std::numeric_limits<double>::infinity();
};

// Whether there are so few teams that no difference says next to nothing: even a large one would not be seen.
[[nodiscard]] bool is_of_few(const Answer& answer);

// "6.3 and 10.3", shares with as many decimals as they need.
[[nodiscard]] std::string means_text(const std::vector<double>& means, int digits, const std::string& between);

[[nodiscard]] bool is_shown(const Answer& answer);

// Teams taught together compared with members taught one after the other. @pre compares_with_alone().
[[nodiscard]] Answer answer_about_alone(const FirstScreen& screen, const StudyOutcome& outcome);
// A factor with several levels; nothing if it was not analysed.
[[nodiscard]] std::optional<Answer> answer_about(const FirstScreen& screen, const StudyOutcome& outcome,
                                                 const std::string& factor, const std::string& question);
// The differences that are marked as primary in the study.
[[nodiscard]] std::vector<Answer> planned(const FirstScreen& screen);
// All of them, or means where there is nothing to compare.
[[nodiscard]] std::vector<Answer> all_answers(const FirstScreen& screen);

}  // namespace kith::detail
