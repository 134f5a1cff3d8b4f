#include "planning_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "input.hpp"
#include "interrupt.hpp"
#include "kith/core/error.hpp"

namespace kith::cli {

void check_single_variant(const std::string& name, const Study& study) {
  if (study.variants.size() == 1 && study.variants.front().factors.empty()) return;
  throw Error{{Diagnostic{
      .id = "E0812", .message = "this study varies parameters", .file = name, .hint = "remove design.vary"}}};
}

std::string duration_text(double seconds) {
  constexpr double kMinute = 60.0, kHour = 3600.0, kShort = 1.0, kFew = 1.5;
  if (seconds < kShort) return "less than a second";
  if (seconds < kFew * kMinute) return fmt::format("about {:.0f} s", seconds);
  if (seconds < kFew * kHour) return fmt::format("about {:.0f} min", seconds / kMinute);
  return fmt::format("about {:.1f} h", seconds / kHour);
}

Trial try_cells(const Atlas& atlas, const StudySpec& spec, std::size_t threads) {
  Study probe{{spec}};
  probe.variants.front().replicates = 1;
  probe.variants.front().record = RecordLevel::kTeam;
  const auto addresses = team_addresses(probe);
  const auto begin = std::chrono::steady_clock::now();
  const auto stopped = [](std::size_t, std::size_t) { return stop_signal() == 0; };
  auto tried = run_teams(atlas, probe, addresses, {.threads = threads, .on_progress = stopped});
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  return {took.count() / static_cast<double>(addresses.size()), std::move(tried.teams)};
}

std::string work_text(const Trial& trial, std::size_t teams) {
  return fmt::format("simulating {} teams takes {}", teams,
                     duration_text(trial.seconds_per_team * static_cast<double>(teams)));
}

std::string items_text(const Trial& trial, const StudySpec& spec) {
  std::string text;
  for (const auto& strategy : spec.strategies) {
    std::size_t fewest = SIZE_MAX, most = 0;
    for (const auto& team : trial.teams) {
      if (team.address.strategy != strategy.name) continue;
      fewest = std::min(fewest, team.demonstrations + team.tests);
      most = std::max(most, team.demonstrations + team.tests);
    }
    if (most == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", strategy.name, fewest);
    if (most > fewest) text += fmt::format(" to {}", most);
  }
  return "demonstrations and tests of a session, in a team of every composition: " + text;
}

std::vector<PublishedFinding> findings_of(const std::string& file, const StudySpec& spec) {
  const auto input = read_input(file);
  auto reading = parse_findings(input.text, input.name, spec);
  if (!reading.findings) throw Error{reading.diagnostics};
  return *std::move(reading.findings);
}

}  // namespace kith::cli
