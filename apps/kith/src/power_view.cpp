#include "power_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "kith/core/text.hpp"

namespace kith::cli {
namespace {

std::string size_text(const Effect& effect, double size) {
  const auto* const how = effect.imposed ? "imposed" : "as simulated";
  if (effect.kind == Effect::Kind::kContrast) return fmt::format("difference {:.3g} {}", size, how);
  return fmt::format("partial eta squared {:.2g} {}", size, how);
}

std::string needed_text(const PowerCurve& curve, const PowerOptions& options) {
  const auto& needed = curve.needed;
  const auto largest = options.teams.back();
  std::string text;
  if (!needed.estimate) {
    text = fmt::format("power {:g} needs more than {} teams per cell", options.target, largest);
    if (needed.low) text += fmt::format(" (at least {:.0f})", std::ceil(*needed.low));
  } else {
    const bool smallest = *needed.estimate <= static_cast<double>(options.teams.front());
    text = fmt::format("power {:g} {} {:.0f} teams per cell", options.target,
                       smallest ? "needs at most" : "needs at least", std::ceil(*needed.estimate));
    if (!smallest || !needed.high || *needed.high > *needed.estimate) {
      text += fmt::format(
          " ({:.0f} .. {})", std::ceil(*needed.low),
          needed.high ? fmt::format("{:.0f}", std::ceil(*needed.high)) : fmt::format("more than {}", largest));
    }
  }
  if (needed.analytic) text += fmt::format("; non-central F: {}", *needed.analytic);
  return text;
}

// "0 to 1"
std::string range_text(const EffectCells& cells) {
  return std::isinf(cells.high) ? fmt::format("{:g} or more", cells.low)
                                : fmt::format("{:g} to {:g}", cells.low, cells.high);
}

template <typename T>
Json known(const std::optional<T>& value) {
  return value ? Json(*value) : Json{};
}

Json power_json(const PowerPoint& point) {
  return {{"teams", point.teams}, {"power", point.power},           {"low", point.low},
          {"high", point.high},   {"pool_error", point.pool_error}, {"analytic_power", known(point.analytic_power)}};
}

}  // namespace

std::vector<std::string> assumptions(const StudySpec& spec, bool paired) {
  std::vector<std::string> sentences{
      "Each team contributes one value (knowledge is the mean over its members), so members are not counted as "
      "independent."};
  if (paired) {
    sentences.emplace_back(
        "Every strategy teaches the same people (--paired), so strategies are compared within people: analysis of "
        "variance with the Greenhouse-Geisser correction, and paired t tests. \"By F\" does not apply.");
  } else {
    sentences.emplace_back("Every cell teaches different people, so teams are independent.");
    const bool same = spec.pairing == Pairing::kReplicate && spec.strategies.size() > 1;
    if (same) {
      sentences.emplace_back(
          "The study file has pairing = \"replicate\": to analyse strategies that teach the same people, add "
          "--paired.");
    }
  }
  return sentences;
}

std::string assumptions_text(const StudySpec& spec, bool paired, const Console& console) {
  std::string text = "Assumptions:\n";
  for (const auto& sentence : assumptions(spec, paired)) text += "  " + sentence + "\n";
  return console.dim(text);
}

std::string cells_text(const StudyOutcome& outcome, std::span<const PowerCurve> curves,
                       std::span<const EffectCells> cells, const Console& console) {
  std::vector<std::string> head{"strategy", "composition", "mean", "sd"};
  std::vector<std::vector<std::string>> rows;
  std::string notes, range;
  std::size_t imposed = 0;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const auto& effect = curves[i].effect;
    if (effect.outcome != &outcome) continue;
    range = range_text(cells[i]);
    if (effect.imposed) {
      ++imposed;
      head.push_back(fmt::format("imposed {}", imposed));
      notes += fmt::format("imposed {}: {}\n", imposed, to_string(effect));
    }
    for (const auto& cell : cells[i].cells) {
      const auto known = std::find_if(rows.begin(), rows.end(), [&](const auto& row) {
        return row[0] == cell.strategy && row[1] == cell.composition;
      });
      auto& row =
          known == rows.end()
              ? rows.emplace_back(std::vector<std::string>{
                    cell.strategy, cell.composition, fmt::format("{:.4g}", cell.mean), fmt::format("{:.3g}", cell.sd)})
              : *known;
      if (!cell.imposed) continue;
      row.resize(head.size() - 1);
      row.push_back(fmt::format("{:.4g}", *cell.imposed));
    }
  }
  TextTable table{"ll" + std::string(head.size() - 2, 'r')};
  table.add(head);
  for (auto& row : rows) {
    row.resize(head.size());
    table.add(row);
  }
  return console.bold(std::string{outcome.column} + " of simulated teams") + " (can be " + range + ")\n" +
         table.text(console) + console.dim(notes) + "\n";
}

std::string curve_text(const PowerCurve& curve, const PowerOptions& options, const Console& console) {
  constexpr std::size_t kBarWidth = 40;
  TextTable table{"rrlrl"};
  table.add({"teams", "power", "95 % interval", "by F", "0" + std::string(kBarWidth - 2, ' ') + "1"});
  for (const auto& point : curve.points) {
    std::string bar(kBarWidth, ' ');
    const auto full = static_cast<std::size_t>(std::lround(point.power * static_cast<double>(kBarWidth)));
    std::fill_n(bar.begin(), full, '#');
    const auto wanted = static_cast<std::size_t>(options.target * static_cast<double>(kBarWidth));
    if (wanted >= full) bar[std::min(wanted, kBarWidth - 1)] = ':';
    bar.resize(std::max(full, std::min(wanted, kBarWidth - 1) + 1));
    table.add({fmt::format("{}", point.teams), fmt::format("{:.3f}", point.power),
               fmt::format("{:.2f} .. {:.2f}", point.low, point.high),
               point.analytic_power ? fmt::format("{:.3f}", *point.analytic_power) : "", bar});
  }
  return console.bold(to_string(curve.effect)) + ": " + size_text(curve.effect, curve.size) + "\n" +
         needed_text(curve, options) + "\n" + table.text(console) + "\n";
}

std::string replication_text(const std::vector<PublishedFinding>& findings, const Replication& result,
                             const StudySpec& spec, const Console& console) {
  TextTable table{"llrlrrr"};
  table.add({"finding", "published", "significant", "95 % interval", "eta2", "power by F", "power imposed"});
  for (std::size_t i = 0; i < findings.size(); ++i) {
    const auto& finding = findings[i];
    const auto& outcome = result.findings[i];
    auto published = fmt::format("{}{:g}", finding.significant ? "p < " : "p >= ", finding.alpha);
    if (finding.f) published += fmt::format(", F = {:g}", *finding.f);
    table.add({to_string(finding.effect), published,
               fmt::format("{:.1f} %",
                           100.0 * static_cast<double>(outcome.significant) / static_cast<double>(result.studies)),
               fmt::format("{:.1f} .. {:.1f} %", 100.0 * outcome.low, 100.0 * outcome.high),
               outcome.published_eta_squared ? fmt::format("{:.3f}", *outcome.published_eta_squared) : "",
               outcome.analytic_power ? fmt::format("{:.2f}", *outcome.analytic_power) : "",
               outcome.imposed_power ? fmt::format("{:.2f}", outcome.imposed_power->power) : ""});
  }
  return fmt::format("{} of {} teams per cell, each with people of its own\n", counted(result.studies, "study run"),
                     spec.replicates) +
         table.text(console) +
         console.dim(
             "significant: share of the studies. eta2: partial eta squared of the published F.\n"
             "power: of such a study if this were the true effect, by the non-central F\n"
             "distribution and imposed on simulated teams") +
         fmt::format("\n\nAll findings as published: {} of {} studies; on average {:.1f} of {} findings.\n",
                     result.all_agree, result.studies, result.mean_agreement, findings.size());
}

std::string replication_assumptions(const StudySpec& spec, bool paired, const Console& console) {
  std::string text = "Assumptions:\n  " + assumptions(spec, paired).front() + "\n";
  const bool same = spec.pairing == Pairing::kReplicate && spec.strategies.size() > 1;
  if (same && !paired) {
    text +=
        "  The study teaches the same people with every strategy (pairing = \"replicate\") and the tests treat teams "
        "as\n"
        "  independent, as the published ones do: tests of strategy find too little. Add --paired to test within\n"
        "  people, or --set design.pairing=none to simulate different people.\n";
  } else if (same) {
    text += "  Every strategy teaches the same people; strategies are compared within people.\n";
  } else if (paired) {
    text +=
        "  --paired compares teams of equal number, but this study teaches different people (pairing = \"none\").\n";
  } else {
    text += "  Every cell teaches different people, so teams are independent.\n";
  }
  return console.dim(text);
}

Json curve_json(const PowerCurve& curve, const EffectCells& cells) {
  Json points = Json::array(), means = Json::array();
  for (const auto& cell : cells.cells) {
    means.push_back({{"strategy", cell.strategy},
                     {"composition", cell.composition},
                     {"mean", cell.mean},
                     {"sd", cell.sd},
                     {"imposed", known(cell.imposed)}});
  }
  for (const auto& point : curve.points) points.push_back(power_json(point));
  return {{"effect", to_string(curve.effect)},
          {"imposed", curve.effect.imposed.has_value()},
          {"size", curve.size},
          {"measure", curve.effect.kind == Effect::Kind::kContrast ? "difference" : "partial eta squared"},
          {"points", points},
          {"range", {{"low", cells.low}, {"high", std::isinf(cells.high) ? Json{} : Json(cells.high)}}},
          {"cells", means},
          {"needed",
           {{"estimate", known(curve.needed.estimate)},
            {"low", known(curve.needed.low)},
            {"high", known(curve.needed.high)},
            {"analytic", known(curve.needed.analytic)}}}};
}

Json replication_json(const std::vector<PublishedFinding>& findings, const Replication& result) {
  Json list = Json::array();
  for (std::size_t i = 0; i < findings.size(); ++i) {
    const auto& outcome = result.findings[i];
    list.push_back({{"effect", to_string(findings[i].effect)},
                    {"alpha", findings[i].alpha},
                    {"published_significant", findings[i].significant},
                    {"published_f", known(findings[i].f)},
                    {"significant", outcome.significant},
                    {"low", outcome.low},
                    {"high", outcome.high},
                    {"published_eta_squared", known(outcome.published_eta_squared)},
                    {"analytic_power", known(outcome.analytic_power)},
                    {"imposed_power", outcome.imposed_power ? power_json(*outcome.imposed_power) : Json{}}});
  }
  return {{"studies", result.studies},
          {"findings", list},
          {"all_agree", result.all_agree},
          {"mean_agreement", result.mean_agreement}};
}

}  // namespace kith::cli
