#include "minimize.hpp"

#include <algorithm>

#include "kith/study_design/space_filling.hpp"

namespace kith {
namespace {

// One step length for all coordinates, halved when no step helps.
void improve(const Objective& objective, const Box& box, const Fixed& fixed, SamplePoint& point) {
  double step = 0.1;
  while (step > 1e-3) {
    bool better = false;
    for (std::size_t k = 0; k < point.unit.size(); ++k) {
      if (fixed[k]) continue;
      for (const double sign : {-1.0, 1.0}) {
        auto other = point.unit;
        other[k] = std::clamp(other[k] + sign * step * (box.high[k] - box.low[k]), box.low[k], box.high[k]);
        const double there = objective(other);
        if (there < point.value) {
          point = {std::move(other), there};
          better = true;
        }
      }
    }
    if (!better) step /= 2.0;
  }
}

}  // namespace

std::vector<SamplePoint> ranked_sample(const Objective& objective, const Box& box, const Fixed& fixed, std::size_t n,
                                       const RandomStream& random) {
  std::vector<SamplePoint> sample;
  for (const auto& fraction : latin_hypercube(n, fixed.size(), 1, random)) {
    auto unit = box.place(fraction);
    for (std::size_t k = 0; k < fixed.size(); ++k) unit[k] = fixed[k].value_or(unit[k]);
    const double value = objective(unit);
    sample.push_back({std::move(unit), value});
  }
  std::stable_sort(sample.begin(), sample.end(),
                   [](const SamplePoint& a, const SamplePoint& b) { return a.value < b.value; });
  return sample;
}

std::vector<double> minimum(const Objective& objective, const Box& box, const Fixed& fixed,
                            const RandomStream& random) {
  constexpr std::size_t kSample = 2048;
  constexpr std::size_t kImproved = 5;
  auto sample = ranked_sample(objective, box, fixed, kSample, random);
  sample.resize(kImproved);
  for (auto& point : sample) improve(objective, box, fixed, point);
  return std::min_element(sample.begin(), sample.end(),
                          [](const SamplePoint& a, const SamplePoint& b) { return a.value < b.value; })
      ->unit;
}

}  // namespace kith
