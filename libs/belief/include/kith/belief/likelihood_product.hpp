#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kith/belief/likelihood.hpp"
#include "kith/geometry/half_space.hpp"

namespace kith::detail {

struct FallingDensity;

// All that a belief observed, as long as it is the product of the prior and the likelihoods of what it observed.
class LikelihoodProduct {
 public:
  explicit LikelihoodProduct(bool is_kept) : is_kept_{is_kept} {}

  [[nodiscard]] bool is_kept() const noexcept { return is_kept_; }
  // Something happened that is no observation.
  void give_up() {
    is_kept_ = false;
    observed_.clear();
  }
  // Takes in a share, in (0, 1], of what the half-spaces say. @pre is_kept().
  void add(std::span<const HalfSpace> half_spaces, const HalfSpaceLikelihood& likelihood, double share);
  // The product, within a prior of these normals.
  [[nodiscard]] FallingDensity density(std::span<const Direction> prior_normals) const;

  friend bool operator==(const LikelihoodProduct&, const LikelihoodProduct&) = default;

 private:
  // All observations of one half-space; see FallingDensity.
  struct Observed {
    HalfSpace half_space;
    double far = 0.0;
    double slope = 0.0;
    friend bool operator==(const Observed&, const Observed&) = default;
  };

  std::vector<Observed> observed_;  // sorted
  bool is_kept_;
};

}  // namespace kith::detail
