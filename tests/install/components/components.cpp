#include <cstdio>
#include <vector>

#include "kith/belief/particle_belief.hpp"

int main() {
  kith::ParticleBelief belief{kith::Cone{4}, {.particles = 500}};
  const std::vector<kith::HalfSpace> shown{kith::HalfSpace{{1, 0, 0, -2}}};
  belief.observe(shown, kith::HalfSpaceLikelihood{0.9, kith::LikelihoodForm::kDiscontinuous, 4}, kith::RandomStream{1});
  const bool right = belief.mass_in(shown) > 0.85;
  std::puts(right ? "found kith's beliefs" : "kith gives other numbers");
  return right ? 0 : 1;
}
