#pragma once

#include <string>
#include <vector>

#include "bench_baseline.hpp"
#include "console.hpp"
#include "kith/present/json.hpp"
#include "suite.hpp"

namespace kith::cli {

/// All that a run of `kith bench` came to.
struct BenchOutcome {
  bench::SuiteResult result;
  bool quick = false;
  std::size_t threads = 1;
  double load_before = 0.0;
  double load_after = 0.0;
  double tolerance = 0.1;
  const Baseline* baseline = nullptr;  ///< Null without one.
};

/// The baseline's figure of a case, or null.
[[nodiscard]] const bench::Figure* baseline_of(const BenchOutcome& outcome, const bench::CaseResult& one);

/// The cases that are slower than the baseline, by name.
[[nodiscard]] std::vector<std::string> slower_cases(const BenchOutcome& outcome);

/// "22.2 us": three digits and the unit that suits them.
[[nodiscard]] std::string seconds_text(double seconds);

[[nodiscard]] Json bench_document(const BenchOutcome& outcome);
[[nodiscard]] std::string bench_text(const BenchOutcome& outcome, const Console& console);
/// What there is to time, and who the rivals are.
[[nodiscard]] Json bench_list_document();
[[nodiscard]] std::string bench_list_text(const Console& console);

}  // namespace kith::cli
