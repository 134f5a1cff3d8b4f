#include "kith/analysis/design_effect.hpp"

#include <cmath>
#include <stdexcept>
#include <vector>

#include "checks.hpp"

namespace kith {

Estimable<DesignEffect> design_effect(const Factor& groups, double intraclass_correlation) {
  using Result = Estimable<DesignEffect>;
  require_codes(groups, groups.codes.size(), "design_effect");
  if (!(std::abs(intraclass_correlation) <= 1.0))
    throw std::invalid_argument{"design_effect: an intraclass correlation is in [-1, 1]"};
  if (groups.codes.empty()) return Result::impossible("no observations");
  std::vector<double> sizes(groups.levels.size(), 0.0);
  for (const auto code : groups.codes) sizes[code] += 1.0;
  DesignEffect effect;
  effect.observations = groups.codes.size();
  effect.intraclass_correlation = intraclass_correlation;
  const auto n = static_cast<double>(effect.observations);
  for (const double size : sizes) {
    effect.groups += size > 0.0 ? 1 : 0;
    effect.weighted_group_size += size * size / n;
  }
  effect.mean_group_size = n / static_cast<double>(effect.groups);
  effect.design_effect = 1.0 + (effect.weighted_group_size - 1.0) * intraclass_correlation;
  if (!(effect.design_effect > 0.0))
    return Result::impossible("groups of this size cannot have so negative an intraclass correlation");
  effect.effective_observations = n / effect.design_effect;
  return effect;
}

}  // namespace kith
