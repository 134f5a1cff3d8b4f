#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "kith/bec/atlas.hpp"
#include "kith/core/diagnostic.hpp"
#include "kith/study/study_file.hpp"

namespace kith {

struct VerifyOptions {
  double sample = 1.0;  ///< Share of the teams that are taught again, in (0, 1]; at least one team.
  std::size_t threads = 0;
  std::function<void(std::size_t done, std::size_t total, std::size_t failed)> on_progress;
  std::function<bool()> stopped;
};

/// What came of verify_run().
struct Verification {
  std::size_t teams = 0;    ///< In the journal.
  std::size_t checked = 0;  ///< Of these, taught again.
  std::size_t files = 0;    ///< Compared with the manifest.
  bool stopped = false;
  std::string program;  ///< That the journal was written by.
  /// What is not as it should be: a team that, taught again from the frozen inputs, gives other bytes (E0640), a file
  /// that is not the one that the manifest names (E0641), a table that does not follow from the journal (E0642), a
  /// damaged record or journal (E0643), a team that a finished run does not hold (E0644).
  std::vector<Diagnostic> mismatches;
};

/// Repeats a run, or a sample of it, and compares bytes. Nothing is written.
/// @param folder   of a run, finished or not. @param reading  its study, see read_run_folder().
/// @throws kith::Error (kIo) if the folder has no journal or it cannot be read.
[[nodiscard]] Verification verify_run(const std::filesystem::path& folder, const StudyReading& reading,
                                      const Atlas& atlas, const VerifyOptions& options);

}  // namespace kith
