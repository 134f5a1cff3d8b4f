#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "fault_case.hpp"
#include "models.hpp"
#include "scenario.hpp"

namespace kith::faults {

/// Copies what a variant of a scenario begins with into the folder `root`, which must not exist.
void prepare(const Scenario& scenario, const Variant& variant, const Models& models, const std::filesystem::path& root);

/// The first command of a scenario and its surroundings, for a fault of this family to strike.
[[nodiscard]] Command struck_command(const Scenario& scenario, const Variant& variant, const Models& models,
                                     const std::filesystem::path& root);

/// Adds to a command what makes the shim count its calls, in this file, and strike one of them, if `fault` is not
/// empty.
void use_shim(Command& command, const Scenario& scenario, const Models& models, const std::filesystem::path& counts,
              const std::string& fault);

/// Does a case in an empty folder and checks every claim.
[[nodiscard]] Outcome try_case(const Case& one, const Scenario& scenario, const Models& models,
                               const std::filesystem::path& folder);

}  // namespace kith::faults
