#pragma once

#include <string>

#include "kith/runs/run_folder.hpp"

namespace kith::cli {

/// What the manifest says about this program and how it was called.
[[nodiscard]] RunFacts facts_of_build();

/// Version and commit: what journals are written with and only such a program goes on with.
[[nodiscard]] std::string program_name();

/// The time, UTC, "2026-01-31T12:00:00Z".
[[nodiscard]] std::string utc_now();

/// What was typed, quoted so that a shell takes it again.
[[nodiscard]] std::string shell_line();

}  // namespace kith::cli
