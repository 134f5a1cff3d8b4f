#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kith/belief/particle_belief.hpp"

namespace kith {

/// Which of a team's beliefs are kept up to date. Those that nobody reads need not be simulated.
struct TeamBeliefParts {
  bool members = true;
  bool common = true;
  bool joint = true;
};

/// What a teacher believes about a team: one belief per member, the common
/// belief (what all members know: intersection) and the joint belief (what
/// somebody knows: union) [jayaraman2024, section III-C].
class TeamBelief {
 public:
  struct Options {
    FilterOptions filter;
    HalfSpaceLikelihood likelihood{0.8};
    double response_noise = 0.05;       ///< nu, radians per axis; after test responses only.
    bool reduce_before_update = false;  ///< Common belief: minimal set of the survivors' half-spaces instead of all.
    TeamBeliefParts parts;
  };

  /// @param persons one stream per member, the root of all that is drawn for that member's belief; its address
  ///        also breaks ties, so seats never matter. @param shared stream of the common and joint beliefs.
  /// @throws std::invalid_argument if there is no member.
  TeamBelief(const Cone& prior, const Options& options, std::vector<RandomStream> persons, RandomStream shared);

  [[nodiscard]] std::size_t num_members() const noexcept;
  /// @pre options.parts.members.
  [[nodiscard]] const ParticleBelief& member(std::size_t i) const;
  [[nodiscard]] const ParticleBelief& common() const;
  [[nodiscard]] const ParticleBelief& joint() const;

  /// Everybody saw the same demonstrations: all beliefs are updated with the half-spaces.
  void observe_demonstrations(std::span<const HalfSpace> half_spaces, std::uint64_t period);

  /// Test responses, one list of half-spaces per member. Each member's belief gets its own list. The
  /// common belief gets the product over the largest consistent set of members (ties: the larger evidence
  /// under the current common belief, then the smaller hash of the members' addresses); the joint belief the
  /// best alternative. Then all are diffused by the response noise.
  /// @return the members left out of the common belief, sorted.
  std::vector<std::size_t> observe_responses(std::span<const std::vector<HalfSpace>> responses, std::uint64_t period);

  /// Feedback: the true half-spaces, once, to all beliefs.
  void observe_feedback(std::span<const HalfSpace> half_spaces, std::uint64_t period);

 private:
  // ...: the implementer's
};

}  // namespace kith
