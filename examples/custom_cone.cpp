// What somebody can believe about the weights of four features who knows a little beforehand and then sees a robot
// make two choices.
#include <cstdio>
#include <vector>

#include "kith/belief/particle_belief.hpp"
#include "kith/geometry/cone.hpp"

namespace {

// The features: parcels delivered, steps, puddles crossed, metres of carpet.
constexpr std::size_t kFeatures = 4;

// Known beforehand: deliveries are good, and steps cost something.
kith::Cone prior() {
  kith::Cone cone{kFeatures};
  (void)cone.clip(kith::HalfSpace{{1, 0, 0, 0}});
  (void)cone.clip(kith::HalfSpace{{0, -1, 0, 0}});
  return cone;
}

void print(const char* when, const kith::ParticleBelief& belief, const std::vector<kith::HalfSpace>& truth) {
  const auto mean = belief.mean_direction();
  std::printf("%-14s mean (%5.2f, %5.2f, %5.2f, %5.2f)  sure of both: %3.0f %%\n", when, mean[0], mean[1], mean[2],
              mean[3], 100.0 * belief.mass_in(truth));
}

}  // namespace

int main() {
  // A path with these feature counts minus the path that was not taken: whoever prefers the first has weights w with
  // (difference of counts) . w >= 0.
  const kith::HalfSpace around_the_puddle{{0, 2, -1, 0}};  // two more steps, one puddle less
  const kith::HalfSpace across_the_carpet{{0, -3, 0, 1}};  // three steps less, one metre of carpet more
  const std::vector<kith::HalfSpace> both{around_the_puddle, across_the_carpet};

  auto region = prior();
  std::printf("prior: %.1f %% of all directions\n", 100.0 * region.solid_angle() / kith::sphere_area(kFeatures));
  for (const auto& choice : both) (void)region.clip(choice);
  std::printf("left by both choices: %.1f %%\n\n", 100.0 * region.solid_angle() / kith::sphere_area(kFeatures));

  // Somebody who draws the right conclusion from a choice with probability 0.8.
  const kith::HalfSpaceLikelihood likelihood{0.8, kith::LikelihoodForm::kDiscontinuous, kFeatures};
  const kith::RandomStream random{1};
  kith::ParticleBelief belief{prior(), {.particles = 2000}};
  print("before", belief, both);
  belief.observe(std::vector{around_the_puddle}, likelihood, random.split("puddle"));
  print("after puddle", belief, both);
  belief.observe(std::vector{across_the_carpet}, likelihood, random.split("carpet"));
  print("after carpet", belief, both);
}
