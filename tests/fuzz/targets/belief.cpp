// Any sequence of updates of a particle belief. Weights stay finite, not negative and sum to 1; points stay on the
// sphere and in the prior; what is refused changes nothing; the order of half-spaces changes no bit.

#include <cmath>
#include <numbers>

#include "../half_spaces.hpp"
#include "kith/belief/particle_belief.hpp"
#include "kith/core/error.hpp"

using namespace kith;
using fuzzing::require;

namespace {

void check(const ParticleBelief& belief, const Cone& prior) {
  constexpr double kRounding = 1e-9;
  double sum = 0.0;
  for (std::size_t i = 0; i < belief.size(); ++i) {
    const auto point = belief.point(i);
    require(belief.weights()[i] >= 0.0 && belief.weights()[i] <= 1.0 + kRounding, "weights are probabilities");
    require(std::abs(point.norm() - 1.0) < kRounding, "points are on the unit sphere");
    for (const auto& facet : prior.facets()) require(facet.margin(point) >= -kRounding, "points are in the prior");
    sum += belief.weights()[i];
  }
  require(std::abs(sum - 1.0) < kRounding, "weights sum to 1");
  const auto effective = belief.effective_sample_size();
  require(effective > 1.0 - kRounding && effective < static_cast<double>(belief.size()) + kRounding, "1 <= ESS <= M");
  require(std::abs(belief.mean_direction().norm() - 1.0) < kRounding, "the mean is a direction");
  require(belief.spread() >= 0.0 && belief.spread() <= std::numbers::pi, "the spread is an angle");
}

// Whether the update was possible; if not, nothing changed.
template <typename Update>
bool updated(ParticleBelief& belief, const Update& update) {
  const auto before = belief;
  try {
    update(belief);
    return true;
  } catch (const Error&) {
    require(belief == before, "what is refused changes nothing");
    return false;
  }
}

void observe(ParticleBelief& belief, fuzzing::Bytes& bytes, const HalfSpaceLikelihood& likelihood,
             const RandomStream& random) {
  const auto shown = fuzzing::half_spaces(bytes, 4, 3, belief.dimension());
  auto other = belief;
  const std::vector<HalfSpace> backwards{shown.rbegin(), shown.rend()};
  const auto mass = belief.mass_in(shown);
  require(mass >= 0.0 && mass <= 1.0 + 1e-9, "a mass is a probability");
  require(!std::isnan(belief.log_evidence(shown, likelihood)), "there is some evidence, or none");
  const bool possible = updated(belief, [&](auto& b) { b.observe(shown, likelihood, random); });
  require(possible == updated(other, [&](auto& b) { b.observe(backwards, likelihood, random); }) && belief == other,
          "the order changes nothing");
}

void observe_any(ParticleBelief& belief, fuzzing::Bytes& bytes, const HalfSpaceLikelihood& likelihood,
                 const RandomStream& random) {
  std::vector<std::vector<HalfSpace>> alternatives(bytes.below(4));
  for (auto& list : alternatives) list = fuzzing::half_spaces(bytes, 3, 3, belief.dimension());
  updated(belief, [&](auto& b) { b.observe_any(alternatives, likelihood, random); });
}

}  // namespace

const fuzzing::Form fuzzing::kForm{.head_bytes = 4, .width = fuzzing::kByFirstByte};

// The first byte chooses how many dimensions there are.
fuzzing::Outcome fuzzing::run(std::string_view input) {
  fuzzing::Bytes bytes{input};
  const auto d = bytes.dimension();
  const auto particles = 1 + bytes.below(48);
  const auto noise = 2.0 * bytes.fraction();
  const FilterOptions options{.particles = particles, .process_noise = noise, .resample_below = bytes.fraction()};
  const auto prior = fuzzing::intersection(fuzzing::half_spaces(bytes, 3, 3, d), d);
  if (!prior) return Outcome::kRefused;
  const PriorCover cover{*prior, options.particles};
  ParticleBelief belief{cover, options};
  check(belief, *prior);
  const RandomStream root{1};
  for (std::uint64_t step = 0; step < 24 && !bytes.empty(); ++step) {
    const auto action = bytes.below(8);
    const auto form = (action & 1) != 0 ? LikelihoodForm::kContinuous : LikelihoodForm::kDiscontinuous;
    const HalfSpaceLikelihood likelihood{0.5 + 0.5 * bytes.fraction(), form, d};
    if (action < 3) observe(belief, bytes, likelihood, root.split(step));
    if (action >= 3 && action < 5) observe_any(belief, bytes, likelihood, root.split(step));
    if (action == 5 || action == 6) belief.diffuse(4.0 * bytes.fraction(), root.split(step));
    if (action == 7) belief = ParticleBelief{cover, options};
    check(belief, *prior);
  }
  return Outcome::kRead;
}
