#pragma once

#include <memory>

#include "kith/runs/ranks.hpp"

namespace kith::cli {

/// This process among those that mpirun has started, or null if it has started none. At most once per program. Throws
/// std::runtime_error if MPI cannot be loaded.
[[nodiscard]] std::unique_ptr<Ranks> mpi_ranks();

/// The MPI library that kith was built with, or "none".
[[nodiscard]] const char* mpi_version();

}  // namespace kith::cli
