#include "summary_table.hpp"

#include <fmt/format.h>

#include <vector>

namespace kith::cli {
namespace {

std::string mean_sd_text(const MeanSd& value, int digits) {
  if (!value.sd) return fmt::format("{:.{}f}", value.mean, digits);
  return fmt::format("{:.{}f} ({:.{}f})", value.mean, digits, *value.sd, digits);
}

void add_row(TextTable& table, std::vector<std::string> keys, const CellSummary& cell) {
  keys.push_back(fmt::format("{}", cell.teams));
  keys.push_back(fmt::format("{}", cell.completed));
  keys.push_back(mean_sd_text(cell.periods, 2));
  keys.push_back(mean_sd_text(cell.knowledge, 3));
  keys.push_back(mean_sd_text(cell.area_sr, 3));
  table.add(std::move(keys));
}

// What the figures are, below the table.
std::string table_notes(const StudySummary& summary, const Console& console) {
  std::string text =
      "\ncells: mean (sd over teams); knowledge: the team's mean mass of final belief in the policy's class;\n"
      "area/sr: mean solid angle of the weights that fit one period's lesson, in steradians";
  if (summary.group) text += "\nall groups: the teams of every strategy but the baseline, together";
  return console.dim(text) + "\n";
}

}  // namespace

std::string summary_table(const Study& study, const StudySummary& summary, const Console& console) {
  const auto& factors = study.variants.front().factors;
  TextTable table{"ll" + std::string(factors.size(), 'l') + "rrrrr"};
  std::vector<std::string> header{"strategy", "composition"};
  for (const auto& factor : factors) header.push_back(factor.key);
  for (const auto* name : {"teams", "completed", "periods", "knowledge", "area/sr"}) header.emplace_back(name);
  table.add(header);
  for (const auto& cell : summary.cells) {
    std::vector<std::string> keys{*cell.strategy, cell.composition};
    for (const auto& factor : study.variants[cell.variant].factors) keys.push_back(factor.value);
    add_row(table, keys, cell);
  }
  std::vector<std::string> all(2 + factors.size());
  if (summary.group) {
    all[0] = "all groups";
    add_row(table, all, *summary.group);
  }
  if (summary.baseline) {
    all[0] = "all baseline";
    add_row(table, all, *summary.baseline);
  }
  return table.text(console) + table_notes(summary, console);
}

}  // namespace kith::cli
