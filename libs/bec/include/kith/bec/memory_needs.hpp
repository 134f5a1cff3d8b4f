#pragma once

#include <cstddef>
#include <cstdint>

#include "kith/domains/domain.hpp"

namespace kith {

/// Bytes that an Atlas of the domain takes, beside those of the domain: about 700 for every state of every MDP
/// (docs/limits.md has measurements).
[[nodiscard]] std::uint64_t planning_memory(const Domain& domain);

/// Bytes that one thread takes to choose what to teach where behaviours are planned on demand: a bit for every pair of
/// a start and a constraint that it may convey, of which there are about as many as the largest MDP has states.
[[nodiscard]] std::uint64_t teaching_memory(const Domain& domain);

/// Bytes that the PartitionStore of a process may take where behaviours are planned on demand: as many as it may grow
/// to, whatever the number of threads. 0 where no MDP is exact.
[[nodiscard]] std::uint64_t partition_memory(const Domain& domain);

/// Whether the Atlas of the domain could be kept in memory.
/// @throws kith::Error (kInfeasible, E1201) if planning_memory() is more than free_memory().
void require_planning_memory(const Domain& domain);

/// Whether what is not planned yet could be taught by so many threads at a time.
/// @throws kith::Error (kInfeasible, E1201) if planning_memory(), teaching_memory() of each thread and
/// partition_memory() are more than free_memory().
void require_teaching_memory(const Domain& domain, std::size_t threads = 1);

}  // namespace kith
