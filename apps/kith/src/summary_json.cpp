#include "summary_json.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "kith/present/json.hpp"

namespace kith::cli {
namespace {

Json mean_sd_json(const MeanSd& value) { return {{"mean", value.mean}, {"sd", value.sd ? Json(*value.sd) : Json{}}}; }

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
  if (cell.exam) {
    json["exam"] = {{"share_right", mean_sd_json(cell.exam->share_right)},
                    {"regret", mean_sd_json(cell.exam->regret)},
                    {"worst_share_right", mean_sd_json(cell.exam->worst_share_right)}};
    if (cell.exam->regret_before) json["exam"]["regret_before"] = mean_sd_json(*cell.exam->regret_before);
  }
  return json;
}

}  // namespace

void print_summary(const Study& study, const StudySummary& summary, std::size_t teams,
                   const std::vector<std::string>& failed, double seconds, Console& console) {
  Json cells = Json::array();
  for (const auto& cell : summary.cells) cells.push_back(group_json(cell, study));
  Json groups = Json::object();
  if (summary.group) groups["group"] = group_json(*summary.group, study);
  if (summary.baseline) groups["baseline"] = group_json(*summary.baseline, study);
  console.print_json(Json{{"schema", "kith.study/1"},
                          {"cells", cells},
                          {"groups", groups},
                          {"teams", teams},
                          {"failed", failed},
                          {"seconds", seconds}});
}

}  // namespace kith::cli
