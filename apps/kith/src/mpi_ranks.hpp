#pragma once

#include <memory>

#include "kith/runs/ranks.hpp"

namespace kith::cli {

/// This process among those that mpirun has started, or null if it has started none. At most once per program.
[[nodiscard]] std::unique_ptr<Ranks> mpi_ranks();

/// How many threads a rank should use: its share of the machine that it is on. 0 without ranks.
[[nodiscard]] std::size_t threads_per_rank();

/// Whether this process is the one of several that speaks.
[[nodiscard]] bool is_first_rank();

/// The MPI library, or "none".
[[nodiscard]] const char* mpi_version();

}  // namespace kith::cli
