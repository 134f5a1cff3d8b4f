#include "suite.hpp"

#include <algorithm>

namespace kith::bench {
namespace {

Effort effort_of(const Case& which, const SuiteOptions& options) {
  Effort effort;
  effort.stopped = options.stopped;
  if (which.is_study) {
    effort.seconds = options.quick ? 0.0 : 2.0;
    effort.min_samples = options.quick ? 1 : 3;
    effort.max_samples = options.quick ? 1 : 30;
  } else {
    effort.seconds = options.quick ? 0.05 : 0.5;
    effort.sample_seconds = options.quick ? 5e-4 : 2e-3;
    effort.min_samples = options.quick ? 3 : 10;
  }
  return effort;
}

Effort growth_effort(const SuiteOptions& options) {
  Effort effort;
  effort.seconds = options.quick ? 0.02 : 0.25;
  effort.sample_seconds = options.quick ? 5e-4 : 2e-3;
  effort.min_samples = options.quick ? 1 : 3;
  effort.stopped = options.stopped;
  return effort;
}

bool is_stopped(const SuiteOptions& options) { return options.stopped && options.stopped(); }

CaseResult run_case(const Case& which, Workbench& bench, const SuiteOptions& options) {
  CaseResult result;
  result.which = &which;
  const auto prepared = which.prepare(bench);
  const bool brief = which.is_study && options.quick;
  auto effort = effort_of(which, options);
  if (prepared.disagreement && !brief) {
    result.disagreement = prepared.disagreement();
    if (which.is_study) effort.warm_up = false;  // the check did all that is timed
  }
  if (brief) effort.warm_up = false;
  result.timings = measure(prepared.work, brief ? Work{} : prepared.rival, effort);
  return result;
}

GrowthResult run_growth(const Growth& which, Workbench& bench, const SuiteOptions& options) {
  GrowthResult result;
  result.which = &which;
  std::vector<double> sizes, costs;
  for (const auto& point : which.points) {
    auto figure = measure(point.prepare(bench), {}, growth_effort(options)).work.by(which.clock);
    for (double* const value : {&figure.median, &figure.low, &figure.high}) *value /= point.per;
    result.figures.push_back(figure);
    sizes.push_back(point.size);
    costs.push_back(figure.median);
    if (is_stopped(options)) return result;
  }
  result.exponent = growth_exponent(sizes, costs);
  return result;
}

template <typename Entry>
std::vector<const Entry*> selected(const std::vector<Entry>& entries, const SuiteOptions& options) {
  std::vector<const Entry*> some;
  for (const auto& entry : entries) {
    if (options.selects(entry.name)) some.push_back(&entry);
  }
  return some;
}

}  // namespace

std::optional<Figure> CaseResult::rival() const {
  if (!timings.rival) return std::nullopt;
  return timings.rival->by(which->clock);
}

std::optional<double> CaseResult::ratio() const {
  if (!timings.rival || figure().median <= 0.0) return std::nullopt;
  return rival()->median / figure().median;
}

SuiteResult run_suite(const SuiteOptions& options) {
  SuiteResult result;
  Workbench bench{options.threads};
  const auto cases = selected(all_cases(), options);
  const auto growths = selected(all_growths(), options);
  const std::size_t total = options.growth ? growths.size() : cases.size();
  for (std::size_t i = 0; i < total && !result.stopped; ++i) {
    if (options.on_progress) options.on_progress(i, total);
    if (options.growth) {
      result.growths.push_back(run_growth(*growths[i], bench, options));
    } else {
      result.cases.push_back(run_case(*cases[i], bench, options));
    }
    result.stopped = is_stopped(options);
  }
  if (options.on_progress) options.on_progress(total, total);
  return result;
}

double waited(const SuiteResult& result) {
  double sum = 0.0;
  std::size_t n = 0;
  for (const auto& one : result.cases) {
    if (one.which->clock != Clock::kCpu) continue;
    sum += one.timings.work.waited;
    ++n;
  }
  return n > 0 ? sum / static_cast<double>(n) : 0.0;
}

}  // namespace kith::bench
