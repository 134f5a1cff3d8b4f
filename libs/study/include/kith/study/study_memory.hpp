#pragma once

#include <cstddef>
#include <cstdint>

#include "kith/study/study.hpp"

namespace kith {

/// Bytes that one thread takes to teach a team of the study: the beliefs of the largest team, with what an update
/// needs besides, and the record of the team.
[[nodiscard]] std::uint64_t memory_per_thread(const Study& study);

/// Bytes of the record of one team, as measured where the length of a session is not known beforehand; see
/// docs/limits.md.
[[nodiscard]] std::uint64_t memory_per_team(const Study& study);

/// Whether teams could be taught by so many threads, and so many records kept, without running out of memory.
/// @param threads  0: as many as there are cores.
/// @param kept     records kept at a time, beside those of teams under way.
/// @throws kith::Error (kInfeasible, E1201) if that needs more than free_memory().
void require_study_memory(const Study& study, std::size_t threads, std::size_t kept = 0);

}  // namespace kith
