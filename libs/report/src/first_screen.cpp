#include "first_screen.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "answers.hpp"
#include "kith/analysis/decimals.hpp"
#include "kith/analysis/moments.hpp"
#include "kith/explain/words.hpp"
#include "kith/teaching/strategy.hpp"
#include "sentences.hpp"

namespace kith::detail {
namespace {

// "takes 49 % fewer periods".
std::string change_text(double together, double alone) {
  const double change = alone > 0.0 ? (together - alone) / alone : 0.0;
  return std::to_string(std::llround(100.0 * std::abs(change))) + " % " + (change < 0.0 ? "fewer" : "more");
}

std::string headline_about_alone(const FirstScreen& screen) {
  const auto mean_of = [&](const StudyOutcome& outcome, bool alone) { return mean(values_of(screen, outcome, alone)); };
  const auto periods = answer_about_alone(screen, kPeriods), people = answer_about_alone(screen, kPersonPeriods);
  const double together = mean_of(kPeriods, false), alone = mean_of(kPeriods, true);
  std::string people_text;
  if (is_shown(people))
    people_text = change_text(mean_of(kPersonPeriods, false), mean_of(kPersonPeriods, true)) + " person-periods";

  if (has_fixed_periods(screen)) {
    return fmt::format(
        "every team was taught for {:.0f} periods together{}", together,
        together == alone ? " or one after the other" : fmt::format(", and {:.0f} one after the other", alone));
  }
  if (!is_shown(periods)) {
    const auto text =
        is_of_few(periods)
            ? fmt::format(
                  "too few teams to tell whether teaching together takes fewer periods than one after the "
                  "other: {} on average (n = {})",
                  periods.means, periods.teams)
            : "no difference in periods was found between teaching a team together and one after the other";
    return people_text.empty() ? text : text + ", but teaching together takes " + people_text;
  }
  std::string text =
      "teaching a team together takes " + change_text(together, alone) + " periods than one after the other";
  if (people_text.empty()) return text;
  const bool opposed = (mean_of(kPersonPeriods, false) < mean_of(kPersonPeriods, true)) != (together < alone);
  return text + (opposed ? ", but " : " and ") + people_text;
}

std::string headline_about(const FirstScreen& screen, const std::string& factor, const std::string& levels) {
  const bool is_fixed = has_fixed_periods(screen);
  const auto periods = is_fixed ? std::nullopt : answer_about(screen, kPeriods, factor, "");
  const auto knowledge = answer_about(screen, known(screen), factor, "");
  if (!periods && !knowledge) return "";
  const bool on_periods = periods && is_shown(*periods), on_knowledge = knowledge && is_shown(*knowledge);
  const std::string name{known(screen).phrase};
  if (on_periods && on_knowledge) return levels + " differ in periods and in " + name;
  if (on_periods) return levels + " differ in periods, but not detectably in " + name;
  if (on_knowledge && is_fixed) {
    const double periods_of_all = values_of(screen, kPeriods, num_together(screen) == 0).front();
    return fmt::format("{} differ in {} after {:.0f} periods", levels, name, periods_of_all);
  }
  if (on_knowledge) return levels + " differ in " + name + ", but not detectably in periods";
  const auto& answer = knowledge ? *knowledge : *periods;
  if (!is_of_few(answer)) return "no difference between " + levels + " was found";
  const auto means = answer.means.empty() ? "" : ": " + answer.means + " " + answer.outcome;
  return fmt::format("too few teams to compare {}{} (n = {})", levels, means, answer.teams);
}

// How much the strategies showed, where that may be why people know more.
std::string dose_text(const FirstScreen& screen) {
  constexpr double kAlike = 1.1;
  std::map<std::string, Values> items;
  for (std::size_t i = 0; i < screen.data.teams.size(); ++i)
    if (!is_alone(screen, i)) items[series_of(screen, i).label].push_back(items_of(screen.data.teams[i]));
  const auto by_mean = [](const auto& a, const auto& b) { return mean(a.second) < mean(b.second); };
  const auto [least, most] = std::minmax_element(items.begin(), items.end(), by_mean);
  if (items.size() < 2 || mean(least->second) <= 0.0 || mean(most->second) < kAlike * mean(least->second)) return "";
  return fmt::format(
      "Not everybody saw equally much: from {:.1f} demonstrations and tests on average ({}) to {:.1f} ({}, {:.0f} % "
      "more). Part of a difference may be due to that.",
      mean(least->second), least->first, mean(most->second), most->first,
      100.0 * (mean(most->second) / mean(least->second) - 1.0));
}

std::size_t num_completed(const FirstScreen& screen) {
  return static_cast<std::size_t>(std::count_if(screen.data.teams.begin(), screen.data.teams.end(),
                                                [](const auto& team) { return team.completed(); }));
}

}  // namespace

std::string headline(const FirstScreen& screen) {
  std::vector<std::string> parts;
  if (compares_with_alone(screen)) parts.push_back(headline_about_alone(screen));

  const auto hypotheses = planned(screen);
  if (!hypotheses.empty()) {
    const auto shown = static_cast<std::size_t>(std::count_if(hypotheses.begin(), hypotheses.end(), is_shown));
    parts.push_back(std::to_string(shown) + " of " + counted(hypotheses.size(), "planned difference") +
                    (shown == 1 ? " was found" : " were found"));
  }

  const auto strategies = num_together(screen);
  if (auto text = headline_about(screen, "strategy", "the " + std::to_string(strategies) + " strategies");
      strategies > 1 && !text.empty())
    parts.push_back(std::move(text));

  // Without a comparison, what was found of compositions; without these, how long teams took.
  if (parts.empty()) {
    if (auto text = headline_about(screen, "composition", "compositions of the team"); !text.empty())
      parts.push_back(std::move(text));
  }
  if (parts.empty()) {
    const auto periods = values_of(screen, kPeriods, num_together(screen) == 0);
    if (periods.empty()) return "Nothing was taught";
    parts.push_back((num_together(screen) == 0 ? "members taught one after the other needed " : "teams needed ") +
                    fmt::format("{:.{}f}", mean(periods), 1) + " periods on average, and " +
                    std::to_string(num_completed(screen)) + " of " + std::to_string(screen.data.teams.size()) +
                    (screen.by_tests ? " passed all tests" : " were taught to the end"));
  }
  return capitalised(joined(parts, "; "));
}

Json answers(const FirstScreen& screen) {
  Json list = Json::array();
  for (const auto& answer : all_answers(screen)) {
    const int digits =
        answer.low && answer.high ? interval_decimals(*answer.low, *answer.high, answer.digits) : answer.digits;
    list.push_back({{"question", answer.question},
                    {"outcome", answer.outcome},
                    {"means", answer.means},
                    {"compared", answer.compared},
                    {"estimate", number(answer.estimate)},
                    {"low", number(answer.low)},
                    {"high", number(answer.high)},
                    {"bound", number(answer.bound)},
                    {"digits", digits},
                    {"p", number(answer.p)},
                    {"answer", answer.answer},
                    {"finding", answer.finding}});
  }
  return list;
}

Json limits(const FirstScreen& screen) {
  Json list = Json::array();
  const auto& teams = screen.data.teams;
  if (screen.simulated) {
    list.push_back(
        "The learners are simulated. How real people would learn from the same lessons is not part of this study.");
  } else {
    list.push_back("What people believe is not observed. Knowledge is what the teacher estimates from their answers.");
  }

  const auto outcome = known(screen);
  std::string means;
  for (const bool alone : {false, true}) {
    const auto values = values_of(screen, outcome, alone);
    if (values.empty()) continue;
    if (!means.empty()) means += " and ";
    means += means_text({mean(values)}, outcome.digits, "");
    if (compares_with_alone(screen)) means += alone ? " one after the other" : " together";
  }

  if (!means.empty()) {
    list.push_back(
        (screen.by_tests ? "Passing all tests" : "Being taught to the end") +
        std::string{" is not knowing everything: "} + std::to_string(num_completed(screen)) + " of " +
        counted(teams.size(), "team") + (screen.by_tests ? " passed" : " were") + ", while " +
        (screen.data.leads_with_exam
             ? "the share of starts from which members predict the robot correctly is "
             : "the share of a member's belief under which the robot would act as it does everywhere (knowledge) is ") +
        means + " on average.");
  }

  if (compares_with_alone(screen)) {
    const auto count = [&](bool alone) {
      return fmt::format("{:.{}f}", mean(values_of(screen, kPeriods, alone)), 1) + " periods are " +
             fmt::format("{:.{}f}", mean(values_of(screen, kPersonPeriods, alone)), 1) + " person-periods";
    };
    list.push_back("A period of a team takes the time of everybody in it: together, " + count(false) +
                   "; one after the other, " + count(true) + ".");
  }

  if (auto text = dose_text(screen); !text.empty()) list.push_back(std::move(text));

  const auto all = all_answers(screen);
  if (std::any_of(all.begin(), all.end(), [](const auto& one) { return one.p && !is_shown(one); })) {
    list.push_back(
        "\"No difference found\" and \"too few teams to tell\" do not say that there is none. The table gives how "
        "large "
        "one may still be.");
  }
  return list;
}

Json meanings(const ReportDesign& design, const std::map<char, std::string>& types) {
  Json strategies = Json::object(), compositions = Json::object();
  for (const auto& series : design.series) {
    const auto* kind = find_strategy_kind(series.strategy);
    if (kind != nullptr) strategies[series.code] = std::string{kind->description};
    if (series.strategy == kBaseline) strategies[series.code] = "teach the members one after the other, each alone";
  }
  for (const auto& cell : design.cells) {
    std::map<char, std::size_t> counts;
    for (const char letter : cell.composition) ++counts[letter];
    compositions[cell.composition] = joined(counts, ", ", [&](const auto& of_type) {
      const auto found = types.find(of_type.first);
      return std::to_string(of_type.second) + " " +
             (found == types.end() || found->second.empty() ? std::string{of_type.first} : found->second);
    });
  }
  return {{"strategies", std::move(strategies)}, {"compositions", std::move(compositions)}};
}

}  // namespace kith::detail
