// What kith bench prints for people.
#include <fmt/format.h>

#include <cmath>

#include "bench_report.hpp"
#include "build_facts.hpp"
#include "kith_build_info.hpp"
#include "machine.hpp"

namespace kith::cli {
namespace {

std::string three_digits(double x) {
  return x < 9.995 ? fmt::format("{:.2f}", x) : x < 99.95 ? fmt::format("{:.1f}", x) : fmt::format("{:.0f}", x);
}

std::string size_text(double size) { return fmt::format("{:.0f}", size); }

std::string heading(const BenchOutcome& outcome) {
  return fmt::format("kith {}, {} {}\n{}, {} cores, {} threads, load {:.1f} before and {:.1f} after\n\n",
                     program_name(), build_info::kCompiler, build_info::kBuildType, processor_name(), usable_cores(),
                     outcome.threads, outcome.load_before, outcome.load_after);
}

std::string case_table(const BenchOutcome& outcome, const Console& console) {
  TextTable table{"lrrrrrl"};
  table.add({"case", "time", "+-", "rival", "ratio", outcome.baseline != nullptr ? "baseline" : "", ""});
  for (const auto& one : outcome.result.cases) {
    const auto& figure = one.figure();
    const auto rival = one.rival();
    const auto* before = baseline_of(outcome, one);
    const bool slower = before != nullptr && is_slower(figure, *before, outcome.tolerance);
    table.add({one.which->name, seconds_text(figure.median), fmt::format("{:.1f} %", 100.0 * figure.spread()),
               rival ? seconds_text(rival->median) : "", rival ? "x " + three_digits(*one.ratio()) : "",
               before != nullptr ? "x " + three_digits(figure.median / before->median) : "", slower ? "slower" : ""});
  }
  return table.text(console);
}

std::string growth_text(const bench::GrowthResult& growth, const Console& console) {
  std::vector<std::string> sizes{growth.which->size}, costs{"time"};
  TextTable table{"l" + std::string(growth.figures.size(), 'r')};
  for (std::size_t i = 0; i < growth.figures.size(); ++i) {
    sizes.push_back(size_text(growth.which->points[i].size));
    costs.push_back(seconds_text(growth.figures[i].median));
  }
  table.add(std::move(sizes));
  table.add(std::move(costs));
  return fmt::format("{}: {}; grows like {}^{:.2f}\n", growth.which->name, growth.which->what, growth.which->size,
                     growth.exponent) +
         table.text(console, false) + "\n";
}

}  // namespace

std::string seconds_text(double seconds) {
  constexpr double kUp = 0.9995;  // what would be rounded to 1000 has the next unit
  if (seconds < kUp * 1e-6) return three_digits(seconds * 1e9) + " ns";
  if (seconds < kUp * 1e-3) return three_digits(seconds * 1e6) + " us";
  if (seconds < kUp) return three_digits(seconds * 1e3) + " ms";
  return three_digits(seconds) + " s";
}

std::string bench_text(const BenchOutcome& outcome, const Console& console) {
  std::string text = heading(outcome);
  for (const auto& growth : outcome.result.growths) text += growth_text(growth, console);
  if (outcome.result.cases.empty()) return text;
  text += case_table(outcome, console);
  text += console.dim(
      fmt::format("\nMedians; +-: half the interquartile range. Studies: wall time; others: CPU time of one thread.\n"
                  "Ratio: the rival's time over kith's. Peak memory, rivals included: {:.0f} MiB. For the rivals: kith "
                  "bench --list\n",
                  peak_memory_mib()));
  return text;
}

std::string bench_list_text(const Console& console) {
  TextTable table{"lll"};
  table.add({"case", "what is timed", "rival"});
  for (const auto& one : bench::all_cases()) table.add({one.name, one.what, one.rival});
  TextTable growths{"lll"};
  growths.add({"with --growth", "what is timed", "by"});
  for (const auto& one : bench::all_growths()) growths.add({one.name, one.what, one.size});
  return table.text(console) + "\n" + growths.text(console);
}

}  // namespace kith::cli
