#include "first_screen.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "kith/analysis/analysis.hpp"
#include "kith/stats/effect_size.hpp"
#include "kith/stats/moments.hpp"
#include "kith/stats/tests.hpp"
#include "kith/teaching/strategy.hpp"

namespace kith::detail {
namespace {

using Values = std::vector<double>;

const double kAlpha = AnalysisOptions{}.alpha;

struct Outcome {
  std::string id;    // as in the names of findings
  std::string name;  // in a sentence
  double TeamValues::*value;
  int digits;
};

std::string rounded_text(double value, int digits) {
  const double scale = std::pow(10.0, digits);
  auto text = std::to_string(std::llround(std::abs(value) * scale));
  const auto fraction = static_cast<std::size_t>(digits);
  if (text.size() <= fraction) text.insert(0, fraction + 1 - text.size(), '0');
  if (fraction > 0) text.insert(text.size() - fraction, ".");
  return (value < 0.0 ? "-" : "") + text;
}

const ReportDesign::Series& series_of(const FirstScreen& screen, std::size_t team) {
  return screen.design.series[screen.design.cells[screen.design.cell_of_team[team]].series];
}
const std::string& composition_of(const FirstScreen& screen, std::size_t team) {
  return screen.design.cells[screen.design.cell_of_team[team]].composition;
}
bool is_alone(const FirstScreen& screen, std::size_t team) { return series_of(screen, team).strategy == kBaseline; }

Values values_of(const FirstScreen& screen, const Outcome& outcome, bool alone) {
  Values values;
  for (std::size_t i = 0; i < screen.data.teams.size(); ++i) {
    const double value = screen.data.teams[i].*outcome.value;
    if (is_alone(screen, i) == alone && std::isfinite(value)) values.push_back(value);
  }
  return values;
}

bool compares_with_alone(const FirstScreen& screen) {
  const auto& series = screen.design.series;
  const auto alone = std::count_if(series.begin(), series.end(), [](auto& one) { return one.strategy == kBaseline; });
  return alone > 0 && static_cast<std::size_t>(alone) < series.size();
}

const Outcome kPeriods{"periods", "periods", &TeamValues::periods, 1};
const Outcome kPersonPeriods{"person-periods", "person-periods", &TeamValues::person_periods, 1};

Outcome known(const FirstScreen& screen) {
  if (screen.data.leads_with_exam) {
    return {"exam_share_right", "share right in the exam", &TeamValues::exam_share_right, 2};
  }
  return {"knowledge", screen.simulated ? "knowledge at the end" : "estimated knowledge at the end",
          &TeamValues::knowledge, 2};
}

// A period of a team takes the time of everybody in it, so that the comparison with teaching alone needs both counts.
std::vector<Outcome> outcomes_of(const FirstScreen& screen) {
  std::vector<Outcome> outcomes{kPeriods};
  if (compares_with_alone(screen)) outcomes.push_back(kPersonPeriods);
  outcomes.push_back(known(screen));
  if (screen.data.has_exam && !screen.data.leads_with_exam) {
    outcomes.push_back({"exam_share_right", "share right in the exam", &TeamValues::exam_share_right, 2});
  }
  return outcomes;
}

const Finding* finding_of(const FirstScreen& screen, const std::string& id) {
  const auto& all = screen.findings;
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.id == id; });
  return found == all.end() ? nullptr : &*found;
}

// A row of a table of results by the names of its columns.
class ResultRow {
 public:
  ResultRow(const ResultTable& table, const std::vector<TableCell>& cells) : table_{table}, cells_{cells} {}

  [[nodiscard]] std::string label() const {
    const auto* const text = std::get_if<std::string>(&cells_.front());
    return text == nullptr ? std::string{} : *text;
  }
  [[nodiscard]] std::optional<double> number(std::string_view field) const {
    const auto fields = field_names(table_);
    for (std::size_t c = 0; c < fields.size(); ++c) {
      if (fields[c] == field) return value(c);
    }
    return std::nullopt;
  }
  // The last one is corrected for the others, if any is.
  [[nodiscard]] std::optional<double> p() const {
    std::optional<double> last;
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      if (table_.columns[c].kind == ResultKind::kP && value(c)) last = value(c);
    }
    return last;
  }

 private:
  [[nodiscard]] std::optional<double> value(std::size_t column) const {
    const auto* const real = std::get_if<double>(&cells_[column]);
    return real == nullptr ? std::nullopt : std::optional{*real};
  }

  const ResultTable& table_;
  const std::vector<TableCell>& cells_;
};

std::vector<ResultRow> rows_of(const ResultTable& table) {
  std::vector<ResultRow> rows;
  for (const auto& cells : table.rows) rows.emplace_back(table, cells);
  return rows;
}

const ResultTable* table_of(const Finding& finding, const std::string& caption) {
  const auto& all = finding.tables;
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.caption.find(caption) == 0; });
  return found == all.end() ? nullptr : &*found;
}

// The p-value of a term in the first table of a finding.
std::optional<double> p_of_term(const Finding& finding, const std::string& term) {
  if (finding.tables.empty()) return std::nullopt;
  for (const auto& row : rows_of(finding.tables.front())) {
    if (row.label() == term) return row.p();
  }
  return std::nullopt;
}

struct Answer {
  std::string question;
  std::string outcome;
  int digits = 1;
  std::string finding{};   // its id
  std::string means{};     // what is compared, in numbers
  std::string compared{};  // "joint - common"
  std::optional<double> estimate{}, low{}, high{};
  std::optional<double> bound{};  // any two levels differ by less
  bool is_ratio = false;
  std::optional<double> p{};
  std::string answer{};
};

bool is_shown(const Answer& answer) { return answer.p && *answer.p < kAlpha; }

std::string two_means(const FirstScreen& screen, const Outcome& outcome) {
  return rounded_text(mean(values_of(screen, outcome, false)), outcome.digits) + " and " +
         rounded_text(mean(values_of(screen, outcome, true)), outcome.digits);
}

// The same people taught together, whatever the strategy, and alone, or other people.
Estimable<MeanDifference> together_against_alone(const FirstScreen& screen, const Outcome& outcome) {
  if (!screen.paired) return welch_t_test(values_of(screen, outcome, false), values_of(screen, outcome, true));
  std::map<std::tuple<std::size_t, std::string, std::size_t>, std::pair<Values, Values>> people;
  for (std::size_t i = 0; i < screen.data.teams.size(); ++i) {
    auto& [together, alone] =
        people[{series_of(screen, i).variant, composition_of(screen, i), screen.data.teams[i].replicate}];
    (is_alone(screen, i) ? alone : together).push_back(screen.data.teams[i].*outcome.value);
  }
  Values together, alone;
  for (const auto& [key, values] : people) {
    if (values.first.empty() || values.second.empty()) continue;
    together.push_back(mean(values.first));
    alone.push_back(mean(values.second));
  }
  return paired_t_test(together, alone);
}

Answer answer_about_alone(const FirstScreen& screen, const Outcome& outcome) {
  Answer answer{"Together compared with one after the other", outcome.name, outcome.digits};
  answer.means = two_means(screen, outcome);
  if (const auto* finding = finding_of(screen, outcome.id + "-baseline"); finding != nullptr) {
    answer.finding = finding->id;
    for (const auto& row : rows_of(finding->tables.front())) {
      answer.estimate = row.number("difference");
      answer.low = row.number("lower_limit");
      answer.high = row.number("upper_limit");
      answer.p = row.p();
    }
  } else if (const auto test = together_against_alone(screen, outcome)) {
    answer.estimate = test->difference;
    answer.low = test->low;
    answer.high = test->high;
    answer.p = test->test.p;
  }
  const double together = mean(values_of(screen, outcome, false)), alone = mean(values_of(screen, outcome, true));
  answer.answer = "no difference found";
  if (!answer.p) answer.answer = "not tested";
  if (is_shown(answer)) {
    answer.answer = together < alone ? "less together" : "more together";
    if (outcome.digits == 1) answer.answer = together < alone ? "fewer together" : "more together";
  }
  return answer;
}

// "most with joint, fewest with common" of the estimated means of a factor's levels.
std::string extremes(const Finding& finding, const std::string& factor, Answer& answer) {
  const auto* table = table_of(finding, "Estimated marginal means of " + factor);
  if (table == nullptr) return "yes";
  std::string least_name, most_name;
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const auto& row : rows_of(*table)) {
    const auto value = row.number("mean");
    if (!value) continue;
    if (*value < least) {
      least = *value;
      least_name = row.label();
    }
    if (*value > most) {
      most = *value;
      most_name = row.label();
    }
  }
  if (!(least <= most)) return "yes";
  answer.means = rounded_text(least, answer.digits) + " to " + rounded_text(most, answer.digits);
  return "yes: lowest " + least_name + ", highest " + most_name;
}

// A factor with many levels: the largest difference if there is one, else how large one may be.
std::optional<Answer> answer_about(const FirstScreen& screen, const Outcome& outcome, const std::string& factor,
                                   const std::string& question) {
  const auto* finding = finding_of(screen, outcome.id);
  if (finding == nullptr) return std::nullopt;
  Answer answer{question, outcome.name, outcome.digits, finding->id};
  answer.p = p_of_term(*finding, factor);
  if (!answer.p) return std::nullopt;
  const auto ends = extremes(*finding, factor, answer);
  answer.answer = is_shown(answer) ? ends : "no difference found";
  const auto* pairs = table_of(*finding, "Pairs of " + factor);
  if (pairs == nullptr) return answer;
  double largest = -1.0, bound = 0.0;
  for (const auto& row : rows_of(*pairs)) {
    const auto ratio = row.number("ratio");
    const auto estimate = ratio ? ratio : row.number("difference");
    const auto low = row.number("lower_limit"), high = row.number("upper_limit");
    if (!estimate || !low || !high || (ratio && *low <= 0.0)) continue;
    answer.is_ratio = ratio.has_value();
    const auto size = [&](double value) { return std::abs(ratio ? std::log(value) : value); };
    bound = std::max({bound, size(*low), size(*high)});
    if (size(*estimate) <= largest) continue;
    largest = size(*estimate);
    answer.compared = row.label();
    answer.estimate = estimate;
    answer.low = low;
    answer.high = high;
  }
  if (is_shown(answer) || largest < 0.0) return answer;
  answer.estimate = answer.low = answer.high = std::nullopt;
  answer.bound = answer.is_ratio ? std::exp(bound) : bound;
  answer.compared.clear();
  return answer;
}

std::vector<Answer> planned(const FirstScreen& screen) {
  std::vector<Answer> list;
  const auto* finding = finding_of(screen, "primary");
  if (finding == nullptr) return list;
  for (const auto& row : rows_of(finding->tables.front())) {
    Answer answer{finding->title, row.label(), row.label().find("periods") == 0 ? 1 : 2, finding->id};
    answer.estimate = row.number("difference");
    answer.low = row.number("lower_limit");
    answer.high = row.number("upper_limit");
    answer.p = row.p();
    answer.answer = !answer.p ? "not tested" : is_shown(answer) ? "yes" : "no difference found";
    list.push_back(std::move(answer));
  }
  return list;
}

std::size_t num_together(const FirstScreen& screen) {
  std::set<std::string> strategies;
  for (const auto& series : screen.design.series) {
    if (series.strategy != kBaseline) strategies.insert(series.strategy);
  }
  return strategies.size();
}

// Means, where there is nothing to compare.
std::vector<Answer> plain_means(const FirstScreen& screen) {
  std::vector<Answer> list;
  for (const bool alone : {false, true}) {
    for (const auto& outcome : outcomes_of(screen)) {
      const auto values = values_of(screen, outcome, alone);
      if (values.empty()) continue;
      Answer answer{alone ? "Taught one after the other" : "Taught together", outcome.name, outcome.digits};
      answer.means = rounded_text(mean(values), outcome.digits);
      const auto interval = mean_interval(values);
      answer.estimate = mean(values);
      if (interval) {
        answer.low = interval->low;
        answer.high = interval->high;
      }
      list.push_back(std::move(answer));
    }
  }
  return list;
}

std::vector<Answer> all_answers(const FirstScreen& screen) {
  auto list = planned(screen);
  const auto outcomes = outcomes_of(screen);
  if (compares_with_alone(screen)) {
    for (const auto& outcome : outcomes) list.push_back(answer_about_alone(screen, outcome));
  }
  const auto add = [&](const std::string& factor, const std::string& question) {
    for (const auto& outcome : outcomes) {
      if (auto answer = answer_about(screen, outcome, factor, question)) list.push_back(*std::move(answer));
    }
  };
  add("strategy", "Among the " + std::to_string(num_together(screen)) + " strategies for a team");
  add("composition", "Who is in the team");
  return list.empty() ? plain_means(screen) : list;
}

// "takes 49 % fewer periods".
std::string change_text(double together, double alone) {
  const double change = alone > 0.0 ? (together - alone) / alone : 0.0;
  return std::to_string(std::llround(100.0 * std::abs(change))) + " % " + (change < 0.0 ? "fewer" : "more");
}

std::string headline_about_alone(const FirstScreen& screen) {
  const auto mean_of = [&](const Outcome& outcome, bool alone) { return mean(values_of(screen, outcome, alone)); };
  const auto periods = answer_about_alone(screen, kPeriods), people = answer_about_alone(screen, kPersonPeriods);
  const double together = mean_of(kPeriods, false), alone = mean_of(kPeriods, true);
  std::string text = "Teaching a team together takes ";
  text += is_shown(periods) ? change_text(together, alone) + " periods than"
                            : "no detectably different number of periods from";
  text += " one after the other";
  if (is_shown(people)) {
    const double both = mean_of(kPersonPeriods, false), single = mean_of(kPersonPeriods, true);
    const bool opposed = is_shown(periods) && (both < single) != (together < alone);
    text += (opposed ? ", but " : " and ") + change_text(both, single) + " person-periods";
  }
  return text;
}

std::string headline_about(const FirstScreen& screen, const std::string& factor, const std::string& levels) {
  const auto periods = answer_about(screen, kPeriods, factor, "");
  const auto knowledge = answer_about(screen, known(screen), factor, "");
  if (!periods && !knowledge) return "";
  const bool on_periods = periods && is_shown(*periods), on_knowledge = knowledge && is_shown(*knowledge);
  const auto name = known(screen).name;
  if (on_periods && on_knowledge) return levels + " differ in periods and in " + name;
  if (on_periods) return levels + " differ in periods, but not detectably in " + name;
  if (on_knowledge) return levels + " differ in " + name + ", but not detectably in periods";
  return "no difference between " + levels + " was found";
}

std::string capitalised(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

std::size_t num_completed(const FirstScreen& screen) {
  return static_cast<std::size_t>(std::count_if(screen.data.teams.begin(), screen.data.teams.end(),
                                                [](const auto& team) { return team.completed; }));
}

std::string number_of(std::size_t n, const std::string& one) {
  return std::to_string(n) + " " + one + (n == 1 ? "" : "s");
}

Json difference_json(const Values& values, const Values& reference, bool paired) {
  const auto test = paired ? paired_t_test(values, reference) : welch_t_test(values, reference);
  Json json{{"estimate", number(mean(values) - mean(reference))}, {"low", nullptr}, {"high", nullptr}};
  if (test) {
    json["low"] = number(test->low);
    json["high"] = number(test->high);
  }
  json["n"] = values.size();
  return json;
}

// The values of the teams of a level, in the order of people: those of the same composition and replicate are one
// group.
using Level = std::map<std::pair<std::string, std::size_t>, std::size_t>;

Json difference_of(const FirstScreen& screen, const Outcome& outcome, const Level& level, const Level& reference,
                   bool paired) {
  Values values, others;
  for (const auto& [people, team] : level) {
    const auto other = reference.find(people);
    if (paired && other == reference.end()) continue;
    values.push_back(screen.data.teams[team].*outcome.value);
    if (paired) others.push_back(screen.data.teams[other->second].*outcome.value);
  }
  if (!paired) {
    for (const auto& [people, team] : reference) others.push_back(screen.data.teams[team].*outcome.value);
  }
  const auto missing = [](double value) { return !std::isfinite(value); };
  if (values.empty() || others.empty() || std::any_of(values.begin(), values.end(), missing) ||
      std::any_of(others.begin(), others.end(), missing)) {
    return {{"estimate", nullptr}, {"low", nullptr}, {"high", nullptr}, {"n", values.size()}};
  }
  return difference_json(values, others, paired);
}

Json strategy_differences(const FirstScreen& screen, const std::vector<Outcome>& outcomes) {
  const auto& series = screen.design.series;
  std::vector<Level> levels(series.size());
  for (std::size_t i = 0; i < screen.data.teams.size(); ++i) {
    const auto of = screen.design.cells[screen.design.cell_of_team[i]].series;
    levels[of][{composition_of(screen, i), screen.data.teams[i].replicate}] = i;
  }
  // Each is compared with teaching alone at the same setting, or with the first strategy there, or else with the first.
  const auto reference_of = [&](std::size_t s) {
    std::size_t first = s;
    for (std::size_t r = 0; r < series.size(); ++r) {
      if (series[r].variant != series[s].variant) continue;
      if (series[r].strategy == kBaseline) return r;
      first = std::min(first, r);
    }
    return first == s && num_together(screen) == 1 ? std::size_t{0} : first;
  };
  Json rows = Json::array();
  std::set<std::string> against;
  for (std::size_t s = 0; s < series.size(); ++s) {
    const auto reference = reference_of(s);
    if (reference == s) continue;
    against.insert(num_together(screen) == 1 && series[reference].strategy != kBaseline ? series[reference].code
                                                                                        : series[reference].strategy);
    Json differences = Json::array();
    const bool paired = screen.paired && series[reference].variant == series[s].variant;
    for (const auto& outcome : outcomes)
      differences.push_back(difference_of(screen, outcome, levels[s], levels[reference], paired));
    rows.push_back({{"code", series[s].code}, {"differences", std::move(differences)}});
  }
  if (rows.empty()) return nullptr;
  return {{"factor", "strategy"}, {"against", *against.begin()}, {"rows", std::move(rows)}};
}

Json composition_differences(const FirstScreen& screen, const std::vector<Outcome>& outcomes) {
  std::vector<std::string> codes;
  for (const auto& cell : screen.design.cells) {
    if (std::find(codes.begin(), codes.end(), cell.composition) == codes.end()) codes.push_back(cell.composition);
  }
  // A group of people counts once, with its mean over strategies.
  const auto values_in = [&](const std::string& code, const Outcome& outcome) {
    std::map<std::pair<std::size_t, std::size_t>, Values> people;
    for (std::size_t i = 0; i < screen.data.teams.size(); ++i) {
      const double value = screen.data.teams[i].*outcome.value;
      if (composition_of(screen, i) != code || !std::isfinite(value)) continue;
      if (is_alone(screen, i) && compares_with_alone(screen)) continue;
      const auto group = screen.paired ? screen.data.teams[i].replicate : i;
      people[{screen.paired ? series_of(screen, i).variant : 0, group}].push_back(value);
    }
    Values means;
    for (const auto& [key, values] : people) means.push_back(mean(values));
    return means;
  };
  Json rows = Json::array();
  for (std::size_t c = 1; c < codes.size(); ++c) {
    Json differences = Json::array();
    for (const auto& outcome : outcomes) {
      const auto values = values_in(codes[c], outcome), first = values_in(codes.front(), outcome);
      differences.push_back(values.empty() || first.empty()
                                ? Json{{"estimate", nullptr}, {"low", nullptr}, {"high", nullptr}, {"n", 0}}
                                : difference_json(values, first, false));
    }
    rows.push_back({{"code", codes[c]}, {"differences", std::move(differences)}});
  }
  if (rows.empty()) return nullptr;
  return {{"factor", "composition"}, {"against", codes.front()}, {"rows", std::move(rows)}};
}

}  // namespace

std::string headline(const FirstScreen& screen) {
  std::vector<std::string> parts;
  if (compares_with_alone(screen)) parts.push_back(headline_about_alone(screen));
  const auto hypotheses = planned(screen);
  if (!hypotheses.empty()) {
    const auto shown = static_cast<std::size_t>(std::count_if(hypotheses.begin(), hypotheses.end(), is_shown));
    parts.push_back(std::to_string(shown) + " of " + number_of(hypotheses.size(), "planned difference") +
                    (shown == 1 ? " was found" : " were found"));
  }
  const auto strategies = num_together(screen);
  if (auto text = headline_about(screen, "strategy", "the " + std::to_string(strategies) + " strategies");
      strategies > 1 && !text.empty())
    parts.push_back(std::move(text));
  if (parts.empty()) {
    if (auto text = headline_about(screen, "composition", "compositions of the team"); !text.empty())
      parts.push_back(std::move(text));
  }
  if (parts.empty()) {
    const auto periods = values_of(screen, kPeriods, num_together(screen) == 0);
    if (periods.empty()) return "Nothing was taught";
    parts.push_back((num_together(screen) == 0 ? "members taught one after the other needed " : "teams needed ") +
                    rounded_text(mean(periods), 1) + " periods on average, and " +
                    std::to_string(num_completed(screen)) + " of " + std::to_string(screen.data.teams.size()) +
                    " passed all tests");
  }
  std::string text;
  for (const auto& part : parts) text += (text.empty() ? "" : "; ") + part;
  return capitalised(text);
}

Json answers(const FirstScreen& screen) {
  Json list = Json::array();
  for (const auto& one : all_answers(screen)) {
    list.push_back({{"question", one.question},
                    {"outcome", one.outcome},
                    {"means", one.means},
                    {"compared", one.compared},
                    {"estimate", number(one.estimate)},
                    {"low", number(one.low)},
                    {"high", number(one.high)},
                    {"bound", number(one.bound)},
                    {"ratio", one.is_ratio},
                    {"digits", one.digits},
                    {"p", number(one.p)},
                    {"answer", one.answer},
                    {"finding", one.finding}});
  }
  return list;
}

Json differences(const FirstScreen& screen) {
  const auto outcomes = outcomes_of(screen);
  Json groups = Json::array();
  for (auto group : {strategy_differences(screen, outcomes), composition_differences(screen, outcomes)}) {
    if (!group.is_null()) groups.push_back(std::move(group));
  }
  if (groups.empty()) return nullptr;
  Json names = Json::array();
  for (const auto& outcome : outcomes)
    names.push_back({{"name", capitalised(outcome.name)}, {"digits", outcome.digits}});
  return {{"interval", screen.paired ? "t intervals of differences within the same people" : "Welch's t intervals"},
          {"outcomes", std::move(names)},
          {"groups", std::move(groups)}};
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
    means += rounded_text(mean(values), 2);
    if (compares_with_alone(screen)) means += alone ? " one after the other" : " together";
  }
  if (!means.empty()) {
    list.push_back(
        "Passing all tests is not knowing everything: " + std::to_string(num_completed(screen)) + " of " +
        number_of(teams.size(), "team") + " passed (by the rule of mastery), while " +
        (screen.data.leads_with_exam
             ? "the share of starts from which members predict the robot correctly is "
             : "the share of a member's belief under which the robot would act as it does everywhere (knowledge) is ") +
        means + " on average.");
  }
  if (compares_with_alone(screen)) {
    const auto count = [&](bool alone) {
      return rounded_text(mean(values_of(screen, kPeriods, alone)), 1) + " periods are " +
             rounded_text(mean(values_of(screen, kPersonPeriods, alone)), 1) + " person-periods";
    };
    list.push_back("A period of a team takes the time of everybody in it: together, " + count(false) +
                   "; one after the other, " + count(true) + ".");
  }
  const auto all = all_answers(screen);
  if (std::any_of(all.begin(), all.end(), [](const auto& one) { return one.bound.has_value(); })) {
    list.push_back(
        "\"No difference found\" does not say that there is none. The table gives how large one may still be.");
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
    std::string text;
    for (const auto& [letter, count] : counts) {
      const auto found = types.find(letter);
      text += (text.empty() ? "" : ", ") + std::to_string(count) + " " +
              (found == types.end() || found->second.empty() ? std::string{letter} : found->second);
    }
    compositions[cell.composition] = text;
  }
  return {{"strategies", std::move(strategies)}, {"compositions", std::move(compositions)}};
}

}  // namespace kith::detail
