#include "kith/belief/team_belief.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "kith/belief/consistency.hpp"

namespace kith {
namespace {

// A number for a set of addresses, whatever their order.
std::uint64_t hash_of(std::vector<std::uint64_t> addresses) {
  std::sort(addresses.begin(), addresses.end());
  RandomStream hash{addresses.size()};
  for (const std::uint64_t address : addresses) hash = hash.split(address);
  return hash.address();
}

// The half-spaces of the subset's members, one list after another.
std::vector<HalfSpace> concatenated(std::span<const std::vector<HalfSpace>> lists,
                                    std::span<const std::size_t> subset) {
  std::vector<HalfSpace> all;
  for (const std::size_t i : subset) all.insert(all.end(), lists[i].begin(), lists[i].end());
  return all;
}

std::vector<std::size_t> complement(std::span<const std::size_t> subset, std::size_t size) {
  std::vector<std::size_t> rest;
  for (std::size_t i = 0; i < size; ++i) {
    if (!std::binary_search(subset.begin(), subset.end(), i)) rest.push_back(i);
  }
  return rest;
}

}  // namespace

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
  const ParticleBelief start{cover, options.filter};
  if (options.parts.members || is_single()) {
    for (const RandomStream& person : persons) members_.push_back({start, person.split("belief")});
  }
  if (is_single()) return;
  if (options.parts.common) common_ = Part{start, shared.split("common belief")};
  if (options.parts.joint) joint_ = Part{start, shared.split("joint belief")};
}

const ParticleBelief& TeamBelief::member(std::size_t i) const {
  if (members_.empty()) throw std::logic_error("TeamBelief::member: the beliefs about members are not kept");
  return members_.at(i).belief;
}

const ParticleBelief& TeamBelief::common() const {
  if (is_single()) return members_.front().belief;
  if (!common_) throw std::logic_error("TeamBelief::common: the common belief is not kept");
  return common_->belief;
}

const ParticleBelief& TeamBelief::joint() const {
  if (is_single()) return members_.front().belief;
  if (!joint_) throw std::logic_error("TeamBelief::joint: the joint belief is not kept");
  return joint_->belief;
}

template <typename Action>
void TeamBelief::for_each_part(Action action) {
  for (Part& part : members_) action(part);
  if (common_) action(*common_);
  if (joint_) action(*joint_);
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

// The joint belief gets one copy per member of the same set, the largest of which is the set itself.
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

std::vector<std::size_t> TeamBelief::apply_responses(std::span<const std::vector<HalfSpace>> responses,
                                                     std::uint64_t period) {
  const auto stream_of = [&](const Part& part) { return part.random.split(period).split("response"); };
  for (std::size_t i = 0; i < members_.size(); ++i) {
    members_[i].belief.observe(responses[i], options_.likelihood, stream_of(members_[i]));
  }
  std::vector<std::size_t> excluded;
  if (common_) excluded = observe_common(responses, stream_of(*common_));
  if (joint_) joint_->belief.observe_any(responses, options_.likelihood, stream_of(*joint_));
  for_each_part([&](Part& part) {
    part.belief.diffuse(options_.response_noise, part.random.split(period).split("response noise"));
  });
  return excluded;
}

std::vector<std::size_t> TeamBelief::observe_common(std::span<const std::vector<HalfSpace>> responses,
                                                    const RandomStream& random) {
  const ConsistentSubsets candidates = largest_consistent_subsets(responses, prior_);
  const std::vector<std::size_t>* best = nullptr;
  std::vector<HalfSpace> best_product;
  double best_evidence = 0.0;
  std::uint64_t best_hash = 0;
  for (const auto& subset : candidates.subsets) {
    std::vector<HalfSpace> product = concatenated(candidates.reduced_lists, subset);
    double evidence = 0.0;
    std::uint64_t hash = 0;
    if (candidates.subsets.size() > 1) {
      // Relative to the near side, so that a longer list is no less likely for its length.
      evidence = common_->belief.log_evidence(product, options_.likelihood) -
                 static_cast<double>(product.size()) * options_.likelihood.log_density(0.0);
      std::vector<std::uint64_t> addresses;
      addresses.reserve(subset.size());
      for (const std::size_t i : subset) addresses.push_back(addresses_[i]);
      hash = hash_of(std::move(addresses));
    }
    if (best != nullptr && !(evidence > best_evidence || (evidence == best_evidence && hash < best_hash))) continue;
    best = &subset;
    best_product = std::move(product);
    best_evidence = evidence;
    best_hash = hash;
  }
  if (options_.reduce_before_update) best_product = minimal_set(best_product).value_or(best_product);
  common_->belief.observe(best_product, options_.likelihood, random);
  return complement(*best, num_members());
}

}  // namespace kith
