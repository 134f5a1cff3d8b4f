#include "planning_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <system_error>

#include "input.hpp"
#include "interrupt.hpp"
#include "kith/core/error.hpp"
#include "kith/study/study.hpp"

namespace kith::cli {

void check_single_variant(const std::string& name, const Study& study) {
  if (study.variants.size() == 1 && study.variants.front().factors.empty()) return;
  throw Error{{Diagnostic{
      .id = "E0812", .message = "this study varies parameters", .file = name, .hint = "remove design.vary"}}};
}

std::string duration_text(double seconds) {
  constexpr double kMinute = 60.0, kHour = 3600.0, kShort = 1.0, kFew = 1.5;
  if (seconds < kShort) return "less than a second";
  if (seconds < kFew * kMinute) return fmt::format("{:.0f} s", seconds);
  if (seconds < kFew * kHour) return fmt::format("{:.0f} min", seconds / kMinute);
  return fmt::format("{:.1f} h", seconds / kHour);
}

std::string work_text(const Atlas& atlas, const StudySpec& spec, std::size_t threads, std::size_t teams) {
  Study probe{{spec}};
  probe.variants.front().replicates = 1;
  probe.variants.front().record = RecordLevel::kTeam;
  const auto addresses = team_addresses(probe);
  const auto begin = std::chrono::steady_clock::now();
  const auto stopped = [](std::size_t, std::size_t) { return stop_signal() == 0; };
  (void)run_teams(atlas, probe, addresses, {.threads = threads, .on_progress = stopped});
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  const double seconds = took.count() * static_cast<double>(teams) / static_cast<double>(addresses.size());
  return fmt::format("simulating {} teams takes {}{}", teams, seconds < 1.0 ? "" : "about ", duration_text(seconds));
}

std::vector<PublishedFinding> findings_of(const std::string& file, const StudySpec& spec) {
  const auto input = read_input(file);
  auto reading = parse_findings(input.text, input.name, spec);
  if (!reading.findings) throw Error{reading.diagnostics};
  return *std::move(reading.findings);
}

}  // namespace kith::cli
