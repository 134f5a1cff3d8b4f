#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cases.hpp"

namespace kith::bench {

/// What came of a case.
struct CaseResult {
  const Case* which = nullptr;
  Timings timings;
  std::optional<std::string> disagreement;  ///< Empty text if kith and rival agree; missing if that was not checked.

  [[nodiscard]] const Figure& figure() const { return timings.work.by(which->clock); }
  /// The rival's median; missing without a rival.
  [[nodiscard]] std::optional<Figure> rival() const;
  /// How many times as long the rival takes; missing without a rival.
  [[nodiscard]] std::optional<double> ratio() const;
};

/// What came of a growth: a figure per point, in seconds.
struct GrowthResult {
  const Growth* which = nullptr;
  std::vector<Figure> figures;
  double exponent = 0.0;  ///< See growth_exponent().
};

struct SuiteOptions {
  bool quick = false;  ///< Fewer samples; whole studies once, without rival or check.
  std::size_t threads = 1;
  std::function<bool(const std::string& name)> selects;                  ///< Which cases and growths are run.
  bool growth = false;                                                   ///< Growths instead of cases.
  std::function<void(std::size_t done, std::size_t total)> on_progress;  ///< Before and after each. May be empty.
  std::function<bool()> stopped;                                         ///< Asked often. May be empty.
};

struct SuiteResult {
  std::vector<CaseResult> cases;
  std::vector<GrowthResult> growths;
  bool stopped = false;
};

/// Prepares, checks and times what is selected, one after the other.
[[nodiscard]] SuiteResult run_suite(const SuiteOptions& options);

/// Share of the time, in [0, 1], that work on one thread had to wait for a processor.
[[nodiscard]] double waited(const SuiteResult& result);

}  // namespace kith::bench
