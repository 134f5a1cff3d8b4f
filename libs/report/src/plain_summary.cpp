#include "plain_summary.hpp"

#include <cmath>
#include <set>

#include "kith/analysis/analysis.hpp"
#include "kith/stats/moments.hpp"

namespace kith::detail {
namespace {

// With that many decimals.
std::string rounded_text(double value, int decimals) {
  const double scale = std::pow(10.0, decimals);
  auto digits = std::to_string(std::llround(std::abs(value) * scale));
  const auto fraction = static_cast<std::size_t>(decimals);
  if (digits.size() <= fraction) digits.insert(0, fraction + 1 - digits.size(), '0');
  if (fraction > 0) digits.insert(digits.size() - fraction, ".");
  return (value < 0.0 ? "-" : "") + digits;
}

std::string number_of(std::size_t n, const std::string& one, const std::string& many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

std::string simulated(const RunFiles& run, const RunData& data) {
  std::set<std::size_t> sizes;
  for (const auto& composition : run.spec().compositions) sizes.insert(composition.size());
  auto people = std::to_string(*sizes.begin());
  if (sizes.size() > 1) people += " to " + std::to_string(*sizes.rbegin());
  return "The study simulated " + number_of(data.teams.size(), "team", "teams") + " of " + people +
         (sizes == std::set<std::size_t>{1} ? " person" : " people") +
         " who learned how a robot decides by watching what it does, and compared " +
         number_of(run.spec().strategies.size(), "way of teaching them.", "ways of teaching them.");
}

// What teams needed and knew, of those taught together or of those taught alone.
struct Outcome {
  std::vector<double> periods;
  std::vector<double> knowledge;  // share right in the exam where that leads
};

std::string outcome_text(const Outcome& outcome) {
  return rounded_text(mean(outcome.periods), 1) + " teaching periods on average";
}

std::string together_or_alone(const ReportDesign& design, const RunData& data) {
  Outcome together, alone;
  for (std::size_t i = 0; i < data.teams.size(); ++i) {
    const auto& series = design.series[design.cells[design.cell_of_team[i]].series];
    auto& outcome = series.strategy == kBaseline ? alone : together;
    outcome.periods.push_back(data.teams[i].periods);
    outcome.knowledge.push_back(data.leads_with_exam ? data.teams[i].exam_share_right : data.teams[i].knowledge);
  }
  const std::string scale = data.leads_with_exam ? "" : " (0: nothing, 1: everything)";
  const std::string known = data.leads_with_exam
                                ? "the share of starts from which they predicted the robot correctly at "
                                  "the end was "
                                : "their knowledge at the end was ";
  const auto knowledge = [](const Outcome& outcome) { return rounded_text(mean(outcome.knowledge), 2); };
  if (together.periods.empty()) {
    return "Teaching every member alone took " + outcome_text(alone) + " per team, and " + known + knowledge(alone) +
           scale + ".";
  }
  if (alone.periods.empty()) {
    return "Teams taught together needed " + outcome_text(together) + ", and " + known + knowledge(together) + scale +
           ".";
  }
  return "Teams taught together needed " + outcome_text(together) + ", teams whose members were taught one after the " +
         "other " + rounded_text(mean(alone.periods), 1) + "; " + known + knowledge(together) + " and " +
         knowledge(alone) + scale + ".";
}

// The p-value of a term in the first table of a finding.
std::optional<double> p_value(const Analysis& analysis, const std::string& id, const std::string& term) {
  for (const auto& finding : analysis.findings) {
    if (finding.id != id || finding.tables.empty()) continue;
    const auto& table = finding.tables.front();
    for (const auto& row : table.rows) {
      const auto* const name = std::get_if<std::string>(&row.front());
      if (name == nullptr || *name != term) continue;
      for (std::size_t c = 0; c < row.size(); ++c) {
        const auto* const p = std::get_if<double>(&row[c]);
        if (table.columns[c].kind == ResultKind::kP && p != nullptr) return *p;
      }
    }
  }
  return std::nullopt;
}

// "affected the number of periods; no effect on knowledge was found"; nothing if it was not tested.
std::string effect_of(const Analysis& analysis, const std::string& term, bool leads_with_exam) {
  const double alpha = AnalysisOptions{}.alpha;
  const auto periods = p_value(analysis, "periods", term);
  const auto knowledge = p_value(analysis, leads_with_exam ? "exam_regret" : "knowledge", term);
  const std::string known = leads_with_exam ? "regret in the exam" : "knowledge";
  if (!periods && !knowledge) return "";
  const bool on_periods = periods && *periods < alpha, on_knowledge = knowledge && *knowledge < alpha;
  if (on_periods && on_knowledge) return "affected both the number of periods and " + known;
  if (on_periods) return "affected the number of periods, with no detectable effect on " + known;
  if (on_knowledge) return "affected " + known + ", with no detectable effect on the number of periods";
  return "made no detectable difference";
}

// What became of the hypotheses; nothing if the study file marks no contrast as primary.
std::string hypotheses(const Analysis& analysis) {
  std::string found, missed;
  for (const auto& finding : analysis.findings) {
    if (finding.id != "primary") continue;
    for (const auto& row : finding.tables.front().rows) {
      const auto* const p = std::get_if<double>(&row.back());
      auto& list = p != nullptr && *p < AnalysisOptions{}.alpha ? found : missed;
      list += (list.empty() ? "" : "; ") + std::get<std::string>(row.front());
    }
  }
  if (found.empty() && missed.empty()) return "";
  return "Comparisons that the study was planned to make, which alone are its hypotheses: " +
         (found.empty() ? "none showed a difference" : "there is a difference in " + found) +
         (missed.empty() || found.empty() ? "" : ", and none was found in " + missed) + ".";
}

std::string differences(const RunFiles& run, const ReportDesign& design, const RunData& data,
                        const Analysis& analysis) {
  std::set<std::string> strategies;
  for (const auto& series : design.series) {
    if (series.strategy != kBaseline) strategies.insert(series.strategy);
  }
  const auto strategy = effect_of(analysis, "strategy", data.leads_with_exam);
  const auto composition = effect_of(analysis, "composition", data.leads_with_exam);
  std::string text;
  if (!strategy.empty()) {
    text = "Which of the " + std::to_string(strategies.size()) + " strategies for teaching a team together was used " +
           strategy;
  }
  if (!composition.empty()) {
    text += std::string{text.empty() ? "Who" : "; who"} + " was in a team (" +
            number_of(run.spec().compositions.size(), "composition", "compositions") + ") " + composition;
  }
  return text.empty() ? text : text + ".";
}

}  // namespace

Json plain_summary(const RunFiles& run, const ReportDesign& design, const RunData& data, const Analysis& analysis) {
  Json sentences = Json::array({simulated(run, data), together_or_alone(design, data)});
  if (auto text = hypotheses(analysis); !text.empty()) sentences.push_back(std::move(text));
  if (auto text = differences(run, design, data, analysis); !text.empty()) sentences.push_back(std::move(text));
  return sentences;
}

}  // namespace kith::detail
