#pragma once

#include <string>
#include <vector>

#include "process.hpp"

namespace kith::faults {

/// Where a fault strikes.
enum class Where {
  kProcess,  ///< The first command, while it runs.
  kOutput,   ///< The same, and what it prints, too.
  kFolder,   ///< Folders that nobody works on.
};

/// What is in the folder beforehand.
struct Preparation {
  /// A folder as it was left by earlier commands, and its name here.
  struct Placed {
    std::string model, name;
  };
  std::vector<Placed> placed{};
  std::string damaged{};  ///< A journal that is damaged beforehand, so that some but not all records can be read.
  Words options{};        ///< For the first command, in addition.
};

/// One way of using the program. All commands together lead to the tables of the study in the folder "run".
struct Scenario {
  std::string name;
  Where where = Where::kProcess;
  std::vector<Preparation> preparations;
  std::vector<Words> commands;  ///< Without the program; the first one is what a fault strikes.
  std::string damaged{};        ///< Where::kFolder: only folders whose names begin so.
  int ranks = 0;                ///< Under mpirun, if not 0.
};

/// All of them; those under mpirun only if they can be.
[[nodiscard]] std::vector<Scenario> all_scenarios(bool with_mpi);

/// The words of `kith study` for the study that all scenarios are about: eight teams in a small domain.
[[nodiscard]] Words study_into(const std::string& folder, const Words& options = {});

}  // namespace kith::faults
