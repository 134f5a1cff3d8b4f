#include "kith/belief/team_belief.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

namespace kith {

TeamBelief::TeamBelief(const Cone& prior, const Options& options, const std::vector<RandomStream>& persons,
                       RandomStream shared)
    : TeamBelief{PriorCover{prior, options.filter.particles}, options, persons, shared} {}

TeamBelief::TeamBelief(const PriorCover& cover, const Options& options, const std::vector<RandomStream>& persons,
                       RandomStream shared)
    : prior_{cover.prior()}, options_{options} {
  if (persons.empty()) throw std::invalid_argument("TeamBelief: a team has at least one member");
  if (!(options.response_noise >= 0.0 && std::isfinite(options.response_noise))) {
    throw std::invalid_argument("TeamBelief: response_noise must be finite and not negative");
  }
  for (const RandomStream& person : persons) addresses_.push_back(person.address());
  present_.assign(persons.size(), true);
  const ParticleBelief start{cover, options.filter};
  if (options.members || is_single()) {
    for (const RandomStream& person : persons) members_.push_back({start, person.split("belief")});
  }
  for (auto rule = options.rules.begin(); rule != options.rules.end(); ++rule) {
    if (std::any_of(options.rules.begin(), rule, [&](const auto& other) { return other.name == rule->name; })) {
      throw std::invalid_argument("TeamBelief: there are two rules named '" + std::string{rule->name} + "'");
    }
    if (!is_single()) aggregates_.push_back({start, shared.split(std::string{rule->name} + " belief")});
  }
}

const ParticleBelief& TeamBelief::member(std::size_t i) const {
  if (members_.empty()) throw std::logic_error("TeamBelief::member: the beliefs about members are not kept");
  return members_.at(i).belief;
}

const ParticleBelief& TeamBelief::aggregate(std::string_view rule) const {
  if (is_single()) return members_.front().belief;
  for (std::size_t i = 0; i < aggregates_.size(); ++i) {
    if (options_.rules[i].name == rule) return aggregates_[i].belief;
  }
  throw std::logic_error("TeamBelief::aggregate: the belief '" + std::string{rule} + "' is not kept");
}

void TeamBelief::set_present(std::vector<bool> present) {
  if (present.size() != num_members() || std::find(present.begin(), present.end(), true) == present.end()) {
    throw std::invalid_argument("TeamBelief::set_present: one entry per member, and at least one member present");
  }
  present_ = std::move(present);
}

void TeamBelief::restart(std::size_t i, const PriorCover& cover) {
  const ParticleBelief start{cover, options_.filter};
  if (!members_.empty()) members_.at(i).belief = start;
  for (std::size_t k = 0; k < aggregates_.size(); ++k) {
    if (options_.rules[k].needs_everybody) aggregates_[k].belief = start;
  }
}

template <typename Action>
void TeamBelief::for_each_part(Action action) {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    if (present_[i]) action(members_[i]);
  }
  for (Part& part : aggregates_) action(part);
}

// Only a hard likelihood can refuse an update. Then it is tried on a copy, so
// that a team is never left half updated.
template <typename Action>
auto TeamBelief::all_or_nothing(Action action) {
  if (!options_.likelihood.is_hard()) return action(*this);
  TeamBelief trial = *this;
  if constexpr (std::is_void_v<decltype(action(trial))>) {
    action(trial);
    *this = std::move(trial);
  } else {
    auto result = action(trial);
    *this = std::move(trial);
    return result;
  }
}

// Everybody present has the same evidence, so every rule would update with just that.
void TeamBelief::observe_all(std::span<const HalfSpace> half_spaces, std::uint64_t period, std::string_view event) {
  all_or_nothing([&](TeamBelief& team) {
    team.for_each_part([&](Part& part) {
      part.belief.observe(half_spaces, options_.likelihood, part.random.split(period).split(event));
    });
  });
}

void TeamBelief::observe_demonstrations(std::span<const HalfSpace> half_spaces, std::uint64_t period) {
  observe_all(half_spaces, period, "demonstration");
}

void TeamBelief::observe_feedback(std::span<const HalfSpace> half_spaces, std::uint64_t period) {
  observe_all(half_spaces, period, "feedback");
}

std::vector<std::size_t> TeamBelief::observe_responses(std::span<const std::vector<HalfSpace>> responses,
                                                       std::uint64_t period) {
  if (responses.size() != num_members()) {
    throw std::invalid_argument("TeamBelief::observe_responses: there must be one list per member");
  }
  return all_or_nothing([&](TeamBelief& team) { return team.apply_responses(responses, period); });
}

void TeamBelief::observe_discussion(std::span<const std::vector<HalfSpace>> revised, std::uint64_t period) {
  if (revised.size() != num_members()) {
    throw std::invalid_argument("TeamBelief::observe_discussion: there must be one list per member");
  }
  if (members_.empty()) return;
  all_or_nothing([&](TeamBelief& team) {
    for (std::size_t i = 0; i < team.num_members(); ++i) {
      if (!team.present_[i] || revised[i].empty()) continue;
      auto& part = team.members_[i];
      part.belief.observe(revised[i], options_.likelihood, part.random.split(period).split("discussion"));
    }
  });
}

std::vector<std::size_t> TeamBelief::apply_responses(std::span<const std::vector<HalfSpace>> responses,
                                                     std::uint64_t period) {
  const auto stream_of = [&](const Part& part) { return part.random.split(period).split("response"); };
  std::vector<std::size_t> seats;
  for (std::size_t i = 0; i < num_members(); ++i) {
    if (present_[i]) seats.push_back(i);
  }
  if (!members_.empty()) {
    for (const auto i : seats) {
      members_[i].belief.observe(responses[i], options_.likelihood, stream_of(members_[i]));
    }
  }
  std::vector<std::size_t> excluded;
  if (!aggregates_.empty()) {
    const bool everybody = seats.size() == num_members();
    std::vector<std::vector<HalfSpace>> some_lists;
    std::vector<std::uint64_t> addresses;
    std::vector<const ParticleBelief*> beliefs;
    for (const auto i : seats) {
      if (!everybody) some_lists.push_back(responses[i]);
      addresses.push_back(addresses_[i]);
      if (!members_.empty()) beliefs.push_back(&members_[i].belief);
    }
    const TeamResponses seen{.lists = everybody ? responses : std::span<const std::vector<HalfSpace>>{some_lists},
                             .addresses = addresses,
                             .members = beliefs,
                             .prior = prior_,
                             .likelihood = options_.likelihood,
                             .reduce_before_update = options_.reduce_before_update};
    for (std::size_t k = 0; k < aggregates_.size(); ++k) {
      auto& part = aggregates_[k];
      for (const auto position : options_.rules[k].observe(part.belief, seen, stream_of(part))) {
        excluded.push_back(seats[position]);
      }
    }
    std::sort(excluded.begin(), excluded.end());
    excluded.erase(std::unique(excluded.begin(), excluded.end()), excluded.end());
  }
  for_each_part([&](Part& part) {
    part.belief.diffuse(options_.response_noise, part.random.split(period).split("response noise"));
  });
  return excluded;
}

}  // namespace kith
