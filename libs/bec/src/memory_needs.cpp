#include "kith/bec/memory_needs.hpp"

#include <algorithm>
#include <string>

#include "behaviour_source.hpp"
#include "kith/bec/behaviours.hpp"
#include "kith/core/memory.hpp"

namespace kith {
namespace {

// Measured on maps of 10 000 to 490 000 cells and rounded up: see docs/limits.md.
constexpr std::uint64_t kBytesPerState = 700;
constexpr std::uint64_t kBytesPerStart = 6'000;
constexpr std::uint64_t kPairsPerByte = 6;

constexpr const char* kHint =
    "use a smaller map or fewer optional things, or teach from some starts only: [family] starts = 1000";

std::uint64_t num_states(const Domain& domain) {
  std::uint64_t states = 0;
  for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) states += domain.mdp(m).num_states();
  return states;
}

std::string what(const std::string& verb, const Domain& domain) {
  return verb + " the " + std::to_string(num_states(domain)) + " states of '" + domain.id() + "'";
}

}  // namespace

std::uint64_t planning_memory(const Domain& domain) { return kBytesPerState * num_states(domain); }

std::uint64_t teaching_memory(const Domain& domain) {
  if (is_cheap_to_tabulate(domain)) return 0;
  std::uint64_t largest = 0;
  for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) {
    largest = std::max<std::uint64_t>(largest, domain.mdp(m).num_states());
  }
  return domain.num_starts() * (kBytesPerStart + largest / kPairsPerByte);
}

std::uint64_t partition_memory(const Domain& domain) {
  if (is_cheap_to_tabulate(domain)) return 0;
  for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) {
    if (can_be_partitioned(domain.mdp(m))) return PartitionStore::kDefaultBytes;
  }
  return 0;
}

void require_planning_memory(const Domain& domain) {
  require_memory(planning_memory(domain), what("planning", domain), kHint);
}

void require_teaching_memory(const Domain& domain, std::size_t threads) {
  require_memory(planning_memory(domain) + threads * teaching_memory(domain) + partition_memory(domain),
                 what("teaching", domain), kHint);
}

}  // namespace kith
