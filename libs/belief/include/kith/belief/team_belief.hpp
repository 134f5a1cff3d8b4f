#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
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
///
/// Seats do not matter: if the members are permuted together with their streams,
/// so are the results, bit for bit. An update that throws (a hard likelihood that
/// excludes every particle of some belief) changes none of the beliefs. A team of one member has one belief, which is
/// its member, common and joint belief, updated as the member's.
class TeamBelief {
 public:
  struct Options {
    FilterOptions filter;
    HalfSpaceLikelihood likelihood{0.8};
    double response_noise = 0.05;       ///< nu, radians per axis, >= 0; after test responses only.
    bool reduce_before_update = false;  ///< Common belief: minimal set of the survivors' half-spaces instead of all.
    TeamBeliefParts parts;
  };

  /// @param persons one stream per member, the root of all that is drawn for that member's belief; its address
  ///        also breaks ties, so seats never matter. @param shared stream of the common and joint beliefs.
  /// @throws std::invalid_argument if there is no member or an option is out of range.
  TeamBelief(const Cone& prior, const Options& options, const std::vector<RandomStream>& persons, RandomStream shared);
  /// The same over a cover made before, which saves most of the time.
  TeamBelief(const PriorCover& cover, const Options& options, const std::vector<RandomStream>& persons,
             RandomStream shared);

  [[nodiscard]] std::size_t num_members() const noexcept { return addresses_.size(); }
  [[nodiscard]] const Options& options() const noexcept { return options_; }
  /// @throws std::logic_error unless options.parts.members (with more than one member). @pre i < num_members().
  [[nodiscard]] const ParticleBelief& member(std::size_t i) const;
  /// @throws std::logic_error unless options.parts.common (with more than one member).
  [[nodiscard]] const ParticleBelief& common() const;
  /// @throws std::logic_error unless options.parts.joint (with more than one member).
  [[nodiscard]] const ParticleBelief& joint() const;

  /// Everybody saw the same demonstrations: all beliefs are updated with the half-spaces.
  /// @param period the number of the interaction, part of the address of what is drawn.
  void observe_demonstrations(std::span<const HalfSpace> half_spaces, std::uint64_t period);

  /// Test responses, one list of half-spaces per member. Each member's belief gets its own list. The
  /// common belief gets the product over the largest consistent set of members, of each what is left when it is freed
  /// of contradictions with itself (ties: the larger evidence under the current common belief, then the smaller hash of
  /// the members' addresses); the joint belief the best alternative, in which an empty list fits everywhere. Then all
  /// are diffused by the response noise.
  /// @return the members left out of the common belief, sorted; none if the common belief is not kept.
  /// @throws std::invalid_argument unless there is one list per member.
  std::vector<std::size_t> observe_responses(std::span<const std::vector<HalfSpace>> responses, std::uint64_t period);

  /// Feedback: the true half-spaces, once, to all beliefs.
  void observe_feedback(std::span<const HalfSpace> half_spaces, std::uint64_t period);

 private:
  // A belief and the root of what it draws.
  struct Part {
    ParticleBelief belief;
    RandomStream random;
  };

  [[nodiscard]] bool is_single() const noexcept { return num_members() == 1; }
  void observe_all(std::span<const HalfSpace> half_spaces, std::uint64_t period, std::string_view event);
  [[nodiscard]] std::vector<std::size_t> observe_common(std::span<const std::vector<HalfSpace>> responses,
                                                        const RandomStream& random);
  [[nodiscard]] std::vector<std::size_t> apply_responses(std::span<const std::vector<HalfSpace>> responses,
                                                         std::uint64_t period);
  template <typename Action>
  void for_each_part(Action action);
  template <typename Action>
  auto all_or_nothing(Action action);

  Cone prior_;
  Options options_;
  std::vector<std::uint64_t> addresses_;  // of the persons
  std::vector<Part> members_;             // a team of one keeps only members_[0]
  std::optional<Part> common_;
  std::optional<Part> joint_;
};

}  // namespace kith
