#include "measure.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <numeric>

namespace kith::bench {
namespace {

double cpu_now() {
  timespec time = {};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double wall_now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

// The samples of one kind of work.
class Series {
 public:
  Series(const Work& work, const Effort& effort) : work_{work}, effort_{effort} {
    const double first = effort.warm_up ? seconds_of(1) : 0.0;
    if (first < 10.0 * effort.sample_seconds) choose_rounds();
  }

  void sample() {
    const double cpu = cpu_now();
    const double wall = seconds_of(rounds_);
    cpu_.push_back((cpu_now() - cpu) / static_cast<double>(rounds_));
    wall_.push_back(wall / static_cast<double>(rounds_));
  }

  [[nodiscard]] bool is_settled() const {
    if (cpu_.size() < effort_.min_samples) return false;
    const auto figure = figure_of(cpu_);
    return figure.spread() < effort_.enough * std::sqrt(static_cast<double>(cpu_.size()));
  }

  [[nodiscard]] Timing timing() const {
    const double wall = std::accumulate(wall_.begin(), wall_.end(), 0.0);
    const double cpu = std::accumulate(cpu_.begin(), cpu_.end(), 0.0);
    return {figure_of(wall_), figure_of(cpu_), rounds_, wall > 0.0 ? std::clamp(1.0 - cpu / wall, 0.0, 1.0) : 0.0};
  }

 private:
  double seconds_of(std::size_t rounds) {
    const double begin = wall_now();
    work_(rounds);
    return wall_now() - begin;
  }

  // Doubles the rounds until a sample is long enough.
  void choose_rounds() {
    if (!effort_.warm_up && effort_.min_samples == 1) return;
    for (rounds_ = 1; rounds_ < std::size_t{1} << 24; rounds_ *= 2) {
      const double seconds = seconds_of(rounds_);
      if (seconds >= effort_.sample_seconds / 2) return;
    }
  }

  const Work& work_;
  const Effort& effort_;
  std::size_t rounds_ = 1;
  std::vector<double> cpu_, wall_;
};

double quantile(const std::vector<double>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const auto above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace

Figure figure_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  return {quantile(values, 0.5), quantile(values, 0.25), quantile(values, 0.75), values.size()};
}

Timings measure(const Work& work, const Work& rival, const Effort& effort) {
  const double begin = wall_now();
  Series series{work, effort};
  std::optional<Series> others;
  if (rival) others.emplace(rival, effort);
  for (std::size_t n = 0; n < effort.max_samples; ++n) {
    const bool enough = n >= effort.min_samples && (wall_now() - begin >= effort.seconds ||
                                                    (series.is_settled() && (!others || others->is_settled())));
    if (enough || (effort.stopped && n > 0 && effort.stopped())) break;
    series.sample();
    if (others) others->sample();
  }
  Timings timings{series.timing(), std::nullopt};
  if (others) timings.rival = others->timing();
  return timings;
}

}  // namespace kith::bench
