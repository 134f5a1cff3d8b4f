#pragma once

#include <memory>

#include "binding.hpp"
#include "kith/belief/particle_belief.hpp"

namespace kith::python {

/// A belief as Python holds it. An update makes a new ParticleBelief, so that arrays that look at the old one's memory
/// stay what they are.
struct Belief {
  std::shared_ptr<const ParticleBelief> value;
  RandomStream random{0};
  std::uint64_t updates = 0;
};

/// A copy of a belief that something else owns.
[[nodiscard]] inline Belief copy_of(const ParticleBelief& belief) {
  return {std::make_shared<const ParticleBelief>(belief), RandomStream{0}, 0};
}

}  // namespace kith::python
