#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "models.hpp"

namespace kith::faults {

/// What a finished run folder may be found to hold, and by whom.
struct Reading {
  std::filesystem::path root{};            ///< The current folder; the run is in "run".
  std::vector<const Expected*> allowed{};  ///< Any of these, but of one of them only.
  bool is_worked_on = false;  ///< A command was ended while it worked on the folder, which is at rest else.
  bool was_finished = true;   ///< Before the damage.
};

/// Asks status, verify, analyze and report about the folder and says what they must not have said: any may refuse, but
/// none may crash, and none may succeed unless all it is about is as an undisturbed run left it.
[[nodiscard]] std::string wrong_readings(const Models& models, const Reading& reading);

/// Why an exit code and the messages with it can never be right; empty if they can.
[[nodiscard]] std::string wrong_ending(const std::string& command, const Ended& ended);

}  // namespace kith::faults
