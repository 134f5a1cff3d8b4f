#include "study_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace kith::cli {
namespace {

std::string mean_sd_text(const MeanSd& value, int digits) {
  if (!value.sd) return fmt::format("{:.{}f}", value.mean, digits);
  return fmt::format("{:.{}f} ({:.{}f})", value.mean, digits, *value.sd, digits);
}

// What the columns after the keys are.
enum class Figures {
  kKnowledge,
  kExam,        // exam at the end
  kExamBefore,  // and before the first lesson
};

Figures figures_of(std::size_t num_features, const StudySummary& summary) {
  const auto all_have = [&](std::optional<MeanSd> CellSummary::*value) {
    return std::ranges::all_of(summary.cells, [&](const auto& cell) { return (cell.*value).has_value(); });
  };
  if (num_features <= 3 || !all_have(&CellSummary::regret)) return Figures::kKnowledge;
  return all_have(&CellSummary::regret_before) ? Figures::kExamBefore : Figures::kExam;
}

bool has_skipped(const StudySummary& summary) {
  return std::any_of(summary.cells.begin(), summary.cells.end(), [](const auto& cell) { return cell.skipped > 0; });
}

std::vector<std::string> header_of(Figures figures, bool with_skipped) {
  std::vector<std::string> names{"teams", "completed", "periods"};
  if (with_skipped) names.insert(names.begin() + 2, "skipped");
  if (figures == Figures::kKnowledge) {
    names.insert(names.end(), {"knowledge", "area/sr"});
    return names;
  }
  names.insert(names.end(), {"regret", "share right", "worst member"});
  if (figures == Figures::kExamBefore) names.insert(names.end() - 3, "regret before");
  return names;
}

void add_row(TextTable& table, std::vector<std::string> keys, const CellSummary& cell, Figures figures,
             bool with_skipped) {
  keys.push_back(fmt::format("{}", cell.teams));
  keys.push_back(fmt::format("{}", cell.completed));
  if (with_skipped) keys.push_back(fmt::format("{}", cell.skipped));
  keys.push_back(mean_sd_text(*cell.periods, 2));
  if (figures == Figures::kKnowledge) {
    for (const auto& value : {cell.knowledge, cell.area_sr}) keys.push_back(mean_sd_text(*value, 3));
  } else {
    if (figures == Figures::kExamBefore) keys.push_back(fmt::format("{:.3f}", cell.regret_before->mean));
    for (const auto& value : {cell.regret, cell.share_right}) keys.push_back(mean_sd_text(*value, 3));
    keys.push_back(fmt::format("{:.3f}", cell.worst_share_right->mean));
  }
  table.add(std::move(keys));
}

// What the figures are, below the table.
std::string table_notes(const StudySummary& summary, Figures figures, const Console& console) {
  std::string text = "\ncells: mean (sd over teams); ";
  if (figures == Figures::kKnowledge) {
    text +=
        "knowledge: the team's mean mass of final belief in the policy's class;\n"
        "area/sr: mean solid angle of the weights that fit one period's lesson, in steradians";
  } else {
    text +=
        "regret: what the members' predictions lose in the exam over all starts,\n"
        "in the units of the domain's weights; share right: starts where they predict the robot correctly;\n"
        "worst member: the smallest share right of a member, averaged over teams";
  }
  if (has_skipped(summary)) {
    text +=
        "\nskipped: teams that did not learn all of a component, because nothing that could be shown conveys the rest";
  }
  if (summary.group) text += "\nall groups: the teams of every strategy but the baseline, together";
  return console.dim(text) + "\n";
}

Json mean_sd_json(const std::optional<MeanSd>& value) {
  return {{"mean", value->mean}, {"sd", value->sd ? Json(*value->sd) : Json{}}};
}

Json group_json(const CellSummary& cell, const Study& study) {
  Json json = Json::object();
  if (cell.strategy) {
    json["strategy"] = *cell.strategy;
    json["composition"] = cell.composition;
    for (const auto& factor : study.variants.at(cell.variant).factors) json["factors"][factor.key] = factor.value;
  }
  json["teams"] = cell.teams;
  json["completed"] = cell.completed;
  json["skipped"] = cell.skipped;
  json["periods"] = mean_sd_json(cell.periods);
  json["knowledge"] = mean_sd_json(cell.knowledge);
  json["area_sr"] = mean_sd_json(cell.area_sr);
  const auto& variants = study.variants;
  if (std::any_of(variants.begin(), variants.end(), has_costs)) {
    json["cost"] = {{"person_periods", mean_sd_json(cell.person_periods)},
                    {"minutes", mean_sd_json(cell.minutes)},
                    {"person_minutes", mean_sd_json(cell.person_minutes)}};
  }
  if (cell.forecast) {
    const auto& ahead = *cell.forecast;
    json["forecast"] = {
        {"periods", {{"mean", ahead.periods}, {"low", ahead.periods_low}, {"high", ahead.periods_high}}},
        {"minutes", {{"mean", ahead.minutes}, {"low", ahead.minutes_low}, {"high", ahead.minutes_high}}}};
  }
  if (cell.regret) {
    json["exam"] = {{"share_right", mean_sd_json(cell.share_right)},
                    {"regret", mean_sd_json(cell.regret)},
                    {"worst_share_right", mean_sd_json(cell.worst_share_right)}};
    if (cell.regret_before) json["exam"]["regret_before"] = mean_sd_json(cell.regret_before);
  }
  return json;
}

}  // namespace

std::string summary_table(const Study& study, std::size_t num_features, const StudySummary& summary,
                          const Console& console) {
  const auto& factors = study.variants.front().factors;
  const auto figures = figures_of(num_features, summary);
  const bool with_skipped = has_skipped(summary);
  const auto names = header_of(figures, with_skipped);
  TextTable table{"ll" + std::string(factors.size(), 'l') + std::string(names.size(), 'r')};
  std::vector<std::string> header{"strategy", "composition"};
  for (const auto& factor : factors) header.push_back(factor.key);
  header.insert(header.end(), names.begin(), names.end());
  table.add(header);
  for (const auto& cell : summary.cells) {
    std::vector<std::string> keys{*cell.strategy, cell.composition};
    for (const auto& factor : study.variants[cell.variant].factors) keys.push_back(factor.value);
    add_row(table, keys, cell, figures, with_skipped);
  }
  std::vector<std::string> all(2 + factors.size());
  if (summary.group) {
    all[0] = "all groups";
    add_row(table, all, *summary.group, figures, with_skipped);
  }
  if (summary.baseline) {
    all[0] = "all baseline";
    add_row(table, all, *summary.baseline, figures, with_skipped);
  }
  return table.text(console) + table_notes(summary, figures, console);
}

Json summary_json(const Study& study, const StudySummary& summary, std::size_t teams,
                  const std::vector<std::string>& failed, double seconds) {
  Json cells = Json::array();
  for (const auto& cell : summary.cells) cells.push_back(group_json(cell, study));
  Json groups = Json::object();
  if (summary.group) groups["group"] = group_json(*summary.group, study);
  if (summary.baseline) groups["baseline"] = group_json(*summary.baseline, study);
  return {{"schema", "kith.study/1"}, {"cells", cells},   {"groups", groups},
          {"teams", teams},           {"failed", failed}, {"seconds", seconds}};
}

}  // namespace kith::cli
