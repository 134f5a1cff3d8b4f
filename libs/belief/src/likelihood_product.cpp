#include "kith/belief/likelihood_product.hpp"

#include <algorithm>

#include "slice_moves.hpp"

namespace kith::detail {

void LikelihoodProduct::add(std::span<const HalfSpace> half_spaces, const HalfSpaceLikelihood& likelihood,
                            double share) {
  std::vector<HalfSpace> sorted{half_spaces.begin(), half_spaces.end()};
  std::sort(sorted.begin(), sorted.end());

  for (const HalfSpace& half_space : sorted) {
    auto place = std::lower_bound(observed_.begin(), observed_.end(), half_space,
                                  [](const Observed& seen, const HalfSpace& h) { return seen.half_space < h; });
    if (place == observed_.end() || !(place->half_space == half_space)) {
      place = observed_.insert(place, {half_space, 0.0, 0.0});
    }
    place->far += share * likelihood.log_far();
    place->slope += share * likelihood.concentration();
  }
}

FallingDensity LikelihoodProduct::density(std::span<const Direction> prior_normals) const {
  FallingDensity density;
  for (const Direction& normal : prior_normals) {
    density.prior.insert(density.prior.end(), normal.begin(), normal.end());
  }
  for (const Observed& seen : observed_) {
    const Direction normal = seen.half_space.unit();
    density.dimension = seen.half_space.dimension();
    density.normals.insert(density.normals.end(), normal.begin(), normal.end());
    density.far.push_back(seen.far);
    density.slope.push_back(seen.slope);
  }
  return density;
}

}  // namespace kith::detail
