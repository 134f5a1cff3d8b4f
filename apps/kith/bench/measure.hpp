#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace kith::bench {

/// Does something so many times.
using Work = std::function<void(std::size_t rounds)>;

/// What of a sample counts.
enum class Clock {
  kCpu,   ///< Processor time of the whole process: for work on one thread; others on the machine hardly matter.
  kWall,  ///< Time that passes: for work on several threads, or with a disk.
};

/// The middle of some samples and how far apart they are. In seconds per round, or a plain number.
struct Figure {
  double median = 0.0;
  double low = 0.0;   ///< First quartile.
  double high = 0.0;  ///< Third quartile.
  std::size_t samples = 0;

  /// Half the distance of the quartiles, relative to the median.
  [[nodiscard]] double spread() const { return median > 0.0 ? (high - low) / (2.0 * median) : 0.0; }
};

/// Median and quartiles, interpolated between neighbours; all 0 without values.
[[nodiscard]] Figure figure_of(std::vector<double> values);

/// How long to measure.
struct Effort {
  double seconds = 1.0;           ///< No further sample is begun after this time (the first `min_samples` always are).
  double sample_seconds = 2e-3;   ///< Rounds of a sample are chosen so that it takes about this long.
  double enough = 0.003;          ///< Done once spread / sqrt(samples) is below this.
  std::size_t min_samples = 10;   ///< At least 1.
  std::size_t max_samples = 400;  ///< At least min_samples.
  bool warm_up = true;            ///< Whether work is done once without being timed.
  std::function<bool()> stopped{};  ///< Asked between samples; once true, measuring ends. May be empty.
};

/// What measuring came to.
struct Timing {
  Figure wall;             ///< Seconds per round that passed.
  Figure cpu;              ///< Seconds per round of all threads together.
  std::size_t rounds = 1;  ///< Per sample.
  double waited = 0.0;     ///< Share of all samples' time, in [0, 1], in which less than one processor was at work.

  [[nodiscard]] const Figure& by(Clock clock) const { return clock == Clock::kCpu ? cpu : wall; }
};

/// Times `work`, and in turns with it `rival`, so that whatever else the machine does meets both.
struct Timings {
  Timing work;
  std::optional<Timing> rival;
};
[[nodiscard]] Timings measure(const Work& work, const Work& rival, const Effort& effort);

/// Keeps a compiler from leaving out what computes `value`.
template <typename T>
void keep(const T& value) {
  asm volatile("" : : "r,m"(&value) : "memory");
}

}  // namespace kith::bench
