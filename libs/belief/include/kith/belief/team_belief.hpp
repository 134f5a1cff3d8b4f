#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "kith/belief/aggregation.hpp"
#include "kith/belief/particle_belief.hpp"

namespace kith {

/// What a teacher believes about a team: one belief per member and one per rule of aggregation, such as the common
/// belief (what all members know: intersection) and the joint belief (what at least one member knows: union)
/// [jayaraman2024, section III-C]. Beliefs that nobody reads need not be kept.
///
/// Members can be absent: what happens then leaves the belief about them as it is, and rules of aggregation see only
/// the others.
///
/// Seats do not matter: if the members are permuted together with their streams, so are the results, bit for bit. An
/// update that throws (a hard likelihood that excludes every particle of some belief) changes none of the beliefs. A
/// team of one member has one belief, which is the member's and every rule's, updated as the member's.
class TeamBelief {
 public:
  struct Options {
    FilterOptions filter;
    HalfSpaceLikelihood likelihood{0.8};
    double response_noise = 0.05;       ///< nu, radians per axis, >= 0; after test responses only.
    bool reduce_before_update = false;  ///< Common belief: minimal set of the survivors' half-spaces instead of all.
    bool members = true;                ///< Whether beliefs about members are kept.
    std::vector<AggregationRule> rules{aggregation_rules().begin(), aggregation_rules().end()};  ///< Those kept.
  };

  /// @param persons one stream per member, the root of all that is drawn for that member's belief; its address
  ///        also breaks ties, so seats never matter. @param shared root of what is drawn for the rules' beliefs.
  /// @throws std::invalid_argument if there is no member, an option is out of range or two rules have the same name.
  TeamBelief(const Cone& prior, const Options& options, const std::vector<RandomStream>& persons, RandomStream shared);
  /// The same over a cover made before, which saves most of the time.
  TeamBelief(const PriorCover& cover, const Options& options, const std::vector<RandomStream>& persons,
             RandomStream shared);

  [[nodiscard]] std::size_t num_members() const noexcept { return addresses_.size(); }
  [[nodiscard]] const Options& options() const noexcept { return options_; }
  /// @throws std::logic_error unless options().members (with more than one member). @pre i < num_members().
  [[nodiscard]] const ParticleBelief& member(std::size_t i) const;
  /// The belief of a rule. @throws std::logic_error unless the rule is among options().rules (with more than one
  /// member).
  [[nodiscard]] const ParticleBelief& aggregate(std::string_view rule) const;
  [[nodiscard]] const ParticleBelief& common() const { return aggregate("common"); }
  [[nodiscard]] const ParticleBelief& joint() const { return aggregate("joint"); }

  /// Who takes part in what comes next, per member; at first everybody.
  [[nodiscard]] const std::vector<bool>& present() const noexcept { return present_; }
  /// @throws std::invalid_argument unless there is one entry per member and somebody is present.
  void set_present(std::vector<bool> present);

  /// Somebody new takes the place of a member: the belief about the member, and those of rules that need everybody, are
  /// the prior again.
  /// @pre i < num_members(); the cover is of the team's prior, by as many points as there are particles.
  void restart(std::size_t i, const PriorCover& cover);

  /// Everybody present saw the same demonstrations: their beliefs and those of the rules are updated with the
  /// half-spaces.
  /// @param period the number of the interaction period, part of the address of what is drawn.
  void observe_demonstrations(std::span<const HalfSpace> half_spaces, std::uint64_t period);

  /// Test responses, one list of half-spaces per member; lists of absent members are ignored. Each member's belief gets
  /// its own list, each rule's belief what the rule makes of them. Then all are diffused by the response noise.
  /// @return the members that some rule left out, sorted.
  /// @throws std::invalid_argument unless there is one list per member.
  std::vector<std::size_t> observe_responses(std::span<const std::vector<HalfSpace>> responses, std::uint64_t period);

  /// What members answered after they had seen each other's answers, as far as their own first answers did not show it:
  /// one list per member; lists of absent members are ignored. Only the beliefs about these members are updated: the
  /// rules of aggregation have the first answers of everybody, of which these are made.
  /// @throws std::invalid_argument unless there is one list per member.
  void observe_discussion(std::span<const std::vector<HalfSpace>> revised, std::uint64_t period);

  /// Feedback: the true half-spaces, once, to the beliefs about everybody present and those of the rules.
  void observe_feedback(std::span<const HalfSpace> half_spaces, std::uint64_t period);

  /// The same beliefs and the same members present, bit for bit; whatever the options.
  friend bool operator==(const TeamBelief& a, const TeamBelief& b) {
    return a.present_ == b.present_ && a.members_ == b.members_ && a.aggregates_ == b.aggregates_;
  }

 private:
  // A belief and the root of what it draws.
  struct Part {
    ParticleBelief belief;
    RandomStream random;
    friend bool operator==(const Part& a, const Part& b) { return a.belief == b.belief; }
  };

  [[nodiscard]] bool is_single() const noexcept { return num_members() == 1; }
  void observe_all(std::span<const HalfSpace> half_spaces, std::uint64_t period, std::string_view event);
  [[nodiscard]] std::vector<std::size_t> apply_responses(std::span<const std::vector<HalfSpace>> responses,
                                                         std::uint64_t period);
  template <typename Action>
  void for_each_part(Action action);
  template <typename Action>
  auto all_or_nothing(Action action);

  Cone prior_;
  Options options_;
  std::vector<std::uint64_t> addresses_;  // of the persons
  std::vector<bool> present_;
  std::vector<Part> members_;     // a team of one keeps only members_[0]
  std::vector<Part> aggregates_;  // in the order of options_.rules
};

}  // namespace kith
