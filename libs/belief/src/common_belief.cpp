#include <algorithm>

#include "kith/belief/aggregation.hpp"
#include "kith/belief/consistency.hpp"

namespace kith::detail {
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

// The product over the largest consistent set of members, of each what is left when it is freed of contradictions with
// itself. Ties: the larger evidence under the belief, then the smaller hash of the members' addresses.
std::vector<std::size_t> observe_common(ParticleBelief& belief, const TeamResponses& responses, RandomStream random) {
  const ConsistentSubsets candidates = largest_consistent_subsets(responses.lists, responses.prior);
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
      evidence = belief.log_evidence(product, responses.likelihood) -
                 static_cast<double>(product.size()) * responses.likelihood.log_density(0.0);
      std::vector<std::uint64_t> addresses;
      addresses.reserve(subset.size());
      for (const std::size_t i : subset) addresses.push_back(responses.addresses[i]);
      hash = hash_of(std::move(addresses));
    }
    if (best != nullptr && !(evidence > best_evidence || (evidence == best_evidence && hash < best_hash))) continue;
    best = &subset;
    best_product = std::move(product);
    best_evidence = evidence;
    best_hash = hash;
  }

  if (responses.reduce_before_update) best_product = minimal_set(best_product).value_or(best_product);
  belief.observe(best_product, responses.likelihood, random);
  return complement(*best, responses.lists.size());
}

}  // namespace

AggregationRule common_rule() { return {"common", "what all members know (intersection)", observe_common, true}; }

}  // namespace kith::detail
